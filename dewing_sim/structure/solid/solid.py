# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The membrane as solid elements: a prestretched strip, one element through the thickness.

Nodes are numbered bottom, top, bottom, top, ... along the chord, in plane strain. The strip is
pinned at the lower side of its edges, as in the paper, and hangs from there: in the interior its
mid-plane aligns with the pins, within about one thickness of the edges it bends away. Total
Lagrangian: the reference is the strip before prestretch. Forces are per unit span; any consistent
system of units.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.scales import Scales
from dewing_sim.structure.base import Taut
from dewing_sim.structure.dynamics import statics
from dewing_sim.structure.follower import pressure_force, subtract_stiffness
from dewing_sim.structure.material.viscosity import Overstress, Prony, Viscous
from dewing_sim.structure.sheet import SI, Sheet
from dewing_sim.structure.solid import assembly, pins, strip
from dewing_sim.structure.solid.element import BALANCED, LOCKED
from dewing_sim.structure.solid.fitting import fitted
from dewing_sim.structure.solid.pins import LOWER, MIDDLE

HALF_BAND = 7               # couplings of a degree of freedom on either side
EDGE_LENGTH = 2.0           # of the first element, in deformed thicknesses
EDGE_LAYER = 6.0            # deformed thicknesses, in which the mid-plane leaves the pins
LINEAR = 1.0e-4             # of the thickness


class Response(NamedTuple):
    """Nodal forces (2(n+1), 2); tension, force per span, and thickness of elements (n,)."""

    force: np.ndarray
    tension: np.ndarray
    thickness: np.ndarray


@dataclass(frozen=True, eq=False)
class Solid(Taut, Viscous):
    """A prestretched strip of hexahedra between (0, 0) and (chord, 0).

    ``support`` is `pins.LOWER` or `pins.MIDDLE`. ``length`` (n,) are the element lengths before
    prestretch; ``mass`` (2(n+1),) is lumped at the nodes; ``rest_position`` (2(n+1), 2) is the
    unloaded equilibrium.
    """

    sheet: Sheet
    prestretch: float
    chord: float
    support: str
    length: np.ndarray
    mass: np.ndarray
    rest_position: np.ndarray
    viscosity: Prony | None = None
    overstress: Overstress | None = None

    @classmethod
    def uniform(cls, sheet: Sheet, prestretch: float, density: float, chord: float,
                elements: int, support: str = LOWER, viscosity: Prony | None = None,
                ) -> 'Solid':
        """Return a strip of ``elements`` equal elements, shorter ones at the edges.

        Edges pinned at their lower side give way, so such a strip is cut a little shorter than
        chord / prestretch: at rest and without voltage the interior carries the prestretch.
        ``density`` is the elastomer's.
        """
        if elements < 4:
            raise BadInput(f'elements = {elements} is out of range: at least 4')
        thickness = float(sheet.respond([prestretch], 0.0).thickness[0])
        share = strip.lengths(elements, EDGE_LENGTH * thickness / chord)
        position = np.zeros((2 * elements + 2, 2))
        position[:, 0] = np.repeat(chord * np.concatenate([[0.0], np.cumsum(share)]), 2)
        position[0::2, 1], position[1::2, 1] = -0.5 * thickness, 0.5 * thickness
        total = chord / prestretch
        solid = cls(sheet, prestretch, chord, MIDDLE, total * share,
                    strip.nodal_mass(total * share, sheet, density), position, viscosity)
        return solid if support == MIDDLE else fitted(solid, density)

    @classmethod
    def from_parameters(cls, section: parameters.Membrane, scales: Scales = SI) -> 'Solid':
        """Return the strip of a parameter section in the units of ``scales``."""
        return cls.uniform(Sheet.from_parameters(section, scales), section.prestretch,
                           section.density / scales.density, section.chord / scales.length,
                           section.elements, section.support,
                           Prony.from_parameters(section, scales))

    @property
    def elements(self) -> int:
        """Number of elements n."""
        return self.length.size

    @cached_property
    def free(self) -> np.ndarray:
        """Entries of a raveled (2(n+1), 2) array that may move."""
        return np.flatnonzero(self._equations.ravel() >= 0)

    @cached_property
    def _equations(self) -> np.ndarray:
        return pins.equations(self.elements, self.support)

    @cached_property
    def _share(self) -> np.ndarray:
        return pins.mid_plane_weights(self.elements, self.support)

    @cached_property
    def _springs(self) -> pins.Springs | None:
        if self.support != MIDDLE:
            return None
        return pins.Springs(self.rest_position, self.rest_tension(0.0),
                            self.sheet.elastomer.bulk_modulus)

    @property
    def linear_range(self) -> float:
        """A small part of the thickness: turned by more, an element that keeps its volume fails.

        Its old tangent would take the turn for a change of volume, against the bulk modulus.
        """
        return LINEAR * self.sheet.initial_thickness

    def surface(self, nodal: np.ndarray) -> np.ndarray:
        """Return what the flow sees of nodal positions or velocities, (n+1, 2).

        That is the mid-plane and, within a few thicknesses of edges pinned at their lower side,
        where the strip bends away from its line of tension, the straight line to the pins.
        """
        line = strip.mid_line(nodal, self._share)
        strip.straighten(line, *self._edges)
        return line

    def spread(self, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces of forces (n+1, 2) on the surface, its transpose."""
        force = force.copy()
        strip.gather(force, *self._edges)
        return strip.to_nodes(force, self._share)

    @cached_property
    def _edges(self) -> tuple[int, np.ndarray, np.ndarray]:
        """Stations on the straight edges, and their weights of the pin and the end, (k, 2)."""
        thickness = self.sheet.initial_thickness / self.prestretch
        line = strip.mid_line(self.rest_position, self._share)
        layer = EDGE_LAYER * thickness if self.support == LOWER else 0.0
        return strip.straight_edges(line, layer, thickness)

    def respond(self, position: np.ndarray, v_squared: float) -> Response:
        """Return the response at ``position`` (2(n+1), 2) and V^2.

        Raises `BadInput` for a negative or non-finite V^2, `Diverged` where the law locks up or
        where an element turns inside out.
        """
        if not 0.0 <= v_squared < math.inf:
            raise BadInput(f'v_squared = {v_squared} V^2 is out of range: from 0 to infinity')
        force, tension, thinning, status, k = assembly.respond(
            position, *self._constants(v_squared))
        self._require_balance(status, k, position, v_squared)
        if self._springs:
            self._springs.add_force(force, position)
        return Response(force, tension, self.sheet.initial_thickness * thinning)

    def tension(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the tensions (n,), force per unit span; negative where the strip is slack."""
        return self.respond(position, v_squared).tension

    def internal_force(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the gradient (2(n+1), 2) of the potential energy."""
        return self.respond(position, v_squared).force

    def deviatoric_stress(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return S_dev at the integration points, components 11, 22 and 12, (3, 4n)."""
        gain = self.overstress.gain if self.overstress else 0.0
        return assembly.deviatoric_stresses(
            position, *self._constants(v_squared)) / (1.0 + gain)

    def energies(self, position: np.ndarray, v_squared: float) -> tuple[float, float]:
        """Return the elastic and the electrostatic energy (C V^2 / 2) per unit span."""
        elastic, electric = assembly.energies(position, *self._constants(v_squared))
        held = self._springs.energy(position) if self._springs else 0.0
        return elastic + held, electric

    def tangent(self, position: np.ndarray, v_squared: float, pressure=0.0,
                before: np.ndarray | None = None) -> np.ndarray:
        """Return d(internal force)/d(position) of the free coordinates as a band (15, m).

        The layout is that of `scipy.linalg.solve_banded` with bandwidths (7, 7). A non-zero
        ``pressure``, scalar or (n,), subtracts the stiffness of that follower load. ``before`` is
        the position of Newton's last iteration, if any, whose step helps the next.
        """
        band = np.zeros((2 * HALF_BAND + 1, self.free.size))
        status, k = assembly.stiffness(position, *self._constants(v_squared),
                                       self._equations.ravel(),
                                       position if before is None else before, band)
        self._require_balance(status, k, position, v_squared)
        if self._springs:
            self._springs.add_stiffness(band)
        if np.any(pressure):
            subtract_stiffness(band, np.full(self.elements, pressure, dtype=float),
                               self._equations, self._share)
        return band

    def pressure_force(self, position: np.ndarray, pressure) -> np.ndarray:
        """Return the nodal forces of a pressure jump on the mid-plane, scalar or (n,), to +y."""
        line = strip.mid_line(position, self._share)
        return strip.to_nodes(pressure_force(line, pressure), self._share)

    def rest_tension(self, v_squared: float) -> float:
        """Return the tension of the flat unloaded sheet at the prestretch."""
        return float(self.sheet.respond([self.prestretch], v_squared).tension[0])

    def stretch(self, position: np.ndarray) -> np.ndarray:
        """Return the total stretches of the line of centres, (n,)."""
        centres = position.reshape(-1, 2, 2).mean(axis=1)
        return np.hypot(*np.diff(centres, axis=0).T) / self.length

    def equilibrium(self, pressure, v_squared: float, follower: bool = True) -> np.ndarray:
        """Return the static position under a pressure jump, see `statics.equilibrium`."""
        return statics.equilibrium(self, pressure, v_squared, follower)

    def _constants(self, v_squared: float) -> tuple:
        height = self.sheet.initial_thickness
        gain, held = self.overstress or (0.0, self._no_stress)
        return (held, self.length, height, self.sheet.lateral_stretch, v_squared / height ** 2,
                self.sheet.elastomer.stiffened(gain))

    @cached_property
    def _no_stress(self) -> np.ndarray:
        return np.zeros((3, 4 * self.elements))

    def _require_balance(self, status: int, k: int, position: np.ndarray, v_squared: float):
        if status == BALANCED:
            return
        where = (f'element {k} at stretch {self.stretch(position)[k]:.6g} and '
                 f'{math.sqrt(v_squared):.6g} V')
        if not np.isfinite(position).all():
            raise Diverged(f'{where}: the deformation is not finite; '
                           'reduce the time step or the load')
        if status == LOCKED:
            raise Diverged(f'{where}: {self.sheet.elastomer.law.limit}; '
                           'reduce the load, the prestretch or the time step')
        raise Diverged(f'{where}: the element turns inside out or its thickness pulls in; '
                       'reduce the voltage, the load or the time step')

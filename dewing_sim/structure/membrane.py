# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Geometrically non-linear two-node membrane elements between two pinned edges.

Each element carries the tension T(lambda, V^2) of a `Sheet` along its own direction, with the
total stretch lambda = lambda_p * length / rest length, so rotations and extensions are arbitrary.
Forces are per unit span; any consistent system of units.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.scales import Scales
from dewing_sim.structure.base import Taut
from dewing_sim.structure.dynamics import statics
from dewing_sim.structure.follower import pressure_force, subtract_stiffness
from dewing_sim.structure.material.viscosity import Overstress, Prony, Viscous
from dewing_sim.structure.sheet import SI, Response, Sheet


def _edges(position: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return direction x, direction y and length of the elements, each (n,)."""
    dx, dy = (position[1:] - position[:-1]).T
    length = np.hypot(dx, dy)
    return dx / length, dy / length, length


def _assemble_tangent(position: np.ndarray, tension: np.ndarray, stiffness: np.ndarray,
                      ) -> np.ndarray:
    """Return the banded derivative of the internal force, (7, 2(n-1)).

    ``stiffness`` is dT / d length.
    """
    ex, ey, length = _edges(position)
    across = tension / length
    along = stiffness - across
    xx, xy, yy = along * ex * ex + across, along * ex * ey, along * ey * ey + across
    band = np.zeros((7, 2 * (tension.size - 1)))
    x, y = band[:, 0::2], band[:, 1::2]                 # columns of the coordinates of nodes
    x[3], y[3] = xx[:-1] + xx[1:], yy[:-1] + yy[1:]     # a node with itself
    x[4] = y[2] = xy[:-1] + xy[1:]
    x[5, :-1] = x[1, 1:] = -xx[1:-1]                    # with the next and the last one
    y[5, :-1] = y[1, 1:] = -yy[1:-1]
    x[6, :-1] = y[4, :-1] = x[2, 1:] = y[0, 1:] = -xy[1:-1]
    return band


@dataclass(frozen=True, eq=False)
class Membrane(Taut, Viscous):
    """A prestretched sheet between pinned edges at (0, 0) and (chord, 0).

    ``rest_position`` (n+1, 2) is the flat prestretched state without load; ``mass`` (n+1,) is
    lumped at the nodes, per unit span.
    """

    sheet: Sheet
    prestretch: float
    rest_position: np.ndarray
    mass: np.ndarray
    viscosity: Prony | None = None
    overstress: Overstress | None = None

    @classmethod
    def uniform(cls, sheet: Sheet, prestretch: float, density: float, chord: float,
                elements: int, viscosity: Prony | None = None) -> 'Membrane':
        """Return a membrane of equal elements; ``density`` is that of the elastomer."""
        if elements < 2:
            raise BadInput(f'elements = {elements} is out of range: at least 2')
        position = np.zeros((elements + 1, 2))
        position[:, 0] = chord * np.arange(elements + 1) / elements
        surface_density = (density * sheet.initial_thickness
                           / (prestretch * sheet.lateral_stretch))
        mass = np.full(elements + 1, surface_density * chord / elements)
        mass[[0, -1]] *= 0.5
        return cls(sheet, prestretch, position, mass, viscosity)

    @classmethod
    def from_parameters(cls, section: parameters.Membrane, scales: Scales = SI) -> 'Membrane':
        """Return the membrane of a parameter section in the units of ``scales``."""
        sheet = Sheet.from_parameters(section, scales)
        return cls.uniform(sheet, section.prestretch, section.density / scales.density,
                           section.chord / scales.length, section.elements,
                           Prony.from_parameters(section, scales))

    @property
    def elements(self) -> int:
        """Number of elements n."""
        return self.mass.size - 1

    @property
    def chord(self) -> float:
        """Distance between the pinned edges."""
        return float(self.rest_position[-1, 0])

    @property
    def free(self) -> slice:
        """Entries of a raveled (n+1, 2) array that may move."""
        return slice(2, 2 * self.elements)

    @cached_property
    def stretch_per_length(self) -> np.ndarray:
        """lambda_p / rest length, (n,)."""
        return self.prestretch / _edges(self.rest_position)[2]

    def stretch(self, position: np.ndarray) -> np.ndarray:
        """Return the total stretches (n,)."""
        dx, dy = (position[1:] - position[:-1]).T
        return np.hypot(dx, dy) * self.stretch_per_length

    def tension(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the tensions (n,), force per unit span; negative where the sheet is slack."""
        return self.respond(position, v_squared).tension

    def respond(self, position: np.ndarray, v_squared: float) -> Response:
        """Return tension, its slopes and thickness of the elements, each (n,)."""
        return self.sheet.respond(self.stretch(position), v_squared, self.overstress)

    def internal_force(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the gradient (n+1, 2) of the potential energy in ``position`` (n+1, 2)."""
        ex, ey, length = _edges(position)
        tension = self.sheet.respond(length * self.stretch_per_length, v_squared,
                                     self.overstress).tension
        pull = np.stack((tension * ex, tension * ey), axis=1)
        force = np.zeros(position.shape)
        force[:-1] -= pull
        force[1:] += pull
        return force

    def deviatoric_stress(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return S_dev of the elements along and through the sheet, (2, n)."""
        thickness = self.respond(position, v_squared).thickness
        return self.sheet.deviatoric_stress(self.stretch(position), thickness)

    def energies(self, position: np.ndarray, v_squared: float) -> tuple[float, float]:
        """Return the elastic and the electrostatic energy (C V^2 / 2) per unit span."""
        stretch = self.stretch(position)
        elastic, electric = self.sheet.energies(stretch, v_squared)
        area = self.sheet.initial_thickness / (self.stretch_per_length
                                               * self.sheet.lateral_stretch)
        return float(area @ elastic), float(area @ electric)

    def tangent(self, position: np.ndarray, v_squared: float, pressure=0.0,
                before: np.ndarray | None = None) -> np.ndarray:
        """Return d(internal force)/d(position) of the free nodes as a band (7, 2(n-1)).

        The layout is that of `scipy.linalg.solve_banded` with bandwidths (3, 3). A non-zero
        ``pressure``, scalar or (n,), subtracts the stiffness of that follower load. ``before``,
        the position of Newton's last iteration, does not matter here.
        """
        response = self.respond(position, v_squared)
        band = _assemble_tangent(position, response.tension,
                                 response.stiffness * self.stretch_per_length)
        if np.any(pressure):
            subtract_stiffness(band, np.full(self.elements, pressure, dtype=float),
                               self._equations, np.ones((self.elements + 1, 1)))
        return band

    @cached_property
    def _equations(self) -> np.ndarray:
        """Number of each coordinate among the free ones, -1 at the pins, (n+1, 1, 2)."""
        numbers = np.full(2 * self.elements + 2, -1)
        numbers[self.free] = np.arange(2 * self.elements - 2)
        return numbers.reshape(-1, 1, 2)

    @property
    def linear_range(self) -> float:
        """Any length: one tangent serves for many steps."""
        return math.inf

    def surface(self, nodal: np.ndarray) -> np.ndarray:
        """Return what the flow sees of nodal positions or velocities: all, (n+1, 2)."""
        return nodal

    def spread(self, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces of forces (n+1, 2) on the surface, its transpose."""
        return force

    def rest_tension(self, v_squared: float) -> float:
        """Return the tension of the flat unloaded membrane."""
        return float(self.sheet.respond([self.prestretch], v_squared).tension[0])

    def pressure_force(self, position: np.ndarray, pressure) -> np.ndarray:
        """Return the nodal forces (n+1, 2) of a pressure jump, scalar or (n,), pushing to +y."""
        return pressure_force(position, pressure)

    def equilibrium(self, pressure, v_squared: float, follower: bool = True) -> np.ndarray:
        """Return the static position (n+1, 2) under a pressure jump, scalar or (n,).

        Raises `Slack`, `Diverged` or `NotConverged`, see `statics.equilibrium`.
        """
        return statics.equilibrium(self, pressure, v_squared, follower)

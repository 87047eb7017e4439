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

import numba
import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.scales import Scales
from dewing_sim.structure import statics
from dewing_sim.structure.follower import pressure_force, subtract_stiffness
from dewing_sim.structure.sheet import BALANCED, SI, Response, Sheet, tensions
from dewing_sim.structure.taut import Taut
from dewing_sim.structure.viscosity import Overstress, Prony, Viscous


@numba.njit(cache=True)
def _edges(position):
    """Return rows direction x, direction y, length of the elements, (3, n)."""
    n = position.shape[0] - 1
    edges = np.empty((3, n))
    for k in range(n):
        dx = position[k + 1, 0] - position[k, 0]
        dy = position[k + 1, 1] - position[k, 1]
        length = math.sqrt(dx * dx + dy * dy)
        edges[0, k], edges[1, k], edges[2, k] = dx / length, dy / length, length
    return edges


@numba.njit(cache=True)
def _assemble_force(edges, tension):
    """Return the gradient of the energy, (n+1, 2): each element pulls its nodes together."""
    n = tension.size
    force = np.zeros((n + 1, 2))
    for k in range(n):
        fx, fy = tension[k] * edges[0, k], tension[k] * edges[1, k]
        force[k, 0] -= fx
        force[k, 1] -= fy
        force[k + 1, 0] += fx
        force[k + 1, 1] += fy
    return force


@numba.njit(cache=True)
def _internal_force(position, stretch_per_length, *constants):
    """Return the gradient of the energy (n+1, 2), the tensions (n,) and whether they balance."""
    edges = _edges(position)
    for k in range(stretch_per_length.size):
        edges[2, k] *= stretch_per_length[k]
    tension, status = tensions(edges[2], *constants)
    return _assemble_force(edges, tension), tension, status


@numba.njit(cache=True)
def _assemble_tangent(edges, tension, stiffness):
    """Return the banded derivative of the internal force, (7, 2(n-1)).

    ``stiffness`` is dT / d length.
    """
    n = tension.size
    band = np.zeros((7, 2 * (n - 1)))
    for k in range(n):
        ex, ey = edges[0, k], edges[1, k]
        across = tension[k] / edges[2, k]
        along = stiffness[k] - across
        xx, xy, yy = along * ex * ex + across, along * ex * ey, along * ey * ey + across
        for a in range(2):
            for b in range(2):
                row, column = 2 * (k - 1 + a), 2 * (k - 1 + b)
                if row < 0 or column < 0 or row >= band.shape[1] or column >= band.shape[1]:
                    continue
                sign = 1.0 if a == b else -1.0
                band[3 + row - column, column] += sign * xx
                band[4 + row - column, column] += sign * xy
                band[2 + row - column, column + 1] += sign * xy
                band[3 + row - column, column + 1] += sign * yy
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
        return _edges(position)[2] * self.stretch_per_length

    def tension(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the tensions (n,), force per unit span; negative where the sheet is slack."""
        return self._forces(position, v_squared)[1]

    def respond(self, position: np.ndarray, v_squared: float) -> Response:
        """Return tension, its slopes and thickness of the elements, each (n,)."""
        return self.sheet.respond(self.stretch(position), v_squared, self.overstress)

    def internal_force(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the gradient (n+1, 2) of the potential energy in ``position`` (n+1, 2)."""
        return self._forces(position, v_squared)[0]

    def _forces(self, position: np.ndarray, v_squared: float) -> tuple[np.ndarray, np.ndarray]:
        """Return internal forces (n+1, 2) and tensions (n,)."""
        force, tension, status = _internal_force(
            position, self.stretch_per_length, *self.sheet.constants(v_squared, self.overstress))
        if status != BALANCED:
            self.respond(position, v_squared)       # raises and says where
        return force, tension

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
        edges = _edges(position)
        response = self.sheet.respond(edges[2] * self.stretch_per_length, v_squared,
                                      self.overstress)
        band = _assemble_tangent(edges, response.tension,
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

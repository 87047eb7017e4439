# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where flow and membrane meet: conservative transfer and the implicit coupling iteration.

The membrane nodes and the flow columns do not match.  Both transfers integrate over the overlaps
of elements and columns, in the present position, and each is the transpose of the other, so force
and virtual work pass exactly:  sum_i dx_i jump_i w_i = sum_k f_k . velocity_k.
"""

from dataclasses import dataclass
from typing import Any

import numba
import numpy as np

from dewing_sim.errors import NotConverged
from dewing_sim.fluid.base import Fluid, Prediction, Wall
from dewing_sim.structure import dynamics
from dewing_sim.structure.band import LowRank
from dewing_sim.structure.dynamics import Motion, Operator, Structure

FLAT = 1.0e-5       # chords; shapes flatter than this are compared with it


@dataclass(frozen=True)
class Coupled:
    """One coupled step: flow, motion, coupling passes and the last relative change of shape."""

    flow: Any
    motion: Motion
    iterations: int
    residual: float


def solve(fluid: Fluid, structure: Structure, operator: Operator, flow: Any, motion: Motion,
          dt: float, v_squared: float, wall_pressure: float, tolerance: float, passes: int,
          damping: float = 0.0) -> Coupled:
    """Advance flow and membrane together by ``dt``.

    Each pass moves the grid to the last known shape, predicts the flow up to its pressure jump,
    an affine function of the wall velocity, and solves the membrane under that load: the added
    mass is inside the structural solution.  Passes end when the shape changes by less than
    ``tolerance`` of its largest deflection.  ``wall_pressure`` is a uniform pressure jump added to
    the load.  Raises `NotConverged` after ``passes``.
    """
    position = motion.predict(dt)
    wall = wall_of(fluid.columns, structure.surface(position),
                   structure.surface(motion.rate(position, dt)))
    for iteration in range(1, passes + 1):
        prediction = fluid.predict(flow, wall)
        load = PressureLoad(fluid, structure, prediction, wall_pressure)
        moved = dynamics.advance(structure, motion, dt, v_squared, load, operator, damping,
                                 guess=position)
        position = moved.position
        before, wall = wall, wall_of(fluid.columns, structure.surface(position),
                                     structure.surface(moved.velocity))
        residual = shape_change(wall.height, before.height)
        if residual <= tolerance:
            return Coupled(fluid.correct(prediction, wall.velocity), moved, iteration, residual)
    raise NotConverged(f'coupling: the shape still changes by {residual:.3g} of its deflection '
                       f'after {passes} passes (tolerance {tolerance:.3g}); '
                       'reduce the time step or raise coupling_iterations')


def shape_change(after: np.ndarray, before: np.ndarray) -> float:
    """Return the largest change of height relative to the largest deflection."""
    return float(np.abs(after - before).max() / max(np.abs(after).max(), FLAT))


def wall_of(columns: np.ndarray, position: np.ndarray, velocity: np.ndarray) -> Wall:
    """Return the wall that the flow sees of nodes (n + 1, 2) and their velocities."""
    height = np.interp(columns, position[:, 0], position[:, 1])
    return Wall(height, column_velocity(columns, position, velocity))


@dataclass(frozen=True)
class PressureLoad:
    """Nodal forces of the predicted flow, affine in the nodal velocities."""

    fluid: Fluid
    structure: Structure
    prediction: Prediction
    wall_pressure: float

    def __call__(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the nodal forces (nodes, 2) of the pressure jump at these velocities."""
        change = self.wall_velocity(position, velocity) - self.prediction.wall.velocity
        jump = self.prediction.jump - self.fluid.resistance @ change
        line = self.structure.surface(position)
        return self.structure.spread(
            nodal_force(self.fluid.columns, line, jump + self.wall_pressure))

    def wall_velocity(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the column velocities (columns,)."""
        return column_velocity(self.fluid.columns, self.structure.surface(position),
                               self.structure.surface(velocity))


def nodal_resistance(fluid: Fluid, structure: Structure) -> LowRank:
    """Return -d force / d velocity (m, m) on the free degrees of freedom at rest.

    Its rank is the number of flow columns.
    """
    position = structure.rest_position
    line = structure.surface(position)
    unit = np.eye(line.size).reshape(-1, *line.shape)
    columns = np.array([column_velocity(fluid.columns, line, motion) for motion in unit])
    basis = np.stack([structure.spread(column.reshape(line.shape)).ravel()[structure.free]
                      for column in columns.T], axis=1)
    weight = np.diff(fluid.columns)[:, None] * fluid.resistance
    return LowRank(np.ascontiguousarray(basis), weight)


@numba.njit(cache=True)
def column_velocity(columns, position, velocity):
    """Return the column averages of Y_t = v_y - Y_x v_x, the rise of the wall at fixed x."""
    w = np.zeros(columns.size - 1)
    element, column = 0, 0
    while element < position.shape[0] - 1 and column < w.size:
        x0, x1 = position[element, 0], position[element + 1, 0]
        slope = (position[element + 1, 1] - position[element, 1]) / (x1 - x0)
        left = max(x0, columns[column])
        right = min(x1, columns[column + 1])
        if right > left:
            share = (0.5 * (left + right) - x0) / (x1 - x0)
            start = velocity[element, 1] - slope * velocity[element, 0]
            end = velocity[element + 1, 1] - slope * velocity[element + 1, 0]
            w[column] += (right - left) * (start + share * (end - start))
        if x1 <= columns[column + 1]:
            element += 1
        else:
            column += 1
    for column in range(w.size):
        w[column] /= columns[column + 1] - columns[column]
    return w


@numba.njit(cache=True)
def nodal_force(columns, position, jump):
    """Return the nodal forces (n + 1, 2) of column pressure jumps, normal to the elements."""
    force = np.zeros(position.shape)
    element, column = 0, 0
    while element < position.shape[0] - 1 and column < jump.size:
        x0, x1 = position[element, 0], position[element + 1, 0]
        slope = (position[element + 1, 1] - position[element, 1]) / (x1 - x0)
        left = max(x0, columns[column])
        right = min(x1, columns[column + 1])
        if right > left:
            share = (0.5 * (left + right) - x0) / (x1 - x0)
            total = jump[column] * (right - left)
            force[element, 1] += total * (1.0 - share)
            force[element + 1, 1] += total * share
            force[element, 0] -= slope * total * (1.0 - share)
            force[element + 1, 0] -= slope * total * share
        if x1 <= columns[column + 1]:
            element += 1
        else:
            column += 1
    return force

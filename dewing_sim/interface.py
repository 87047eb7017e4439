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

from dewing_sim.errors import NotConverged, RunFailed
from dewing_sim.fluid.base import Fluid, Wall
from dewing_sim.fluid.onset import Onset
from dewing_sim.structure import dynamics
from dewing_sim.structure.band import LowRank
from dewing_sim.structure.dynamics import Motion, Operator, Structure

FLAT = 1.0e-5       # chords; shapes flatter than this are compared with it
EXTRAPOLATION = tuple(map(np.array, (       # from one, two or three past values
    (1.0,), (2.0, -1.0), (3.0, -3.0, 1.0))))
# Last correction of the membrane in chords, for a guess and in a pass; the next is far smaller.
FORESEEN, ACCURACY = 1.0e-5, 1.0e-8


@dataclass(frozen=True)
class Coupled:
    """One coupled step: flow, motion, coupling passes and the last relative change of shape.

    ``still_jumps`` (1 to 3, columns) are the pressure jumps that a wall without acceleration
    would have felt in the last steps, newest first.
    """

    flow: Any
    motion: Motion
    iterations: int
    residual: float
    still_jumps: np.ndarray


def solve(fluid: Fluid, structure: Structure, operator: Operator, flow: Any, motion: Motion,
          still_jumps: np.ndarray, dt: float, v_squared: float, wall_pressure: float,
          tolerance: float, passes: int, damping: float = 0.0,
          onset: Onset | None = None) -> Coupled:
    """Advance flow and membrane together by ``dt``.

    Each pass moves the grid to the last known shape, predicts the flow up to its pressure jump,
    an affine function of the wall velocity, and solves the membrane under that load: the added
    mass is inside the structural solution.  Passes end when the shape changes by less than
    ``tolerance`` of its largest deflection.  The first shape is that of the membrane under the
    pressure jump extrapolated from the ``still_jumps`` of the last steps (k, columns), without
    any by its own motion.  ``wall_pressure`` is a uniform pressure jump added to the load.
    ``onset`` is the flow that the wing meets, by default the undisturbed stream; where its axes
    are accelerated, so is the membrane.  Raises `NotConverged` after ``passes``.
    """
    coasting = _coasting(fluid, structure, motion)
    step = dynamics.Step(structure, motion, dt, v_squared, operator, damping)

    def moved_under(jump, velocity, guess, accuracy):
        load = Load(fluid, structure, jump, velocity, wall_pressure, onset)
        return step.reach(load, guess, accuracy)

    position = motion.predict(dt)
    if len(still_jumps):
        jump = EXTRAPOLATION[len(still_jumps) - 1] @ still_jumps
        try:
            position = moved_under(jump, coasting, position, FORESEEN)
        except RunFailed:
            pass                # only a guess: the passes will tell whether the step can be made
    wall = wall_of(fluid.columns, structure.surface(position),
                   structure.surface(motion.rate(position, dt)))
    for iteration in range(1, passes + 1):
        prediction = fluid.predict(flow, wall, onset)
        position = moved_under(prediction.jump, wall.velocity, position, ACCURACY)
        before, wall = wall, wall_of(fluid.columns, structure.surface(position),
                                     structure.surface(motion.rate(position, dt)))
        residual = shape_change(wall.height, before.height)
        if residual <= tolerance:
            still = prediction.jump + fluid.resistance @ (before.velocity - coasting)
            return Coupled(fluid.correct(prediction, wall.velocity), step.end(position),
                           iteration, residual,
                           np.array([still, *still_jumps[:len(EXTRAPOLATION) - 1]]))
    raise NotConverged(f'coupling: the shape still changes by {residual:.3g} of its deflection '
                       f'after {passes} passes (tolerance {tolerance:.3g}); '
                       'reduce the time step or raise coupling_iterations')


def _coasting(fluid: Fluid, structure: Structure, motion: Motion) -> np.ndarray:
    """Return the column velocities (columns,) of a step without acceleration."""
    return _coasting_velocity(fluid.columns, *map(structure.surface, (
        motion.position, motion.velocity, motion.position_before, motion.velocity_before)))


@numba.njit(cache=True)
def shape_change(after, before):
    """Return the largest change of height relative to the largest deflection."""
    change, deflection = 0.0, FLAT
    for i in range(after.size):
        change = max(change, abs(after[i] - before[i]))
        deflection = max(deflection, abs(after[i]))
    return change / deflection


def wall_of(columns: np.ndarray, position: np.ndarray, velocity: np.ndarray) -> Wall:
    """Return the wall that the flow sees of nodes (n + 1, 2) and their velocities."""
    return Wall(*_wall(columns, position, velocity))


@dataclass(frozen=True)
class Load:
    """Nodal forces of a flow and of accelerated axes, affine in the nodal velocities.

    ``jump`` (columns,) acts if the wall moves with ``velocity`` (columns,).
    """

    fluid: Fluid
    structure: Structure
    jump: np.ndarray
    velocity: np.ndarray
    wall_pressure: float
    onset: Onset | None = None

    def __call__(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the nodal forces (nodes, 2) at these velocities."""
        force = self.structure.spread(_load(
            self.fluid.columns, self.structure.surface(position),
            self.structure.surface(velocity), self.jump, self.velocity, self.fluid.resistance,
            self.wall_pressure))
        if self.onset is not None and self.onset.is_accelerated:
            force -= self.structure.mass[:, None] * self.onset.frame_acceleration(
                position, velocity)
        return force


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
    w = np.empty(columns.size - 1)
    for column in range(w.size):
        w[column] = 0.0
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
    force = np.empty(position.shape)
    for node in range(position.shape[0]):
        force[node, 0], force[node, 1] = 0.0, 0.0
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


@numba.njit(cache=True)
def _load(columns, position, velocity, jump, reference, resistance, wall_pressure):
    """Return the nodal forces of a jump that acts if the columns move with ``reference``."""
    change = column_velocity(columns, position, velocity)
    total = np.empty(jump.size)
    for i in range(jump.size):
        change[i] -= reference[i]
        total[i] = jump[i] + wall_pressure
    _subtract_product(resistance, change, total)
    return nodal_force(columns, position, total)


@numba.njit(cache=True, fastmath={'reassoc', 'nsz'})
def _subtract_product(matrix, vector, result):
    for i in range(result.size):
        product = 0.0
        for j in range(vector.size):
            product += matrix[i, j] * vector[j]
        result[i] -= product


@numba.njit(cache=True)
def _wall(columns, position, velocity):
    """Return the heights at the column faces, those of the edges beyond, and their velocities."""
    height = np.empty(columns.size)
    element, last = 0, position.shape[0] - 2
    for i in range(columns.size):
        while element < last and position[element + 1, 0] < columns[i]:
            element += 1
        x0, x1 = position[element, 0], position[element + 1, 0]
        share = min(max((columns[i] - x0) / (x1 - x0), 0.0), 1.0)
        height[i] = position[element, 1] + share * (position[element + 1, 1]
                                                    - position[element, 1])
    return height, column_velocity(columns, position, velocity)


@numba.njit(cache=True)
def _coasting_velocity(columns, position, velocity, position_before, velocity_before):
    """Return (4 w_n - w_n-1) / 3 of the columns."""
    w = column_velocity(columns, position, velocity)
    before = column_velocity(columns, position_before, velocity_before)
    for column in range(w.size):
        w[column] = (4.0 * w[column] - before[column]) / 3.0
    return w

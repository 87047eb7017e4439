# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Transfer between membrane nodes and flow columns, which do not match.

Both directions integrate over the overlaps of elements and columns, in the present position, and
each is the transpose of the other, so force and virtual work pass exactly:
sum_i dx_i jump_i w_i = sum_k f_k . velocity_k.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.base import Fluid, Wall
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine.kernels import checked_kernel, kernel
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.band import LowRank


@kernel
def overlaps(columns, position):
    """Return element and column of the overlaps, and their widths as shared by the nodes (k, 2).

    Values at the nodes of an element, times these, are its integral over an overlap.
    """
    most = columns.size + position.shape[0]
    place, width = np.empty((most, 2), np.int64), np.empty((most, 2))
    element, column, k = 0, 0, 0
    while element < position.shape[0] - 1 and column < columns.size - 1:
        x0, x1 = position[element, 0], position[element + 1, 0]
        left = max(x0, columns[column])
        right = min(x1, columns[column + 1])
        if right > left:
            share = (0.5 * (left + right) - x0) / (x1 - x0)
            place[k, 0], place[k, 1] = element, column
            width[k, 0], width[k, 1] = (right - left) * (1.0 - share), (right - left) * share
            k += 1
        if x1 <= columns[column + 1]:
            element += 1
        else:
            column += 1
    return place[:k], width[:k]


@kernel
def column_velocity(columns, position, velocity, place, width):
    """Return the column averages of Y_t = v_y - Y_x v_x, the rise of the wall at fixed x.

    ``place`` and ``width`` are those of `overlaps`.
    """
    w = np.empty(columns.size - 1)
    for column in range(w.size):
        w[column] = 0.0
    for k in range(place.shape[0]):
        i, column = place[k, 0], place[k, 1]
        slope = ((position[i + 1, 1] - position[i, 1])
                 / (position[i + 1, 0] - position[i, 0]))
        w[column] += (width[k, 0] * (velocity[i, 1] - slope * velocity[i, 0])
                      + width[k, 1] * (velocity[i + 1, 1] - slope * velocity[i + 1, 0]))
    for column in range(w.size):
        w[column] /= columns[column + 1] - columns[column]
    return w


@kernel
def add_nodal_force(position, jump, place, width, force):
    """Add to ``force`` (n + 1, 2) that of column pressure jumps, normal to the elements."""
    for k in range(place.shape[0]):
        i, column = place[k, 0], place[k, 1]
        slope = ((position[i + 1, 1] - position[i, 1])
                 / (position[i + 1, 0] - position[i, 0]))
        start, end = jump[column] * width[k, 0], jump[column] * width[k, 1]
        force[i, 0] -= slope * start
        force[i, 1] += start
        force[i + 1, 0] -= slope * end
        force[i + 1, 1] += end


class ColumnLoad(NamedTuple):
    """Pressure jumps of columns that moved with the velocity ``reference``, and what more acts.

    Another velocity w changes the jump by -impedance (w - reference); ``uniform`` is added.
    """

    columns: np.ndarray             # faces (n + 1,)
    jump: np.ndarray                # (n,)
    reference: np.ndarray           # (n,)
    impedance: np.ndarray           # (n, n)
    uniform: float


@kernel
def add_load(load, position, velocity, force):
    """Add to ``force`` (n + 1, 2) that of a `ColumnLoad` on nodes with these velocities."""
    place, width = overlaps(load.columns, position)
    w = column_velocity(load.columns, position, velocity, place, width)
    total = np.empty(w.size)
    for i in range(w.size):
        w[i] -= load.reference[i]
        total[i] = load.jump[i] + load.uniform
    for j in range(w.size):
        for i in range(w.size):
            total[i] -= load.impedance[i, j] * w[j]
    add_nodal_force(position, total, place, width, force)


@kernel
def wall(columns, position, velocity):
    """Return the heights at the column faces, the edges' beyond them, and column velocities."""
    height = np.empty(columns.size)
    element, last = 0, position.shape[0] - 2
    for i in range(columns.size):
        while element < last and position[element + 1, 0] < columns[i]:
            element += 1
        x0, x1 = position[element, 0], position[element + 1, 0]
        share = min(max((columns[i] - x0) / (x1 - x0), 0.0), 1.0)
        height[i] = position[element, 1] + share * (position[element + 1, 1]
                                                    - position[element, 1])
    place, width = overlaps(columns, position)
    return height, column_velocity(columns, position, velocity, place, width)


@checked_kernel
def coasting_velocity(columns, position, velocity, position_before, velocity_before):
    """Return the column velocities (4 w_n - w_n-1) / 3 of a BDF2 step without acceleration."""
    w = column_velocity(columns, position, velocity, *overlaps(columns, position))
    before = column_velocity(columns, position_before, velocity_before,
                             *overlaps(columns, position_before))
    for column in range(w.size):
        w[column] = (4.0 * w[column] - before[column]) / 3.0
    return w


@checked_kernel
def nodal_load(load, position, velocity):
    """Return the nodal forces (n + 1, 2) of a `ColumnLoad`."""
    force = np.zeros(position.shape)
    add_load(load, position, velocity, force)
    return force


def wall_of(fluid: Fluid, structure: Moving, position: np.ndarray, velocity: np.ndarray,
            ) -> Wall:
    """Return the wall that the flow sees of nodal positions and velocities (nodes, 2)."""
    return Wall(*wall(fluid.columns, structure.surface(position), structure.surface(velocity)))


def nodal_impedance(fluid: Fluid, structure: Moving) -> LowRank:
    """Return -d force / d velocity (m, m) on the free degrees of freedom at rest.

    Its rank is the number of flow columns.
    """
    position = structure.rest_position
    line = structure.surface(position)
    unit = np.eye(line.size).reshape(-1, *line.shape)
    columns = np.array([wall(fluid.columns, line, motion)[1] for motion in unit])
    basis = np.stack([structure.spread(column.reshape(line.shape)).ravel()[structure.free]
                      for column in columns.T], axis=1)
    weight = np.diff(fluid.columns)[:, None] * fluid.impedance
    return LowRank(np.ascontiguousarray(basis), weight)


@dataclass(frozen=True, eq=False)
class Load:
    """Nodal forces of a flow and of accelerated axes, affine in the nodal velocities."""

    structure: Moving
    flow: ColumnLoad
    inflow: Inflow | None = None

    @classmethod
    def of(cls, fluid: Fluid, structure: Moving, jump: np.ndarray, velocity: np.ndarray,
           inputs: Inputs) -> 'Load':
        """Return the load of a pressure jump (columns,) that acts at the wall ``velocity``.

        q is rho U^2 / 2, half the unit of pressure.
        """
        return cls(structure, ColumnLoad(fluid.columns, jump, velocity, fluid.impedance,
                                         0.5 * inputs.wall_pressure), inputs.inflow)

    def __call__(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the nodal forces (nodes, 2) at these velocities."""
        force = self.structure.spread(nodal_load(
            self.flow, self.structure.surface(position), self.structure.surface(velocity)))
        if self.has_frame_acceleration:
            force -= self.structure.mass[:, None] * self.inflow.frame_acceleration(
                position, velocity)
        return force

    @property
    def has_frame_acceleration(self) -> bool:
        """Whether the axes are accelerated."""
        return self.inflow is not None and self.inflow.is_accelerated

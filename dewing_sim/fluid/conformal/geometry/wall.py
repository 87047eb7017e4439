# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The map that follows the membrane, and what happens between its columns and the nodes."""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal.geometry.exterior import Exterior
from dewing_sim.fluid.conformal.geometry.mapping import Line, Map, Mapping
from dewing_sim.machine.kernels import kernel


class WallMotion(NamedTuple):
    """Motion of the membrane at the nodes, each (n,)."""

    u: np.ndarray                   # flux U of the moving membrane
    v: np.ndarray                   # flux V
    acceleration: np.ndarray        # Re(a conj(z_zeta))
    speed: np.ndarray


class WallGeometry(NamedTuple):
    """One shape of the membrane, and how it moves."""

    map: Map
    shape_rate: np.ndarray          # (modes,) of b_k
    scale_rate: float               # of a
    line: Line

    def wall_motion(self, velocity: np.ndarray, now: np.ndarray, before: np.ndarray, dt: float,
                    ) -> WallMotion:
        """Return the motion along y with velocities, averages over the columns (columns,).

        ``now`` and ``before`` are those of the last two steps, for a BDF2 acceleration.
        """
        return WallMotion(*motion_along(velocity, now, before, dt, self.line.angles,
                                        self.line.slope))

    def jump(self, pressure: np.ndarray) -> np.ndarray:
        """Return pressure below less above (columns,) from the pressure on the nodes (n,)."""
        return _nodes_to_columns(pressure, self.line.shift)


class Geometry:
    """Maps of one grid with time step ``dt`` (c/U)."""

    def __init__(self, exterior: Exterior, dt: float):
        """Prepare for one grid."""
        self.mapping = Mapping(exterior)
        self._dt = dt

    def follow(self, wall: Wall, height: np.ndarray, now: Map, before: Map) -> WallGeometry:
        """Return the map that follows ``wall``, moving from ``now``, of ``height``."""
        return WallGeometry(*self.mapping.move(wall.height, height, now, before, self._dt))

    def at_rest(self, m: Map) -> WallGeometry:
        """Return a membrane at rest."""
        return WallGeometry(m, np.zeros_like(m.shape), 0.0, self.mapping.wall(m))


@kernel
def _weights(s):
    """Return the weights of cubic interpolation at -1, 0, 1 and 2."""
    return (-s * (s - 1.0) * (s - 2.0) / 6.0, (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
            -(s + 1.0) * s * (s - 2.0) / 2.0, (s + 1.0) * s * (s - 1.0) / 6.0)


@kernel
def motion_along(velocity, now, before, dt, angles, slope):
    """Return the fields of a `WallMotion`, see `WallGeometry.wall_motion`.

    They are interpolated cubically; columns lie at theta = pi - (c + 1/2) d theta, even in theta.
    """
    columns, n = velocity.size, angles.size
    motion = np.empty((4, n))           # one array crosses over sooner than four
    u, v, normal, speed = motion[0], motion[1], motion[2], motion[3]
    for i in range(n):
        position = columns - min(angles[i], 2.0 * np.pi - angles[i]) * columns / np.pi - 0.5
        first = np.intp(np.floor(position))
        weights = _weights(position - first)
        rise, change = 0.0, 0.0
        for m in range(4):              # theta may leave [0, pi] by half a column
            c = first - 1 + m
            c = -1 - c if c < 0 else min(c, 2 * columns - 1 - c)
            rise += weights[m] * velocity[c]
            change += weights[m] * (3.0 * velocity[c] - 4.0 * now[c] + before[c])
        u[i], v[i], speed[i] = rise * slope[i].real, rise * slope[i].imag, rise
        normal[i] = change / (2.0 * dt) * slope[i].imag
    return motion


@kernel
def _padded(values):
    """Return one and a half periods of ``values``: no column moves by a quarter."""
    quarter = values.size // 4
    out = np.empty(6 * quarter)
    for i in range(out.size):
        out[i] = values[(i + 3 * quarter) % values.size]
    return out


@kernel
def _at(padded, position):
    """Interpolate cubically at ``position``, counted in nodes, see `_padded`."""
    first = np.intp(np.floor(position))
    a, b, c, d = _weights(position - first)
    at = first + padded.size // 6
    return a * padded[at - 1] + b * padded[at] + c * padded[at + 1] + d * padded[at + 2]


@kernel
def _nodes_to_columns(pressure, shift):
    """Return the jump at the column centres; a node at xi has the angle xi + shift."""
    columns = pressure.size // 2
    per_node = columns / np.pi
    jump = np.empty(columns)
    shift, pressure = _padded(shift), _padded(pressure)
    for c in range(columns):
        above, below = columns - 1.0 - c, columns + 1.0 * c         # places on a flat plate
        upper, lower = above, below
        for _ in range(6):
            upper = above - _at(shift, upper) * per_node
            lower = below - _at(shift, lower) * per_node
        jump[c] = _at(pressure, lower) - _at(pressure, upper)
    return jump

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the flow needs of the map: metric and grid flux in the strip, and the wall on its nodes."""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.mapping import Map, Mapping
from dewing_sim.fluid.kernels import kernel


@dataclass(frozen=True)
class Surroundings:
    """The strip around one shape of the membrane."""

    map: Map
    h2: np.ndarray                  # (rows, n) |z_zeta|^2
    grid_flux: np.ndarray | None    # (rows, n) z_t conj(z_zeta), None for a map at rest
    slope: np.ndarray               # (n,) z_zeta on the membrane
    angles: np.ndarray              # (n,) theta of the nodes, x = (1 + cos theta) / 2
    shift: np.ndarray               # (n,) theta - xi

    def on_nodes(self, values: np.ndarray) -> np.ndarray:
        """Return column averages (columns,) interpolated to the nodes of both sides (n,)."""
        return _columns_to_nodes(values, self.angles)

    def wall_fluxes(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return U and V (n,) of the membrane moving along y with column velocities."""
        rise = self.on_nodes(velocity)
        return rise * self.slope.real, rise * self.slope.imag

    def jump(self, pressure: np.ndarray) -> np.ndarray:
        """Return pressure below less above (columns,) from the pressure on the nodes (n,)."""
        return _nodes_to_columns(pressure, self.shift)


class Geometry:
    """Maps of one grid with time step ``dt`` (c/U)."""

    def __init__(self, grid: Grid, dt: float):
        """Prepare the map's transforms."""
        self.grid = grid
        self.dt = dt
        self.mapping = Mapping(grid)
        self._resting: Surroundings | None = None       # the last one

    def follow(self, wall: Wall, height: np.ndarray, now: Map, before: Map) -> Surroundings:
        """Return the map that follows ``wall``, moving from ``now``, of ``height``."""
        if np.array_equal(wall.height, height):
            m = now
            if np.array_equal(before.shape, now.shape):
                return self.at_rest(now)
        else:
            near = Map(2.0 * now.shape - before.shape, 2.0 * now.edges - before.edges)
            m = self.mapping.follow(wall.height, near)
        scale, shape = ((3.0 * new - 4.0 * old + older) / (2.0 * self.dt) for new, old, older in (
            (m.scale, now.scale, before.scale), (m.shape, now.shape, before.shape)))
        return self._around(m, *self.mapping.metric_and_flux(m, scale, shape))

    def at_rest(self, m: Map) -> Surroundings:
        """Return the strip around a membrane at rest."""
        known = self._resting
        if known is None or not (np.array_equal(known.map.shape, m.shape)
                                 and np.array_equal(known.map.edges, m.edges)):
            known = self._around(m, self.mapping.metric(m), None)
            self._resting = known
        return known

    def jump(self, m: Map, pressure: np.ndarray) -> np.ndarray:
        """Return pressure below less above (columns,) from the pressure on the nodes (n,)."""
        return _nodes_to_columns(pressure, self.mapping.angles(m) - self.grid.xi)

    def _around(self, m: Map, h2: np.ndarray, grid_flux: np.ndarray | None) -> Surroundings:
        angles = self.mapping.angles(m)
        return Surroundings(m, h2, grid_flux, self.mapping.slope(m), angles,
                            angles - self.grid.xi)


@kernel
def _weights(s):
    """Return the weights of cubic interpolation at -1, 0, 1 and 2."""
    return (-s * (s - 1.0) * (s - 2.0) / 6.0, (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
            -(s + 1.0) * s * (s - 2.0) / 2.0, (s + 1.0) * s * (s - 1.0) / 6.0)


@kernel
def _columns_to_nodes(values, angles):
    """Interpolate cubically; columns lie at theta = pi - (c + 1/2) d theta, even in theta."""
    columns = values.size
    padded = np.empty(columns + 4)      # theta may leave [0, pi] by half a column
    for c in range(columns):
        padded[c + 2] = values[c]
    for m in range(2):
        padded[1 - m] = values[m]
        padded[columns + 2 + m] = values[columns - 1 - m]
    out = np.empty(angles.size)
    for i in range(angles.size):
        angle = min(angles[i], 2.0 * np.pi - angles[i])
        position = columns - angle * columns / np.pi - 0.5
        first = int(np.floor(position))
        a, b, c, d = _weights(position - first)
        out[i] = (a * padded[first + 1] + b * padded[first + 2] + c * padded[first + 3]
                  + d * padded[first + 4])
    return out


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
    first = int(np.floor(position))
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

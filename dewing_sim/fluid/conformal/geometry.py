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
    """The strip around one shape of the membrane; arrays are (rows, n)."""

    map: Map
    h2: np.ndarray                  # |z_zeta|^2
    grid_flux: np.ndarray | None    # z_t conj(z_zeta), None for a map at rest
    wall_slope: np.ndarray          # z_zeta (n,) on the membrane


class Geometry:
    """Maps of one grid with time step ``dt`` (c/U)."""

    def __init__(self, grid: Grid, dt: float):
        """Prepare the map's transforms."""
        self.grid = grid
        self.dt = dt
        self.mapping = Mapping(grid)
        self._resting: Surroundings | None = None       # last map at rest

    def surroundings(self, wall: Wall, height: np.ndarray, now: Map, before: Map) -> Surroundings:
        """Return the map that follows ``wall``, moving from ``now``, of ``height``."""
        if np.array_equal(wall.height, height):
            m = now
            if np.array_equal(before.shape, now.shape):
                return self._at_rest(now)
        else:
            m = self.mapping.follow(wall.height, now)
        slope = self.mapping.slope(m)
        factors = np.array([3.0, -4.0, 1.0]) / (2.0 * self.dt)
        scale = factors @ [m.scale, now.scale, before.scale]
        shape = factors @ [m.shape, now.shape, before.shape]
        h2, flux = _metric_and_flux(slope, self.mapping.rate(scale, shape))
        return Surroundings(m, h2, flux, slope[0])

    def wall_fluxes(self, around: Surroundings, velocity: np.ndarray,
                    ) -> tuple[np.ndarray, np.ndarray]:
        """Return U and V (n,) of the membrane moving along y with column velocities."""
        rise = self.on_nodes(around.map, velocity)
        return rise * around.wall_slope.real, rise * around.wall_slope.imag

    def on_nodes(self, m: Map, values: np.ndarray) -> np.ndarray:
        """Return column averages (columns,) interpolated to the nodes of both sides (n,)."""
        return _columns_to_nodes(values, self.mapping.angles(m))

    def jump(self, m: Map, pressure: np.ndarray) -> np.ndarray:
        """Return pressure below less above (columns,) from the pressure on the nodes (n,)."""
        return _nodes_to_columns(pressure, self.mapping.angles(m) - self.grid.xi, self.grid.step)

    def _at_rest(self, m: Map) -> Surroundings:
        known = self._resting
        if known is None or not (np.array_equal(known.map.shape, m.shape)
                                 and np.array_equal(known.map.edges, m.edges)):
            slope = self.mapping.slope(m)
            known = Surroundings(m, np.abs(slope)**2, None, slope[0])
            self._resting = known
        return known


@kernel
def _metric_and_flux(slope, rate):
    """Return |z_zeta|^2 and z_t conj(z_zeta)."""
    rows, n = slope.shape
    h2, flux = np.empty((rows, n)), np.empty((rows, n), dtype=np.complex128)
    for j in range(rows):
        for i in range(n):
            x, y, x_t, y_t = slope[j, i].real, slope[j, i].imag, rate[j, i].real, rate[j, i].imag
            h2[j, i] = x * x + y * y
            flux[j, i] = complex(x_t * x + y_t * y, y_t * x - x_t * y)
    return h2, flux


@kernel
def _columns_to_nodes(values, angles):
    """Interpolate cubically; columns lie at theta = pi - (c + 1/2) d theta, even in theta."""
    columns = values.size
    out = np.empty(angles.size)
    for i in range(angles.size):
        position = columns - angles[i] * columns / np.pi - 0.5
        first = int(np.floor(position))
        total = 0.0
        for m in range(-1, 3):
            weight = 1.0
            for other in range(-1, 3):
                if other != m:
                    weight *= (position - first - other) / (m - other)
            index = first + m
            if index < 0:
                index = -1 - index
            if index >= columns:
                index = 2 * columns - 1 - index
            total += weight * values[index]
        out[i] = total
    return out


@kernel
def _periodic(values, position):
    """Interpolate cubically at ``position``, counted in nodes."""
    first = int(np.floor(position))
    total = 0.0
    for m in range(-1, 3):
        weight = 1.0
        for other in range(-1, 3):
            if other != m:
                weight *= (position - first - other) / (m - other)
        total += weight * values[(first + m) % values.size]
    return total


@kernel
def _nodes_to_columns(pressure, shift, step):
    """Return the jump at the column centres; a node at xi has the angle xi + shift."""
    columns = pressure.size // 2
    jump = np.empty(columns)
    for c in range(columns):
        above, below = columns - 1.0 - c, columns + 1.0 * c         # places on a flat plate
        upper, lower = above, below
        for _ in range(6):
            upper = above - _periodic(shift, upper) / step
            lower = below - _periodic(shift, lower) / step
        jump[c] = _periodic(pressure, lower) - _periodic(pressure, upper)
    return jump

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The shear map y = eta + Y(x, t) g(eta) that carries the grid along with the membrane.

g = exp(-eta^2) decays within a chord, so the far grid never moves.  With x = xi the Jacobian is
J = 1 + Y g' and the slope of a grid line s = Y_x g: products of 1-D arrays, nothing to store.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.errors import Diverged
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume.grid import Grid


class Metrics(NamedTuple):
    """1-D factors of the metric at faces (f) and centres (c) of the columns."""

    height_f: np.ndarray            # Y (nx + 1,)
    height_c: np.ndarray            # Y (nx,)
    slope_f: np.ndarray             # Y_x (nx + 1,)
    slope_c: np.ndarray             # Y_x (nx,)
    velocity: np.ndarray            # Y_t at the centres (nx,)


class Decay(NamedTuple):
    """g and dg/deta at faces (f) and centres (c) of the rows."""

    f: np.ndarray
    c: np.ndarray
    df: np.ndarray
    dc: np.ndarray


def decay(grid: Grid) -> Decay:
    """Return the decay function of the map on ``grid``.

    Its slopes are differences of its own values, so that a uniform stream has exactly no
    divergence on the deformed grid; at the outer faces they are zero.
    """
    f, c = np.exp(-grid.y**2), np.exp(-grid.yc**2)
    df = np.zeros_like(f)
    df[1:-1] = np.diff(c) / grid.dyf[1:-1]
    return Decay(f, c, df, np.diff(f) / grid.dy)


def metrics(grid: Grid, wall: Wall) -> Metrics:
    """Return the metric factors for a wall; beyond the edges its end heights decay."""
    height_f = _extend(grid, wall.height)
    height_c = 0.5 * (height_f[1:] + height_f[:-1])
    if not np.abs(height_f).max() < 0.8:        # J > 0 needs |Y| < 1.16
        raise Diverged(f'the membrane reached {np.abs(height_f).max():.3g} chords of deflection; '
                       'the moving grid admits 0.8: lower the load or the time step')
    slope_c = np.diff(height_f) / grid.dx
    slope_f = np.zeros_like(height_f)
    slope_f[1:-1] = np.diff(height_c) / grid.dxf[1:-1]
    return Metrics(height_f, height_c, slope_f, slope_c, grid_velocity(grid, wall))


def grid_velocity(grid: Grid, wall: Wall) -> np.ndarray:
    """Return Y_t at the column centres (nx,)."""
    upstream, downstream = _decays(grid, grid.xc[:grid.leading], grid.xc[grid.trailing:])
    return np.concatenate((wall.edge_velocity[0] * upstream, wall.velocity,
                           wall.edge_velocity[1] * downstream))


def _extend(grid: Grid, height: np.ndarray) -> np.ndarray:
    upstream, downstream = _decays(grid, grid.x[:grid.leading], grid.x[grid.trailing + 1:])
    return np.concatenate((height[0] * upstream, height, height[-1] * downstream))


def _decays(grid: Grid, before: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far the grid follows the edges at stations before and behind the plate."""
    return (np.exp(-(before - grid.x[grid.leading])**2),
            np.exp(-(behind - grid.x[grid.trailing])**2))

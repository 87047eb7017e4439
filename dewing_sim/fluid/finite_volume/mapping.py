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
from dewing_sim.machine.kernels import kernel


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
    require_room(np.abs(wall.height).max())
    return metrics_of(wall.height, wall.velocity, *wall.edge_velocity, Following.of(grid))


def require_room(deflection: float) -> None:
    """Raise `Diverged` for a wall that leaves the chord (by ``deflection``, c) too far."""
    if not deflection < 0.8:                    # J > 0 needs |Y| < 1.16
        raise Diverged(f'the membrane reached {deflection:.3g} chords of deflection; '
                       'the moving grid admits 0.8: lower the load or the time step')


class Following(NamedTuple):
    """How far faces and centres of the columns follow the nearest edge of the wall, see `Grid`."""

    face: np.ndarray
    centre: np.ndarray
    leading: int
    dx: np.ndarray
    dxf: np.ndarray

    @classmethod
    def of(cls, grid: Grid) -> 'Following':
        """Return the tables of ``grid``."""
        return cls(grid.following_f, grid.following_c, grid.leading, grid.dx, grid.dxf)


@kernel
def metrics_of(height, velocity, before, behind, following):
    """Return the `Metrics` of a wall whose edges rise at the rates ``before`` and ``behind``."""
    nx, dx, dxf = len(following.dx), following.dx, following.dxf
    height_f = _extend(height[0], height, height[-1], following.face, following.leading)
    height_c, slope_c, slope_f = np.empty(nx), np.empty(nx), np.zeros(nx + 1)
    for i in range(nx):
        height_c[i] = 0.5 * (height_f[i] + height_f[i + 1])
        slope_c[i] = (height_f[i + 1] - height_f[i]) / dx[i]
    for i in range(1, nx):
        slope_f[i] = (height_c[i] - height_c[i - 1]) / dxf[i]
    return Metrics(height_f, height_c, slope_f, slope_c,
                   _extend(before, velocity, behind, following.centre, following.leading))


@kernel
def _extend(before, values, behind, following, leading):
    """Return ``values`` on the plate, and the decaying values of its ends beside it."""
    out = np.empty(len(following))
    trailing = leading + len(values)
    for i in range(leading):
        out[i] = before * following[i]
    for i in range(leading, trailing):
        out[i] = values[i - leading]
    for i in range(trailing, len(out)):
        out[i] = behind * following[i]
    return out

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From predicted velocities to fluxes without divergence, and back.

The fluxes through the sheared cell faces are Fx = J u and Fy = v - s u.  The flat pressure
operator corrects the *fluxes*: exactly divergence-free on the deformed grid, while the mismatch
with the metric acts on the pressure increment only, which is O(dt).
"""

import numpy as np

from dewing_sim.fluid.finite_volume.grid import Grid
from dewing_sim.fluid.finite_volume.mapping import Decay, Metrics
from dewing_sim.machine.kernels import kernel


def fluxes(grid: Grid, g: Decay, m: Metrics, u: np.ndarray, v: np.ndarray,
           ) -> tuple[np.ndarray, np.ndarray]:
    """Return Fx (nx + 1, ny) and Fy (nx, ny + 1) of the velocities."""
    fx, fy = np.empty_like(u), v.copy()
    _to_fluxes(u, fx, fy, grid.lattice, m, g)
    return fx, fy


def velocities(grid: Grid, g: Decay, m: Metrics, fx: np.ndarray, fy: np.ndarray,
               ) -> tuple[np.ndarray, np.ndarray]:
    """Return u and v of the fluxes: the inverse of `fluxes`."""
    u, v = np.empty_like(fx), fy.copy()
    _to_velocities(fx, u, v, grid.lattice, m, g)
    return u, v


@kernel
def _shear(u, i, j, dy, slope, g):
    """Return s times u interpolated to the eta-face j of column i."""
    lower, upper = u[i, j - 1] + u[i + 1, j - 1], u[i, j] + u[i + 1, j]
    return (0.5 * slope * g * (dy[j] * lower + dy[j - 1] * upper) / (dy[j - 1] + dy[j]))


@kernel
def _to_fluxes(u, fx, fy, lattice, m, g):
    dy, leading, trailing = lattice.dy, lattice.leading, lattice.trailing
    height_f, slope_c, gf, dgc = m.height_f, m.slope_c, g.f, g.dc
    nx, ny = len(slope_c), len(dy)
    for i in range(nx + 1):
        for j in range(ny):
            fx[i, j] = u[i, j] * (1.0 + height_f[i] * dgc[j])
    for i in range(nx):
        if slope_c[i] != 0.0:
            at_wall = fy[i, ny // 2]
            for j in range(1, ny):
                fy[i, j] -= _shear(u, i, j, dy, slope_c[i], gf[j])
            if leading <= i < trailing:             # u = 0 on the plate
                fy[i, ny // 2] = at_wall


@kernel
def _to_velocities(fx, u, v, lattice, m, g):
    dy, leading, trailing = lattice.dy, lattice.leading, lattice.trailing
    height_f, slope_c, gf, dgc = m.height_f, m.slope_c, g.f, g.dc
    nx, ny = len(slope_c), len(dy)
    for i in range(nx + 1):
        for j in range(ny):
            u[i, j] = fx[i, j] / (1.0 + height_f[i] * dgc[j])
    for i in range(nx):
        if slope_c[i] != 0.0:
            at_wall = v[i, ny // 2]
            for j in range(1, ny):
                v[i, j] += _shear(u, i, j, dy, slope_c[i], gf[j])
            if leading <= i < trailing:             # u = 0 on the plate
                v[i, ny // 2] = at_wall


@kernel
def divergence(fx, fy, dx, dy):
    """Return the net outflow of each cell (nx, ny)."""
    nx, ny = len(dx), len(dy)
    out = np.empty((nx, ny))
    for i in range(nx):
        for j in range(ny):
            out[i, j] = (dy[j] * (fx[i + 1, j] - fx[i, j]) + dx[i] * (fy[i, j + 1] - fy[i, j]))
    return out


@kernel
def correct(fx, fy, phi, lattice, theta):
    """Subtract theta grad phi from the fluxes in place, except through the plate and far field."""
    _, _, dxf, dyf, leading, trailing = lattice
    nx, ny = phi.shape
    middle = ny // 2
    for i in range(1, nx):
        for j in range(ny):
            fx[i, j] -= theta * (phi[i, j] - phi[i - 1, j]) / dxf[i]
    for j in range(ny):
        fx[nx, j] += theta * phi[nx - 1, j] / dxf[nx]
    for i in range(nx):
        on_plate = leading <= i < trailing
        at_plate = fy[i, middle]
        for j in range(1, ny):
            fy[i, j] -= theta * (phi[i, j] - phi[i, j - 1]) / dyf[j]
        if on_plate:
            fy[i, middle] = at_plate

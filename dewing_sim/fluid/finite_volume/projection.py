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
from dewing_sim.fluid.finite_volume.transport import over_jacobian
from dewing_sim.machine.kernels import kernel, lean_kernel, lean_part, stage


def fluxes(grid: Grid, g: Decay, m: Metrics, u: np.ndarray, v: np.ndarray,
           ) -> tuple[np.ndarray, np.ndarray]:
    """Return Fx (nx + 1, ny) and Fy (nx, ny + 1) of the velocities."""
    fx, fy = np.empty_like(u), np.empty_like(v)
    to_fluxes(u, v, grid.lattice, m, g, fx, fy)
    return fx, fy


def velocities(grid: Grid, g: Decay, m: Metrics, fx: np.ndarray, fy: np.ndarray,
               ) -> tuple[np.ndarray, np.ndarray]:
    """Return u and v of the fluxes: the inverse of `fluxes`."""
    jacobian = 1.0 + np.outer(m.height_f, g.dc)
    u, v = fx / jacobian, fy.copy()
    for i in range(len(v)):
        _add_shear(i, 1.0, u, grid.lattice, m, g, v)
    return u, v


@lean_kernel
def to_fluxes(u, v, lattice, m, g, fx, fy):
    """Fill the fluxes of the velocities, see `fluxes`."""
    nx, ny = len(lattice.dx), len(lattice.dy)
    for i in range(nx + 1):
        for j in range(ny):
            fx[i, j] = u[i, j] * (1.0 + m.height_f[i] * g.dc[j])
    for i in range(nx):
        for j in range(ny + 1):
            fy[i, j] = v[i, j]
        _add_shear(i, -1.0, u, lattice, m, g, fy)


@lean_kernel
def _add_shear(i, sign, u, lattice, m, g, v):
    """Add ``sign`` s u to the inner eta-faces of column i, but for the plate, where u = 0."""
    slope, share, middle = 0.5 * sign * m.slope_c[i], lattice.below, len(lattice.dy) // 2
    if slope != 0.0:
        at_wall = v[i, middle]
        for j in range(1, len(lattice.dy)):
            lower, upper = u[i, j - 1] + u[i + 1, j - 1], u[i, j] + u[i + 1, j]
            v[i, j] += slope * g.f[j] * ((1.0 - share[j]) * lower + share[j] * upper)
        if lattice.leading <= i < lattice.trailing:
            v[i, middle] = at_wall


@stage
def outflow(fx, fy, dx, dy, i, j):
    """Return the net outflow of a cell."""
    return dy[j] * (fx[i + 1, j] - fx[i, j]) + dx[i] * (fy[i, j + 1] - fy[i, j])


@kernel
def divergence(fx, fy, dx, dy):
    """Return the net outflow of each cell (nx, ny)."""
    out = np.empty((len(dx), len(dy)))
    for i in range(len(dx)):
        for j in range(len(dy)):
            out[i, j] = outflow(fx, fy, dx, dy, i, j)
    return out


@lean_part
def correct(before, halves, m, solver, after):
    """Subtract theta grad phi from the fluxes, except through the plate and the far field.

    ``before`` holds Fx, Fy and p, ``halves`` even and odd parts of phi; u, v, Fx, W and p
    ``after`` are filled.  A line is finished while it is in the first-level cache.
    """
    nx, ny = before.p.shape
    phi, over_j = solver.fields.phi, solver.fields.lines.over_j
    for i in solver.order:
        if i < nx:
            _unfold(i, halves, before.p, phi, after.p)
        _through_xi(i, before.fx, phi, solver, after.fx)
        over_jacobian(m.height_f[i], solver.g.dc, over_j)
        for j in range(ny):
            after.u[i, j] = after.fx[i, j] * over_j[j]
        if i < nx:
            _through_eta(i, before, phi, m, solver, after)
        if i > 0:
            _add_shear(i - 1, 1.0, after.u, solver.lattice, m, solver.g, after.v)


@stage
def _unfold(i, halves, before, phi, after):
    """Fill line i of phi, in a row that is taken by turns, and of the new pressure."""
    half, row = halves.shape[2], i % 2
    for k in range(half):
        phi[row, half + k] = halves[0, i, k] + halves[1, i, k]
        phi[row, half - 1 - k] = halves[0, i, k] - halves[1, i, k]
    for j in range(2 * half):
        after[i, j] = before[i, j] + phi[row, j]


@stage
def _through_xi(i, before, phi, solver, fx):
    """Correct the flux through the xi-face i; phi = 0 behind the outlet."""
    nx, ny, share = len(solver.lattice.dx), fx.shape[1], solver.theta / solver.lattice.dxf[i]
    west, east = (i + 1) % 2, i % 2
    if i == 0:
        for j in range(ny):
            fx[i, j] = before[i, j]
    elif i < nx:
        for j in range(ny):
            fx[i, j] = before[i, j] - share * (phi[east, j] - phi[west, j])
    else:
        for j in range(ny):
            fx[i, j] = before[i, j] + share * phi[west, j]


@stage
def _through_eta(i, before, phi, m, solver, after):
    """Correct the flux through the eta-faces of column i; Fy goes to v, less the grid to W."""
    lattice, rate, row = solver.lattice, m.velocity[i], i % 2
    ny, v, share = len(lattice.dy), after.v, solver.rates.theta_per_dyf
    v[i, 0], v[i, ny] = before.fy[i, 0], before.fy[i, ny]
    for j in range(1, ny):
        v[i, j] = before.fy[i, j] - share[j] * (phi[row, j] - phi[row, j - 1])
    if lattice.leading <= i < lattice.trailing:
        v[i, ny // 2] = rate
    for j in range(ny + 1):
        after.w[i, j] = v[i, j] - rate * solver.g.f[j]

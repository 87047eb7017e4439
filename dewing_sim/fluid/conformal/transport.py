# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The vorticity equation in flux form on the moving map, and its residual at the new time.

    (h^2 w)_t + [(V - G_V) w]_eta + [(U - G_U) w]_xi = nu (w_xixi + w_etaeta),

V = psi_xi, U = -psi_eta, and G_V + i G_U = z_t conj(z_zeta) is the exact flux of the grid.  Fluxes
are differences of psi at the cell corners: free of divergence to round-off.  Functions work on the
lines from ``first`` to before ``stop``: a few lines pass through all of them while at hand.
"""

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.machine.kernels import stage

FIRST_ORDER = 0.65      # radius about an edge, per dt, of first-order extrapolation
UPWIND = 0.5            # share of the dissipation of third-order upwind fluxes
SEVEN, ONE = 7.0 / 12.0, 1.0 / 12.0     # weights of fourth order; a division takes far longer


def extrapolation_share(grid: Grid, trailing: float, leading: float, dt: float) -> np.ndarray:
    """Return the share (n, rows) of second-order extrapolation, less than 1 near the edges.

    There, at xi = ``trailing`` and ``leading``, the CFL number is so large that only first order
    is stable.
    """
    distances = [0.5 * np.abs(np.cosh(grid.eta + 1j * (grid.xi[:, None] - edge)) - 1.0)
                 for edge in (trailing, leading)]
    return np.clip(np.minimum(*distances) / (FIRST_ORDER * dt) - 1.0, 0.0, 1.0)


@stage
def extrapolate(now, before, share, out):
    """Write now + share (now - before)."""
    for i in range(now.shape[0]):
        for j in range(now.shape[1]):
            out[i, j] = now[i, j] + share[i, j] * (now[i, j] - before[i, j])


@stage
def fluxes(psi, sin_corner, scale, grid, first, stop, v, u):
    """Write V through the outer face of each row and U after each node, both (n, rows).

    ``psi`` is psi' at the corners; the stream adds 2 a sinh(eta) sin(xi - alpha), the last factor
    being ``sin_corner`` (n,) and a the ``scale``.
    """
    n, rows = psi.shape
    per_step, sinh_face = 1.0 / grid.step, grid.sinh_face
    for i in range(first, stop):
        before = i - 1 if i else n - 1
        rise = 2.0 * scale * (sin_corner[i] - sin_corner[before])
        corner = 2.0 * scale * sin_corner[i]
        for j in range(rows):
            v[i, j] = (psi[i, j] - psi[before, j] + rise * sinh_face[j]) * per_step
        u[i, 0] = 0.0
        for j in range(1, rows):
            u[i, j] = (psi[i, j - 1] - psi[i, j]
                       + corner * (sinh_face[j - 1] - sinh_face[j])) * grid.per_width[j]


@stage
def subtract_grid_flux(grid_v, grid_u, first, stop, v, u):
    """Subtract G_V and G_U (n, rows), given on the nodes, from the fluxes in place."""
    n, rows = v.shape
    for i in range(first, stop):
        a, b, c = i - 1 if i else n - 1, (i + 1) % n, (i + 2) % n
        for j in range(rows - 1):
            v[i, j] -= 0.5 * (grid_v[i, j] + grid_v[i, j + 1])
        v[i, rows - 1] -= grid_v[i, rows - 1]
        for j in range(rows):
            u[i, j] -= (9.0 * (grid_u[i, j] + grid_u[b, j]) - grid_u[a, j] - grid_u[c, j]) / 16.0


@stage
def _flux(a, b, c, d, velocity):
    """Return the flux from b to c by 4th-order central and 3rd-order upwind differences."""
    return (velocity * (SEVEN * (b + c) - ONE * (a + d))
            + ONE * UPWIND * abs(velocity) * (3.0 * (b - c) - a + d))


@stage
def _across(w, v, grid, nu, flux):
    """Write the flux along eta, diffusion included, through the outer face of each cell (rows,).

    It is of second order next to the membrane and the outer boundary, through which nothing
    diffuses and nothing comes in.
    """
    last = w.size - 1
    for j in range(last - 2):
        flux[j + 1] = (_flux(w[j], w[j + 1], w[j + 2], w[j + 3], v[j + 1])
                       + nu * grid.per_gap[j + 1] * (w[j + 1] - w[j + 2]))
    for j in (0, last - 1):
        flux[j] = 0.5 * v[j] * (w[j] + w[j + 1]) + nu * grid.per_gap[j] * (w[j] - w[j + 1])
    flux[last] = max(v[last], 0.0) * w[last]


@stage
def _along(w, i, u, spread, flux):
    """Write the flux along xi, diffusion included, from line ``i`` to the next (rows,)."""
    n, rows = w.shape
    before, after, beyond = (i - 1) % n, (i + 1) % n, (i + 2) % n
    for j in range(rows):
        flux[j] = (_flux(w[before, j], w[i, j], w[after, j], w[beyond, j], u[i, j])
                   + spread * (w[i, j] - w[after, j]))


@stage
def residual(w, h2, q, q_before, v, u, grid, nu, dt, first, stop, out):
    """Write the imbalance of the vorticity equation (n, rows), 0 in row 0, for the guess ``w``.

    It is -(3 h^2 w - 4 q_n + q_n-1) / (2 dt) less the outflow of each cell.  Returns the vorticity
    that leaves these lines through the outer boundary.
    """
    n, rows = w.shape
    across, along = np.empty(rows), np.empty((2, rows))     # the last two lines in turn
    per_dt, per_step = 1.0 / dt, 1.0 / grid.step
    outflow = 0.0
    _along(w, (first - 1) % n, u, nu * per_step, along[first % 2])
    for i in range(first, stop):
        before, after = i % 2, (i + 1) % 2
        _across(w[i], v[i], grid, nu, across)
        _along(w, i, u, nu * per_step, along[after])
        outflow += across[rows - 1]
        out[i, 0] = 0.0
        for j in range(1, rows):
            out[i, j] = ((2.0 * q[i, j] - 0.5 * q_before[i, j] - 1.5 * h2[i, j] * w[i, j]) * per_dt
                         - (across[j] - across[j - 1]) * grid.per_width[j]
                         - (along[after, j] - along[before, j]) * per_step)
    return outflow * grid.step

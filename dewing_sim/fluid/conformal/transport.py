# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The vorticity equation in flux form on the moving map, and its residual at the new time.

    (h^2 w)_t + [(V - G_V) w]_eta + [(U - G_U) w]_xi = nu (w_xixi + w_etaeta),

V = psi_xi, U = -psi_eta, and G_V + i G_U = z_t conj(z_zeta) is the exact flux of the grid.  Fluxes
are differences of psi at the cell corners: free of divergence to round-off.
"""

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.kernels import kernel

FIRST_ORDER = 0.65      # radius about an edge, per dt, of first-order extrapolation
UPWIND = 0.5            # share of the dissipation of third-order upwind fluxes


def extrapolation_share(grid: Grid, trailing: float, leading: float, dt: float) -> np.ndarray:
    """Return the share (rows, n) of second-order extrapolation, less than 1 near the edges.

    There, at xi = ``trailing`` and ``leading``, the CFL number is so large that only first order
    is stable.
    """
    distances = [0.5 * np.abs(np.cosh(grid.eta[:, None] + 1j * (grid.xi - edge)) - 1.0)
                 for edge in (trailing, leading)]
    return np.clip(np.minimum(*distances) / (FIRST_ORDER * dt) - 1.0, 0.0, 1.0)


@kernel
def extrapolate(now, before, share):
    """Return now + share (now - before)."""
    out = np.empty_like(now)
    for j in range(now.shape[0]):
        for i in range(now.shape[1]):
            out[j, i] = now[j, i] + share[j, i] * (now[j, i] - before[j, i])
    return out


@kernel
def fluxes(psi, sinh_face, sin_corner, step, width):
    """Return V (rows, n) through the outer face of each row, U (rows, n) after each node.

    ``psi`` is psi' at the corners; the stream adds 2 a sinh(eta) sin(xi - alpha), given as the
    product of ``sinh_face`` and ``sin_corner``.
    """
    rows, n = psi.shape
    v, u = np.empty((rows, n)), np.empty((rows, n))
    per_step = 1.0 / step
    for j in range(rows):
        s = sinh_face[j] * per_step
        v[j, 0] = ((psi[j, 0] - psi[j, n - 1]) * per_step
                   + s * (sin_corner[0] - sin_corner[n - 1]))
        for i in range(1, n):
            v[j, i] = ((psi[j, i] - psi[j, i - 1]) * per_step
                       + s * (sin_corner[i] - sin_corner[i - 1]))
    for i in range(n):
        u[0, i] = 0.0
    for j in range(1, rows):
        per_width = -1.0 / width[j]
        s = (sinh_face[j] - sinh_face[j - 1]) * per_width
        for i in range(n):
            u[j, i] = (psi[j, i] - psi[j - 1, i]) * per_width + s * sin_corner[i]
    return v, u


@kernel
def subtract_grid_flux(grid_flux, v, u):
    """Subtract G_V and G_U, given on the nodes as G_V + i G_U, from the fluxes in place."""
    rows, n = v.shape
    padded = np.empty(n + 3)
    for j in range(rows):
        above = min(j + 1, rows - 1)
        for i in range(n):
            v[j, i] -= 0.5 * (grid_flux[j, i].real + grid_flux[above, i].real)
            padded[i + 1] = grid_flux[j, i].imag
        padded[0], padded[n + 1], padded[n + 2] = padded[n], padded[1], padded[2]
        for i in range(n):
            u[j, i] -= (9.0 * (padded[i + 1] + padded[i + 2]) - padded[i] - padded[i + 3]) / 16.0


@kernel
def subtract_convection(w, v, u, step, width, out):
    """Subtract the convective outflow of each cell of rows 1 and outwards from ``out``.

    Returns the vorticity that leaves through the outer boundary.
    """
    rows, n = w.shape
    flux = np.empty((2, n))
    padded = np.empty(n + 3)
    along = np.empty(n + 1)
    eighth = UPWIND / 12.0
    for j in range(rows):
        old, new = (j + 1) % 2, j % 2
        if 0 < j < rows - 2:
            for i in range(n):
                a, b, c, d = w[j - 1, i], w[j, i], w[j + 1, i], w[j + 2, i]
                flux[new, i] = (v[j, i] * (7.0 * (b + c) - a - d) / 12.0
                                + eighth * abs(v[j, i]) * (3.0 * (b - c) - a + d))
        elif j < rows - 1:
            for i in range(n):
                flux[new, i] = 0.5 * v[j, i] * (w[j, i] + w[j + 1, i])
        else:
            for i in range(n):
                flux[new, i] = max(v[j, i], 0.0) * w[j, i]
        if j == 0:
            continue
        padded[0] = w[j, n - 1]
        for i in range(n):
            padded[i + 1] = w[j, i]
        padded[n + 1] = w[j, 0]
        padded[n + 2] = w[j, 1]
        for i in range(n):
            a, b, c, d = padded[i], padded[i + 1], padded[i + 2], padded[i + 3]
            along[i + 1] = (u[j, i] * (7.0 * (b + c) - a - d) / 12.0
                            + eighth * abs(u[j, i]) * (3.0 * (b - c) - a + d))
        along[0] = along[n]
        per_width, per_step = 1.0 / width[j], 1.0 / step
        for i in range(n):
            out[j, i] -= ((flux[new, i] - flux[old, i]) * per_width
                          + (along[i + 1] - along[i]) * per_step)
    outflow = 0.0
    for i in range(n):
        outflow += flux[(rows - 1) % 2, i]
    return outflow * step


@kernel
def add_diffusion(w, gap, width, step, nu, out):
    """Add nu Laplace w to rows 1 and outwards of ``out``."""
    rows, n = w.shape
    x = nu / step**2
    for j in range(1, rows):
        last = j == rows - 1
        inner = nu / (gap[j - 1] * width[j])
        outer = 0.0 if last else nu / (gap[j] * width[j])
        above = j if last else j + 1
        for i in range(n):
            out[j, i] += inner * (w[j - 1, i] - w[j, i]) + outer * (w[above, i] - w[j, i])
        out[j, 0] += x * (w[j, n - 1] - 2.0 * w[j, 0] + w[j, 1])
        out[j, n - 1] += x * (w[j, n - 2] - 2.0 * w[j, n - 1] + w[j, 0])
        for i in range(1, n - 1):
            out[j, i] += x * (w[j, i - 1] - 2.0 * w[j, i] + w[j, i + 1])


@kernel
def inertia(h, w, q, q_before, dt):
    """Return -(3 h^2 w - 4 q_n + q_n-1) / (2 dt), with H = 3 h^2 / (2 dt) given; 0 in row 0."""
    out = np.zeros_like(w)
    for j in range(1, w.shape[0]):
        for i in range(w.shape[1]):
            out[j, i] = (4.0 * q[j, i] - q_before[j, i]) / (2.0 * dt) - h[j, i] * w[j, i]
    return out

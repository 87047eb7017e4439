# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Alternating-direction implicit sweeps: (H + A_eta) H^-1 (H + A_xi) d = r, r becomes d.

Each factor is tridiagonal, with convection and diffusion of second order in the form that leaves
a constant unchanged.  H is 3 h^2 / (2 dt), except near the edges: there h vanishes, and the error
of the factorisation, A_eta H^-1 A_xi, would exceed the operator itself and drive an instability,
so that H is bounded below by the geometric mean of both operators (`split_inertia`).  In delta
form that delays d only, an error of extrapolation.

The periodic sweep along xi runs across all rows at once; the sweep along eta turns a few lines at
a time, so that both fill SIMD lanes.
"""

import numpy as np

from dewing_sim.fluid.conformal.transport import UPWIND
from dewing_sim.machine.kernels import stage

LANES = 24
SPLITTING = 0.5
# The explicit fluxes are of fourth order, with a symbol up to 5/3 times the implicit one; with
# this factor the mismatch is within 1/4 and extrapolation in time stays stable at any CFL number.
CONVECTION = 4.0 / 3.0
DISSIPATION = UPWIND / 3.0          # bounds that of the explicit fluxes at every wave number


@stage
def split_inertia(h2, v, u, grid, nu, dt, first, stop, out):
    """Write (n, rows) sqrt(H^2 + SPLITTING^2 |A_eta| |A_xi|), 1 in row 0."""
    n, rows = h2.shape
    inertia, per_step = 1.5 / dt, 1.0 / grid.step
    for i in range(first, stop):
        before = i - 1 if i else n - 1
        out[i, 0] = 1.0
        for j in range(1, rows):
            a_eta = grid.per_width[j] * (nu * grid.per_gap[j]
                                         + 0.25 * (abs(v[i, j]) + abs(v[i, j - 1])))
            a_xi = per_step * (nu * per_step + 0.25 * (abs(u[i, j]) + abs(u[before, j])))
            h = inertia * h2[i, j]
            out[i, j] = np.sqrt(h * h + 4.0 * SPLITTING**2 * a_eta * a_xi)


@stage
def sweep_eta(r, h, v, grid, nu, first, stop):
    """Solve (H + A_eta) t = r for rows 1 and outwards of a few lines, in place; r becomes H t.

    ``h`` (n, rows) is H, ``v`` (n, rows) the flux through the outer face of each row.  At most
    LANES lines are turned, so that the sweep runs across them.
    """
    rows, lanes = r.shape[1], stop - first
    t, flux = np.empty((rows, LANES)), np.empty((rows, LANES))
    diagonal, ratio = np.empty((rows, LANES)), np.empty((rows, LANES))
    for k in range(lanes):
        i = first + k
        for j in range(rows):
            t[j, k], flux[j, k], diagonal[j, k] = r[i, j], v[i, j], h[i, j]
        ratio[0, k], t[0, k] = 0.0, 0.0
    for j in range(1, rows):
        per_width = grid.per_width[j]
        open_side = 0.0 if j == rows - 1 else per_width
        inner, outer = nu * grid.per_gap[j - 1] * per_width, nu * grid.per_gap[j] * open_side
        for k in range(lanes):
            below, above = flux[j - 1, k], flux[j, k]
            lower = inner + per_width * (0.5 * CONVECTION * below + DISSIPATION * abs(below))
            upper = outer - open_side * (0.5 * CONVECTION * above - DISSIPATION * abs(above))
            pivot = 1.0 / (diagonal[j, k] + lower + upper - lower * ratio[j - 1, k])
            ratio[j, k] = upper * pivot
            t[j, k] = (t[j, k] + lower * t[j - 1, k]) * pivot
    for j in range(rows - 2, 0, -1):
        for k in range(lanes):
            t[j, k] += ratio[j, k] * t[j + 1, k]
    for k in range(lanes):
        i = first + k
        for j in range(1, rows):
            r[i, j] = t[j, k] * h[i, j]


@stage
def sweep_xi(r, h, u, grid, nu, high, corner):
    """Solve (H + A_xi) d = r on the periodic rows, in place; row 0 is to be without flux.

    ``u`` (n, rows) is the flux through the face after each node; ``high`` and ``corner`` (n, rows)
    are scratch: the upper diagonal and the response to the last unknown.
    """
    n, rows = r.shape
    last, lines = n - 1, grid.lines
    diffusion = nu / (grid.step * grid.step)
    half, upwind = 0.5 * CONVECTION / grid.step, DISSIPATION / grid.step
    for j in range(rows):
        a, b = u[last, j], u[0, j]
        low, up = (diffusion + half * a + upwind * abs(a), diffusion - half * b + upwind * abs(b))
        pivot = 1.0 / (h[0, j] + low + up)
        high[0, j], r[0, j], corner[0, j] = up * pivot, r[0, j] * pivot, low * pivot
    before = 0
    for i in lines[1:last]:
        for j in range(rows):
            a, b = u[before, j], u[i, j]
            low, up = (diffusion + half * a + upwind * abs(a),
                       diffusion - half * b + upwind * abs(b))
            pivot = 1.0 / (h[i, j] + low + up - low * high[before, j])
            high[i, j] = up * pivot
            r[i, j] = (r[i, j] + low * r[before, j]) * pivot
            corner[i, j] = low * corner[before, j] * pivot
        before = i
    for j in range(rows):
        corner[last - 1, j] += high[last - 1, j]
    after = last - 1
    for i in lines[:after][::-1]:
        for j in range(rows):
            r[i, j] += high[i, j] * r[after, j]
            corner[i, j] += high[i, j] * corner[after, j]
        after = i
    for j in range(rows):
        a, b = u[last - 1, j], u[last, j]
        low, up = (diffusion + half * a + upwind * abs(a), diffusion - half * b + upwind * abs(b))
        r[last, j] = ((r[last, j] + low * r[last - 1, j] + up * r[0, j])
                      / (h[last, j] + low + up - low * corner[last - 1, j] - up * corner[0, j]))
    for i in range(last):
        for j in range(rows):
            r[i, j] += corner[i, j] * r[last, j]

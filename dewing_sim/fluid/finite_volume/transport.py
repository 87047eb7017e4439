# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Convection and diffusion of one velocity component as coefficients of its four neighbours.

For a control volume of size J dxi deta the operator is

    (A phi)_P = sum_nb c_nb (phi_P - phi_nb),
    c_nb = theta (D_nb - F_nb / 2 + beta |F_nb| / 2) / (J * width),

with F the outward flux per area of the face relative to the moving grid, D = nu (metric) /
distance and beta the share of upwinding, zero near the membrane.  The convective form
F (phi_nb - phi_P) / 2 has zero row sum: a uniform stream is kept exactly on any moving grid,
without a geometric conservation law.  Fluxes (Fx, W) are those of the projection less the motion
of the grid, extrapolated to the end of the step, 2 F^n - F^{n-1}.

Flux and D of a face are made once, for the volumes on both its sides; of the coefficients only
those of the sweep in eta are stored.  Divisions by J are made where the membrane has left the
chord; elsewhere J = 1.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.machine.kernels import scratch, stage

THIRD = 1.0 / 3.0                   # a product takes a quarter of the time of a division


class Lines(NamedTuple):
    """What belongs to one line of volumes (ny + 1,), or to the faces on both its sides (2, ...).

    The k-th entry of a quantity across belongs to the face below the k-th volume.
    """

    over_j: np.ndarray              # 1 / J of the volumes
    source: np.ndarray              # explicit side of their equations
    rise: np.ndarray                # flux per area through the eta-faces, upwards
    across: np.ndarray              # D of the eta-faces
    run: np.ndarray                 # flux per area through the xi-faces, downstream
    along: np.ndarray               # D of the xi-faces

    @classmethod
    def of(cls, ny: int) -> 'Lines':
        """Return lines for ``ny`` rows of cells."""
        rows = scratch(8, ny + 1)
        return cls(*rows[:4], *scratch(2, 2, ny + 1))


@stage
def extrapolated(now, before, i, j):
    """Return 2 phi^n - phi^{n-1}."""
    return 2.0 * now[i, j] - before[i, j]


@stage
def over_jacobian(height, dg, out):
    """Fill 1 / J of one line, J = 1 + Y g'."""
    if height == 0.0:
        for j in range(len(dg)):
            out[j] = 1.0
    else:
        for j in range(len(dg)):
            out[j] = 1.0 / (1.0 + height * dg[j])


@stage
def conduct(height, slope, g, dg, per_distance, shift, out):
    """Fill D = nu (1 + s^2) / (J distance) of the eta-faces of one line, s = Y_x g.

    ``per_distance`` is nu / distance; the faces at ``g`` go to entries ``shift`` further.
    """
    if height == 0.0 and slope == 0.0:
        for j in range(len(g)):
            out[j + shift] = per_distance[j]
    else:
        for j in range(len(g)):
            s = slope * g[j]
            out[j + shift] = per_distance[j] * (1.0 + s * s) / (1.0 + height * dg[j])


@stage
def u_rise(i, past, m, solver, lines):
    """Fill flux and D of the eta-faces below the volumes of u on the face i."""
    dx, dxf = solver.lattice.dx, solver.lattice.dxf
    w, w_before = past.w, past.w_before
    nx, nf = w.shape
    ahead = min(i, nx - 1)                          # on the outlet half a volume is left
    before, behind = 0.5, 0.5
    if i < nx:
        before, behind = 0.5 * dx[i - 1] / dxf[i], 0.5 * dx[i] / dxf[i]
    for j in range(nf):
        lines.rise[j] = (before * extrapolated(w, w_before, i - 1, j)
                         + behind * extrapolated(w, w_before, ahead, j))
    conduct(m.height_f[i], m.slope_f[i], solver.g.f, solver.g.df, solver.rates.nu_per_dyf, 0,
            lines.across)
    passage = 1.0 - solver.blocked[i]               # around the edges half of it is free
    lines.rise[nf // 2] *= passage
    lines.across[nf // 2] *= passage


@stage
def v_rise(i, past, m, solver, lines):
    """Fill flux and D of the eta-faces below the volumes of v in column i: the cell centres."""
    w, w_before = past.w, past.w_before
    for j in range(w.shape[1] - 1):
        lines.rise[j + 1] = 0.5 * (extrapolated(w, w_before, i, j)
                                   + extrapolated(w, w_before, i, j + 1))
    conduct(m.height_c[i], m.slope_c[i], solver.g.c, solver.g.dc, solver.rates.nu_per_dy, 1,
            lines.across)


@stage
def u_run(i, side, past, m, solver, lines):
    """Fill flux and D of the xi-faces between the volumes of u, in the cells of column i."""
    fx, fx_before, nx, dgc = past.fx, past.fx_before, len(solver.lattice.dx), solver.g.dc
    if i == nx:                                     # outflow: zero gradient
        lines.run[side, :] = 0.0
        lines.along[side, :] = 0.0
    else:
        per_distance, height = solver.nu / solver.lattice.dx[i], m.height_c[i]
        for j in range(len(dgc)):
            lines.run[side, j] = 0.5 * (extrapolated(fx, fx_before, i, j)
                                        + extrapolated(fx, fx_before, i + 1, j))
            lines.along[side, j] = per_distance * (1.0 + height * dgc[j])


@stage
def v_run(i, side, past, m, solver, lines):
    """Fill flux and D of the xi-faces between the volumes of v, on the faces i."""
    fx, fx_before, share = past.fx, past.fx_before, solver.lattice.below
    nx, ny, dgf = len(solver.lattice.dx), fx.shape[1], solver.g.df
    if i == nx:
        lines.run[side, :] = 0.0
        lines.along[side, :] = 0.0
    else:
        per_distance, height = solver.nu / solver.lattice.dxf[i], m.height_f[i]
        for j in range(1, ny):
            lines.run[side, j] = (share[j] * extrapolated(fx, fx_before, i, j - 1)
                                  + (1.0 - share[j]) * extrapolated(fx, fx_before, i, j))
            lines.along[side, j] = per_distance * (1.0 + height * dgf[j])


@stage
def across(i, rows, phi, before, beta_x, beta_y, per_width, lines, south, north):
    """Fill the coefficients of both neighbours in eta, and add BDF2 and their part to the source.

    Of ``phi`` (lines, rows) the ends of a line are given; ``per_width`` is theta / width.
    """
    over_j, source, rise, conductance = lines.over_j, lines.source, lines.rise, lines.across
    for j in range(1, rows - 1):
        half, scale = 0.5 * max(beta_x, beta_y[j]), per_width[j] * over_j[j]
        below, above = rise[j], rise[j + 1]
        low = scale * (conductance[j] + 0.5 * below + half * abs(below))
        up = scale * (conductance[j + 1] - 0.5 * above + half * abs(above))
        here = phi[i, j]
        source[j] += (THIRD * (here - before[i, j]) - low * (here - phi[i, j - 1])
                      - up * (here - phi[i, j + 1]))
        south[i, j], north[i, j] = low, up

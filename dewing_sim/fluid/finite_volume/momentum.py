# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The momentum half of a step, line after line of control volumes.

BDF2 for J u_t + A u = -(metric) grad p, written for d = u^{n+1} - u^n with theta = 2 dt / 3:

    (1 + theta A) d = (u^n - u^{n-1}) / 3 - theta (A u^n + grad p^n - slope terms),

the coefficients c_nb of `transport` already contain theta.  The pressure gradient is
p_x = p_xi - (s / J) p_eta and p_y = p_eta / J; for the terms with s see `slopes`.  While a line is
in the first-level cache its coefficients are made, its right-hand side, and the forward half of
the sweep in xi (`adi`).
"""

from dewing_sim.fluid.finite_volume import adi, slopes, transport
from dewing_sim.machine.kernels import lean_part, stage


@lean_part
def eliminate_u(past, m, p_outlet, solver, fields):
    """Make the equations of u with the old pressure, and eliminate along xi; see `adi.finish`."""
    u, before, p, upwind, dxf = past.u, past.u_before, past.p, solver.upwind, solver.lattice.dxf
    lines, sloped, r, ratio, drag = (fields.lines, fields.sloped, fields.r, fields.ratio,
                                     fields.drag)
    nx, ny = p.shape
    first, stop = slopes.extent(m.slope_c)
    slopes.prepare_u(first, stop, u, before, p, solver, sloped)
    transport.u_run(0, 0, past, m, solver, lines)
    r[0, :], ratio[0, :] = 0.0, 0.0
    for i in solver.order[1:]:
        width_share, ahead = solver.theta / dxf[i], min(i + 1, nx)
        transport.over_jacobian(m.height_f[i], solver.g.dc, lines.over_j)
        if i < nx:
            for j in range(ny):
                lines.source[j] = width_share * (p[i - 1, j] - p[i, j])
        else:
            for j in range(ny):
                lines.source[j] = width_share * (p[i - 1, j] - p_outlet[j])
        if first <= i <= stop and 1 < i < nx - 1:
            slopes.add_to_u(i, m, solver, lines, sloped)
        _drag(i, u, m, solver, lines, drag)
        transport.u_rise(i, past, m, solver, lines)
        transport.u_run(i, i % 2, past, m, solver, lines)
        transport.across(i, ny, u, before, upwind.x[i], upwind.yc, solver.rates.theta_per_dy,
                         lines, fields.south, fields.north)
        adi.eliminate(i, ny, u, ahead, upwind.x[i], upwind.yc, width_share, lines, ratio, r)


@lean_part
def eliminate_v(past, m, wall_change, solver, fields):
    """Do the same for v; on the plate it changes by ``wall_change`` (columns,)."""
    v, before, p, upwind, dx = past.v, past.v_before, past.p, solver.upwind, solver.lattice.dx
    lines, sloped, r, ratio, drag = (fields.lines, fields.sloped, fields.r, fields.ratio,
                                     fields.drag)
    leading, trailing = solver.lattice.leading, solver.lattice.trailing
    nx, ny = p.shape
    middle, theta_per_dyf = ny // 2, solver.rates.theta_per_dyf
    first, stop = slopes.extent(m.slope_c)
    slopes.prepare_v(first, stop, v, before, solver, sloped)
    transport.v_run(1, 0, past, m, solver, lines)
    r[0, :], ratio[0, :], drag[:, :] = 0.0, 0.0, 0.0
    for i in solver.order[1:nx]:
        ahead = min(i + 1, nx - 1)
        transport.over_jacobian(m.height_c[i], solver.g.df, lines.over_j)
        for j in range(1, ny):
            lines.source[j] = theta_per_dyf[j] * lines.over_j[j] * (p[i, j - 1] - p[i, j])
        if first - 1 <= i <= stop and i < nx - 1:
            slopes.add_to_v(i, m, solver, lines, sloped)
        transport.v_rise(i, past, m, solver, lines)
        transport.v_run(i + 1, i % 2, past, m, solver, lines)
        transport.across(i, ny + 1, v, before, upwind.xc[i], upwind.y, theta_per_dyf, lines,
                         fields.south, fields.north)
        adi.eliminate(i, ny + 1, v, ahead, upwind.xc[i], upwind.y, solver.theta / dx[i], lines,
                      ratio, r)
        if leading <= i < trailing:
            fields.south[i, middle], fields.north[i, middle] = 0.0, 0.0
            ratio[i, middle], r[i, middle] = 0.0, wall_change[i - leading]


@stage
def _drag(i, u, m, solver, lines, drag):
    """Note the drag (2,) of the plate on both sides of the face i, and put it into the source.

    The volumes centred on the edges of the plate see half of it.
    """
    dy, dgc, share = solver.lattice.dy, solver.g.dc, solver.blocked[i]
    middle = len(dy) // 2
    shear = solver.nu * (1.0 + m.slope_f[i] * m.slope_f[i]) * share * solver.theta
    for side in range(2):
        j = middle - 1 + side
        drag[side, i] = shear / ((1.0 + m.height_f[i] * dgc[j]) * dy[j] * 0.5 * dy[j])
        lines.source[j] -= drag[side, i] * u[i, j]

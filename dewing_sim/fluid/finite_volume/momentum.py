# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The explicit side of a momentum step in delta form.

BDF2 for J u_t + A u = -(metric) grad p, written for d = u^{n+1} - u^n with theta = 2 dt / 3:

    (1 + theta A) d = (u^n - u^{n-1}) / 3 - theta (A u^n + grad p^n - cross diffusion),

the coefficients c_nb of `transport` already contain theta.  The pressure gradient is
p_x = p_xi - (s / J) p_eta and p_y = p_eta / J; the cross diffusion of the sheared grid,
-d_xi(s phi_eta) - d_eta(s phi_xi), is taken from the extrapolated field 2 phi^n - phi^{n-1}.
Terms with the slope s vanish away from the membrane and are added there only.
"""

import numpy as np

from dewing_sim.machine.kernels import stage


@stage
def u_explicit(u, before, p, p_outlet, stencil, wall, solver, r):
    """Fill r (nx + 1, ny) for u without the slope terms; the boundary rows are left alone."""
    west, east, south, north = stencil
    dxf, theta = solver.lattice.dxf, solver.theta
    rows, ny = u.shape
    middle = ny // 2
    for i in range(1, rows):
        last = i == rows - 1
        e = i if last else i + 1
        for j in range(1, ny - 1):
            here = u[i, j]
            r[i, j] = ((here - before[i, j]) / 3.0
                       - west[i, j] * (here - u[i - 1, j]) - east[i, j] * (here - u[e, j])
                       - south[i, j] * (here - u[i, j - 1]) - north[i, j] * (here - u[i, j + 1]))
        if last:
            for j in range(1, ny - 1):
                r[i, j] -= theta * (p_outlet[j] - p[i - 1, j]) / dxf[i]
        else:
            for j in range(1, ny - 1):
                r[i, j] -= theta * (p[i, j] - p[i - 1, j]) / dxf[i]
        for side in range(2):
            r[i, middle - 1 + side] -= wall[side, i] * u[i, middle - 1 + side]


@stage
def v_explicit(v, before, p, m, stencil, solver, r):
    """Fill r (nx, ny + 1) for v without the slope terms; the boundary rows are left alone."""
    west, east, south, north = stencil
    dyf, height_c, dgf, theta = solver.lattice.dyf, m.height_c, solver.g.df, solver.theta
    rows, nf = v.shape
    for i in range(1, rows):
        e = i if i == rows - 1 else i + 1
        for j in range(1, nf - 1):
            here = v[i, j]
            r[i, j] = ((here - before[i, j]) / 3.0
                       - west[i, j] * (here - v[i - 1, j]) - east[i, j] * (here - v[e, j])
                       - south[i, j] * (here - v[i, j - 1]) - north[i, j] * (here - v[i, j + 1])
                       - theta * (p[i, j] - p[i, j - 1])
                       / (dyf[j] * (1.0 + height_c[i] * dgf[j])))


@stage
def _p_eta(p, i, dyf, on_plate, out):
    """Fill dp/deta at the cell centres of column i, never differenced across the plate."""
    ny = len(out)
    middle = ny // 2
    for j in range(1, ny - 1):
        out[j] = (p[i, j + 1] - p[i, j - 1]) / (dyf[j] + dyf[j + 1])
    if on_plate:
        out[middle] = (p[i, middle + 1] - p[i, middle]) / dyf[middle + 1]
        out[middle - 1] = (p[i, middle - 1] - p[i, middle - 2]) / dyf[middle - 1]


@stage
def _u_eta(u, before, i, dy, dyf, on_plate, out):
    """Fill du/deta of the extrapolated u at its own points, with u = 0 on the plate."""
    ny = len(out)
    middle = ny // 2
    for j in range(1, ny - 1):
        out[j] = ((2.0 * u[i, j + 1] - before[i, j + 1] - 2.0 * u[i, j - 1] + before[i, j - 1])
                  / (dyf[j] + dyf[j + 1]))
    if on_plate:
        above, below = middle + 1, middle - 2
        out[middle] = ((2.0 * u[i, above] - before[i, above])
                       / (0.5 * dy[middle] + dyf[above]))
        out[middle - 1] = -((2.0 * u[i, below] - before[i, below])
                            / (0.5 * dy[middle] + dyf[middle - 1]))


@stage
def _u_xi(u, before, i, dx, out):
    """Fill du/dxi of the extrapolated u at its own points."""
    distance = dx[i - 1] + dx[i]
    for j in range(len(out)):
        out[j] = (2.0 * u[i + 1, j] - before[i + 1, j]
                  - 2.0 * u[i - 1, j] + before[i - 1, j]) / distance


@stage
def u_slope_terms(u, before, p, m, solver, r):
    """Add the slope terms of u: -p_eta part of p_x and the cross diffusion."""
    dx, dy, dxf, dyf, leading, trailing = solver.lattice
    height_f, slope_c, slope_f, blocked = m.height_f, m.slope_c, m.slope_f, solver.blocked
    gc, gf, dgc, nu, theta = solver.g.c, solver.g.f, solver.g.dc, solver.nu, solver.theta
    nx, ny = p.shape
    middle = ny // 2
    p_west, p_east, u_xi, cross = np.zeros(ny), np.zeros(ny), np.zeros(ny), np.zeros(ny)
    u_west, u_here, u_east = np.zeros(ny), np.zeros(ny), np.zeros(ny)
    through = np.zeros(ny + 1)
    for i in range(2, nx - 1):
        if slope_f[i] == 0.0 and slope_c[i] == 0.0 and slope_c[i - 1] == 0.0:
            continue
        _p_eta(p, i - 1, dyf, leading <= i - 1 < trailing, p_west)
        _p_eta(p, i, dyf, leading <= i < trailing, p_east)
        _u_eta(u, before, i - 1, dy, dyf, leading < i - 1 < trailing, u_west)
        _u_eta(u, before, i, dy, dyf, leading < i < trailing, u_here)
        _u_eta(u, before, i + 1, dy, dyf, leading < i + 1 < trailing, u_east)
        _u_xi(u, before, i, dx, u_xi)
        for j in range(1, ny):
            through[j] = 0.5 * slope_f[i] * gf[j] * (u_xi[j - 1] + u_xi[j])
        through[middle] *= 1.0 - blocked[i]
        for j in range(1, ny - 1):
            east = slope_c[i] * (u_here[j] + u_east[j])
            west = slope_c[i - 1] * (u_here[j] + u_west[j])
            cross[j] = (0.5 * gc[j] * (east - west) / dxf[i]
                        + (through[j + 1] - through[j]) / dy[j])
        for j in range(1, ny - 1):
            p_eta = 0.5 * (p_west[j] + p_east[j])
            r[i, j] += theta * (slope_f[i] * gc[j] * p_eta - nu * cross[j]) / (
                1.0 + height_f[i] * dgc[j])


@stage
def _v_eta(v, before, i, dy, out):
    """Fill dv/deta of the extrapolated v at its own points."""
    for j in range(1, len(out) - 1):
        out[j] = ((2.0 * v[i, j + 1] - before[i, j + 1] - 2.0 * v[i, j - 1] + before[i, j - 1])
                  / (dy[j - 1] + dy[j]))


@stage
def v_slope_terms(v, before, m, solver, r):
    """Add the cross diffusion of v."""
    dx, dy, dxf, dyf, leading, trailing = solver.lattice
    height_c, slope_c, slope_f = m.height_c, m.slope_c, m.slope_f
    gc, gf, dgf, nu, theta = solver.g.c, solver.g.f, solver.g.df, solver.nu, solver.theta
    nx, nf = v.shape
    middle = nf // 2
    v_west, v_here, v_east = np.zeros(nf), np.zeros(nf), np.zeros(nf)
    v_xi, through = np.zeros(nf), np.zeros(nf)
    for i in range(1, nx - 1):
        if slope_c[i] == 0.0 and slope_f[i] == 0.0 and slope_f[i + 1] == 0.0:
            continue
        _v_eta(v, before, i - 1, dy, v_west)
        _v_eta(v, before, i, dy, v_here)
        _v_eta(v, before, i + 1, dy, v_east)
        distance = dxf[i] + dxf[i + 1]
        for j in range(nf):
            v_xi[j] = (2.0 * v[i + 1, j] - before[i + 1, j]
                       - 2.0 * v[i - 1, j] + before[i - 1, j]) / distance
        for j in range(nf - 1):
            through[j] = 0.5 * slope_c[i] * gc[j] * (v_xi[j] + v_xi[j + 1])
        given = r[i, middle]
        for j in range(1, nf - 1):
            east = slope_f[i + 1] * (v_here[j] + v_east[j])
            west = slope_f[i] * (v_here[j] + v_west[j])
            cross = (0.5 * gf[j] * (east - west) / dx[i]
                     + (through[j] - through[j - 1]) / dyf[j])
            r[i, j] -= theta * nu * cross / (1.0 + height_c[i] * dgf[j])
        if leading <= i < trailing:
            r[i, middle] = given

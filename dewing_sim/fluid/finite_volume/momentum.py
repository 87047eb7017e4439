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

from dewing_sim.fluid.kernels import kernel


@kernel
def u_explicit(u, before, p, p_outlet, west, east, south, north, wall, dxf, theta, r):
    """Fill r (nx + 1, ny) for u without the slope terms; the boundary rows are left alone."""
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


@kernel
def v_explicit(v, before, p, west, east, south, north, dyf, height_c, dgf, theta, r):
    """Fill r (nx, ny + 1) for v without the slope terms; the boundary rows are left alone."""
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


@kernel
def _p_eta(p, i, j, dyf, on_plate, middle):
    """Return dp/deta at a cell centre, never differenced across the plate."""
    if on_plate and j == middle:
        return (p[i, j + 1] - p[i, j]) / dyf[j + 1]
    if on_plate and j == middle - 1:
        return (p[i, j] - p[i, j - 1]) / dyf[j]
    return (p[i, j + 1] - p[i, j - 1]) / (dyf[j] + dyf[j + 1])


@kernel
def _u_eta(u, before, i, j, dy, dyf, blocked, middle):
    """Return du/deta of the extrapolated u at its own point, with u = 0 on the plate."""
    below, above = j - 1, j + 1
    distance = dyf[j] + dyf[j + 1]
    lower = 2.0 * u[i, below] - before[i, below]
    upper = 2.0 * u[i, above] - before[i, above]
    if blocked[i] > 0.75 and j == middle:
        lower, distance = 0.0, 0.5 * dy[j] + dyf[j + 1]
    elif blocked[i] > 0.75 and j == middle - 1:
        upper, distance = 0.0, 0.5 * dy[j] + dyf[j]
    return (upper - lower) / distance


@kernel
def _u_xi(u, before, i, j, dx):
    return ((2.0 * u[i + 1, j] - before[i + 1, j] - 2.0 * u[i - 1, j] + before[i - 1, j])
            / (dx[i - 1] + dx[i]))


@kernel
def u_slope_terms(u, before, p, dx, dy, dxf, dyf, height_f, slope_c, slope_f, gc, gf, dgc,
                  blocked, leading, trailing, nu, theta, r):
    """Add the slope terms of u: -p_eta part of p_x and the cross diffusion."""
    nx, ny = p.shape
    middle = ny // 2
    for i in range(2, nx - 1):
        if slope_f[i] == 0.0 and slope_c[i] == 0.0 and slope_c[i - 1] == 0.0:
            continue
        west_on, east_on = leading <= i - 1 < trailing, leading <= i < trailing
        for j in range(1, ny - 1):
            jacobian = 1.0 + height_f[i] * dgc[j]
            p_eta = 0.5 * (_p_eta(p, i - 1, j, dyf, west_on, middle)
                           + _p_eta(p, i, j, dyf, east_on, middle))
            here = _u_eta(u, before, i, j, dy, dyf, blocked, middle)
            through_east = 0.5 * slope_c[i] * gc[j] * (
                here + _u_eta(u, before, i + 1, j, dy, dyf, blocked, middle))
            through_west = 0.5 * slope_c[i - 1] * gc[j] * (
                here + _u_eta(u, before, i - 1, j, dy, dyf, blocked, middle))
            free = 1.0 - blocked[i]
            open_south = free if j == middle else 1.0
            open_north = free if j == middle - 1 else 1.0
            u_xi = _u_xi(u, before, i, j, dx)
            through_north = 0.5 * open_north * slope_f[i] * gf[j + 1] * (
                u_xi + _u_xi(u, before, i, j + 1, dx))
            through_south = 0.5 * open_south * slope_f[i] * gf[j] * (
                u_xi + _u_xi(u, before, i, j - 1, dx))
            cross = ((through_east - through_west) / dxf[i]
                     + (through_north - through_south) / dy[j])
            r[i, j] += theta * (slope_f[i] * gc[j] * p_eta - nu * cross) / jacobian


@kernel
def _v_eta(v, before, i, j, dy):
    return ((2.0 * v[i, j + 1] - before[i, j + 1] - 2.0 * v[i, j - 1] + before[i, j - 1])
            / (dy[j - 1] + dy[j]))


@kernel
def _v_xi(v, before, i, j, dxf):
    return ((2.0 * v[i + 1, j] - before[i + 1, j] - 2.0 * v[i - 1, j] + before[i - 1, j])
            / (dxf[i] + dxf[i + 1]))


@kernel
def v_slope_terms(v, before, dx, dy, dxf, dyf, height_c, slope_c, slope_f, gc, gf, dgf,
                  leading, trailing, nu, theta, r):
    """Add the cross diffusion of v."""
    nx, nf = v.shape
    middle = nf // 2
    for i in range(1, nx - 1):
        if slope_c[i] == 0.0 and slope_f[i] == 0.0 and slope_f[i + 1] == 0.0:
            continue
        on_plate = leading <= i < trailing
        for j in range(1, nf - 1):
            if on_plate and j == middle:
                continue
            here = _v_eta(v, before, i, j, dy)
            through_east = 0.5 * slope_f[i + 1] * gf[j] * (
                here + _v_eta(v, before, i + 1, j, dy))
            through_west = 0.5 * slope_f[i] * gf[j] * (here + _v_eta(v, before, i - 1, j, dy))
            v_xi = _v_xi(v, before, i, j, dxf)
            through_north = 0.5 * slope_c[i] * gc[j] * (v_xi + _v_xi(v, before, i, j + 1, dxf))
            through_south = 0.5 * slope_c[i] * gc[j - 1] * (
                v_xi + _v_xi(v, before, i, j - 1, dxf))
            cross = ((through_east - through_west) / dx[i]
                     + (through_north - through_south) / dyf[j])
            r[i, j] -= theta * nu * cross / (1.0 + height_c[i] * dgf[j])

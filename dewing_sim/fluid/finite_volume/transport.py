# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Convection and diffusion of one velocity component as coefficients of its four neighbours.

For a control volume of size J dxi deta the operator is

    (A phi)_P = sum_nb c_nb (phi_P - phi_nb),
    c_nb = theta (D_nb - F_nb / 2 + beta |F_nb| / 2) / (J dxi deta),

with F the outward volume flux relative to the moving grid, D = nu (metric) area / distance and
beta the share of upwinding, zero near the membrane.  The convective form F (phi_nb - phi_P) / 2
has zero row sum: a uniform stream is kept exactly on any moving grid, without a geometric
conservation law.  Fluxes (Fx, W) are those of the projection less the motion of the grid.
"""

from dewing_sim.machine.kernels import stage


@stage
def _coefficient(flux, conductance, beta, scale):
    return scale * (conductance - 0.5 * flux + 0.5 * beta * abs(flux))


@stage
def u_coefficients(fx, w, m, solver, stencil, wall):
    """Fill the coefficients of u (nx + 1, ny); ``wall`` (2, nx + 1) is the drag of the plate.

    The volumes centred on its edges see half the wall shear and half the free passage.
    """
    dx, dy, dxf, dyf, _, _ = solver.lattice
    height_f, height_c, slope_f, gf = m.height_f, m.height_c, m.slope_f, solver.g.f
    dgf, dgc, nu, theta = solver.g.df, solver.g.dc, solver.nu, solver.theta
    beta_x, beta_y = solver.upwind.x, solver.upwind.yc
    west, east, south, north = stencil
    nx, ny = len(dx), len(dy)
    for i in range(1, nx + 1):
        last = i == nx
        e = nx - 1 if last else i               # cell to the east
        width = 0.5 * dx[i - 1] if last else dxf[i]
        for j in range(1, ny - 1):
            beta = max(beta_x[i], beta_y[j])
            scale = theta / ((1.0 + height_f[i] * dgc[j]) * width * dy[j])
            f_west = -0.5 * (fx[i - 1, j] + fx[i, j]) * dy[j]
            d_west = nu * (1.0 + height_c[i - 1] * dgc[j]) * dy[j] / dx[i - 1]
            f_south = -0.5 * (w[i - 1, j] * dx[i - 1] + w[e, j] * dx[e])
            f_north = 0.5 * (w[i - 1, j + 1] * dx[i - 1] + w[e, j + 1] * dx[e])
            if last:
                f_south *= 0.5
                f_north *= 0.5
            s_south, s_north = slope_f[i] * gf[j], slope_f[i] * gf[j + 1]
            d_south = (nu * (1.0 + s_south * s_south) / (1.0 + height_f[i] * dgf[j])
                       * width / dyf[j])
            d_north = (nu * (1.0 + s_north * s_north) / (1.0 + height_f[i] * dgf[j + 1])
                       * width / dyf[j + 1])
            west[i, j] = _coefficient(f_west, d_west, beta, scale)
            south[i, j] = _coefficient(f_south, d_south, beta, scale)
            north[i, j] = _coefficient(f_north, d_north, beta, scale)
        if last:
            east[i, :] = 0.0                    # outflow: zero gradient
        else:
            for j in range(1, ny - 1):
                beta = max(beta_x[i], beta_y[j])
                scale = theta / ((1.0 + height_f[i] * dgc[j]) * width * dy[j])
                f_east = 0.5 * (fx[i, j] + fx[i + 1, j]) * dy[j]
                d_east = nu * (1.0 + height_c[i] * dgc[j]) * dy[j] / dx[i]
                east[i, j] = _coefficient(f_east, d_east, beta, scale)
        _plate(i, m, solver, stencil, wall)


@stage
def _plate(i, m, solver, stencil, wall):
    """Write the drag of the plate on the face i, and close the passage through it."""
    dy, dgc, blocked = solver.lattice.dy, solver.g.dc, solver.blocked[i]
    middle = len(dy) // 2
    drag = solver.nu * (1.0 + m.slope_f[i] * m.slope_f[i]) * blocked * solver.theta
    for side in range(2):
        j = middle - 1 + side
        wall[side, i] = drag / ((1.0 + m.height_f[i] * dgc[j]) * dy[j] * 0.5 * dy[j])
    stencil.north[i, middle - 1] *= 1.0 - blocked
    stencil.south[i, middle] *= 1.0 - blocked


@stage
def v_coefficients(fx, w, m, solver, stencil):
    """Fill the coefficients of v (nx, ny + 1); faces on the plate get none (v is given there)."""
    dx, dy, dxf, dyf, leading, trailing = solver.lattice
    height_f, height_c, slope_c, gc = m.height_f, m.height_c, m.slope_c, solver.g.c
    dgf, dgc, nu, theta = solver.g.df, solver.g.dc, solver.nu, solver.theta
    beta_x, beta_y = solver.upwind.xc, solver.upwind.y
    west, east, south, north = stencil
    nx, ny = len(dx), len(dy)
    middle = ny // 2
    for i in range(1, nx):
        for j in range(1, ny):
            beta = max(beta_x[i], beta_y[j])
            scale = theta / ((1.0 + height_c[i] * dgf[j]) * dx[i] * dyf[j])
            f_west = -0.5 * (fx[i, j - 1] * dy[j - 1] + fx[i, j] * dy[j])
            d_west = nu * (1.0 + height_f[i] * dgf[j]) * dyf[j] / dxf[i]
            f_south = -0.5 * (w[i, j - 1] + w[i, j]) * dx[i]
            f_north = 0.5 * (w[i, j] + w[i, j + 1]) * dx[i]
            s_south, s_north = slope_c[i] * gc[j - 1], slope_c[i] * gc[j]
            d_south = (nu * (1.0 + s_south * s_south) / (1.0 + height_c[i] * dgc[j - 1])
                       * dx[i] / dy[j - 1])
            d_north = (nu * (1.0 + s_north * s_north) / (1.0 + height_c[i] * dgc[j])
                       * dx[i] / dy[j])
            west[i, j] = _coefficient(f_west, d_west, beta, scale)
            south[i, j] = _coefficient(f_south, d_south, beta, scale)
            north[i, j] = _coefficient(f_north, d_north, beta, scale)
        if i == nx - 1:
            east[i, :] = 0.0                    # outflow: zero gradient
        else:
            for j in range(1, ny):
                beta = max(beta_x[i], beta_y[j])
                scale = theta / ((1.0 + height_c[i] * dgf[j]) * dx[i] * dyf[j])
                f_east = 0.5 * (fx[i + 1, j - 1] * dy[j - 1] + fx[i + 1, j] * dy[j])
                d_east = nu * (1.0 + height_f[i + 1] * dgf[j]) * dyf[j] / dxf[i + 1]
                east[i, j] = _coefficient(f_east, d_east, beta, scale)
    for i in range(leading, trailing):
        west[i, middle] = east[i, middle] = south[i, middle] = north[i, middle] = 0.0

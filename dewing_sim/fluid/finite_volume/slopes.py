# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Terms of the momentum equation with the slope s = Y_x g of the grid lines.

They are -(s / J) p_eta of the pressure gradient and the cross diffusion of the sheared grid,
-d_xi(s phi_eta) - d_eta(s phi_xi), taken from the extrapolated field 2 phi^n - phi^{n-1}.  They
vanish where the membrane has no slope, and are made for the lines beside it only.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.machine.kernels import scratch, stage


class Sloped(NamedTuple):
    """Fields of the sloped lines (nx + 1, ny + 1), and two lines (ny + 1,)."""

    ahead: np.ndarray               # extrapolated phi
    phi_eta: np.ndarray
    p_eta: np.ndarray
    phi_xi: np.ndarray
    through: np.ndarray             # s phi_xi on the eta-faces of the volumes

    @classmethod
    def of(cls, nx: int, ny: int) -> 'Sloped':
        """Return fields for a grid of cells."""
        return cls(*scratch(3, nx + 1, ny + 1), *scratch(2, ny + 1))


@stage
def extent(slope_c):
    """Return the first column of cells with a slope and the one after the last."""
    first, stop = 0, len(slope_c)
    while first < stop and slope_c[first] == 0.0:
        first += 1
    while stop > first and slope_c[stop - 1] == 0.0:
        stop -= 1
    return first, stop


@stage
def extrapolate(i, phi, before, out):
    """Fill line i of 2 phi^n - phi^{n-1}."""
    for j in range(phi.shape[1]):
        out[i, j] = 2.0 * phi[i, j] - before[i, j]


@stage
def prepare_u(first, stop, u, before, p, solver, sloped):
    """Fill what the sloped lines of u need: u_eta with u = 0 on the plate, and p_eta."""
    lattice, per_double = solver.lattice, solver.rates.per_two_dyf
    dy, dyf, leading, trailing = lattice.dy, lattice.dyf, lattice.leading, lattice.trailing
    nx, ny = p.shape
    middle, ahead, u_eta = ny // 2, sloped.ahead, sloped.phi_eta
    wall_above, wall_below = 0.5 * dy[middle] + dyf[middle + 1], 0.5 * dy[middle] + dyf[middle - 1]
    for i in range(max(first, 2) - 1, min(stop, nx - 2) + 2):
        extrapolate(i, u, before, ahead)
        for j in range(1, ny - 1):
            u_eta[i, j] = (ahead[i, j + 1] - ahead[i, j - 1]) * per_double[j]
        if leading < i < trailing:
            u_eta[i, middle] = ahead[i, middle + 1] / wall_above
            u_eta[i, middle - 1] = -ahead[i, middle - 2] / wall_below
    for i in range(max(first, 2) - 1, min(stop, nx - 2) + 1):
        for j in range(1, ny - 1):
            sloped.p_eta[i, j] = (p[i, j + 1] - p[i, j - 1]) * per_double[j]
        if leading <= i < trailing:             # never differenced across the plate
            sloped.p_eta[i, middle] = (p[i, middle + 1] - p[i, middle]) / dyf[middle + 1]
            sloped.p_eta[i, middle - 1] = (p[i, middle - 1] - p[i, middle - 2]) / dyf[middle - 1]


@stage
def add_to_u(i, m, solver, lines, sloped):
    """Add the terms of the line i of u to its source."""
    dx, dxf, g, theta = solver.lattice.dx, solver.lattice.dxf, solver.g, solver.theta
    per_dy, nu, over_j, source = solver.rates.per_dy, solver.nu, lines.over_j, lines.source
    ahead, u_eta, p_eta, u_xi, through = sloped
    ny, slope = len(per_dy), m.slope_f[i]
    per_distance = 1.0 / (dx[i - 1] + dx[i])
    for j in range(ny):
        u_xi[j] = (ahead[i + 1, j] - ahead[i - 1, j]) * per_distance
    for j in range(1, ny):
        through[j] = 0.5 * slope * g.f[j] * (u_xi[j - 1] + u_xi[j])
    through[ny // 2] *= 1.0 - solver.blocked[i]
    behind, before = 0.5 * m.slope_c[i] / dxf[i], 0.5 * m.slope_c[i - 1] / dxf[i]
    for j in range(1, ny - 1):
        cross = (g.c[j] * (behind * (u_eta[i, j] + u_eta[i + 1, j])
                           - before * (u_eta[i, j] + u_eta[i - 1, j]))
                 + (through[j + 1] - through[j]) * per_dy[j])
        pressure = 0.5 * slope * g.c[j] * (p_eta[i - 1, j] + p_eta[i, j])
        source[j] += theta * over_j[j] * (pressure - nu * cross)


@stage
def prepare_v(first, stop, v, before, solver, sloped):
    """Fill v_eta for the sloped lines of v."""
    nx, nf = v.shape
    for i in range(max(first - 1, 1) - 1, min(stop, nx - 2) + 2):
        extrapolate(i, v, before, sloped.ahead)
        for j in range(1, nf - 1):
            sloped.phi_eta[i, j] = ((sloped.ahead[i, j + 1] - sloped.ahead[i, j - 1])
                                    * solver.rates.per_two_dy[j])


@stage
def add_to_v(i, m, solver, lines, sloped):
    """Add the terms of the column i of v to its source."""
    dx, dxf, g, theta = solver.lattice.dx, solver.lattice.dxf, solver.g, solver.theta
    per_dyf, nu, over_j, source = solver.rates.per_dyf, solver.nu, lines.over_j, lines.source
    ahead, v_eta, _, v_xi, through = sloped
    nf, slope = len(per_dyf), m.slope_c[i]
    per_distance = 1.0 / (dxf[i] + dxf[i + 1])
    for j in range(nf):
        v_xi[j] = (ahead[i + 1, j] - ahead[i - 1, j]) * per_distance
    for j in range(nf - 1):
        through[j] = 0.5 * slope * g.c[j] * (v_xi[j] + v_xi[j + 1])
    behind, before = 0.5 * m.slope_f[i + 1] / dx[i], 0.5 * m.slope_f[i] / dx[i]
    for j in range(1, nf - 1):
        cross = (g.f[j] * (behind * (v_eta[i, j] + v_eta[i + 1, j])
                           - before * (v_eta[i, j] + v_eta[i - 1, j]))
                 + (through[j] - through[j - 1]) * per_dyf[j])
        source[j] -= theta * nu * over_j[j] * cross

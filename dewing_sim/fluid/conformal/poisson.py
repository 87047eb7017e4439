# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From vorticity to stream function: Fourier in xi, tridiagonal in eta.

psi' is the stream function less that of the free stream.  With q = h^2 omega its modes obey

    psi_k'' - k^2 psi_k = -q_k,   psi_k given at the membrane and decaying as exp(-k eta) outside.

The operator is the same for every shape of the membrane.  Mode 0 carries the circulation: its
slope at infinity is Gamma / 2 pi, with Gamma the (clockwise) circulation of wing and wake; the
modes are sums over n nodes, so that ``outer`` = n Gamma / 2 pi in all that follows.  The modes of
a field are real rows (rows, 2 modes), first all real parts, then all imaginary parts.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.machine.kernels import stage


class Poisson(NamedTuple):
    """Factors of the tridiagonal systems, one a mode, and what is derived from them."""

    width: np.ndarray               # (rows,) of the cells
    conductance: np.ndarray         # (rows,) inverse of the distance to the next row
    pivot: np.ndarray               # (rows, 2 modes), row 0 unused
    ratio: np.ndarray               # (rows, 2 modes)
    decay: np.ndarray               # (rows, 2 modes) discrete exp(-k eta) times the width
    slope: np.ndarray               # (2 modes,) d psi / d eta at the membrane for unit psi there
    corner: np.ndarray              # (rows, 4) weights from rows to the faces in eta
    wall: np.ndarray                # (4,) weights of psi_0, slope_0, psi_1, psi_2 for face 0
    shift: np.ndarray               # (modes,) half a step in xi, complex
    beyond: np.ndarray              # (2 modes,) from the last row to the boundary
    last_gap: float                 # between them
    integral: np.ndarray            # (modes,) 1 / (i k), 0 for mode 0 and the sawtooth
    inwards: np.ndarray             # rows from the last but one to 1, see `kernels`
    outwards: np.ndarray            # rows from 1 to the last

    @classmethod
    def of(cls, grid: Grid) -> 'Poisson':
        """Factor the systems of ``grid``."""
        k, rows = grid.wavenumbers, len(grid.eta)
        beyond = np.exp(-k * grid.gap[-1])
        pivot, ratio = _factor(grid, k, beyond)
        decay = np.cumprod(np.concatenate((np.ones((1, len(k))), ratio[1:])), axis=0)
        slope = (decay[1] - 1.0) / grid.gap[0] - k**2 * grid.width[0]
        shift = np.exp(0.5j * k * grid.step)
        shift[-1] = 0.0             # the shifted sawtooth vanishes on the nodes
        corner, wall = _interpolation(grid)
        integral = np.zeros(len(k), dtype=complex)
        integral[1:-1] = 1.0 / (1j * k[1:-1])
        decay *= grid.width[:, None]
        pivot, ratio, decay, slope, beyond = (np.concatenate((real, real), axis=-1)
                                              for real in (pivot, ratio, decay, slope, beyond))
        return cls(
            width=grid.width, conductance=1.0 / grid.gap, pivot=pivot, ratio=ratio, decay=decay,
            slope=slope, corner=corner, wall=wall, shift=shift, beyond=beyond,
            last_gap=grid.gap[-1], integral=integral, inwards=np.arange(rows - 2, 0, -1),
            outwards=np.arange(1, rows))


def _factor(grid: Grid, k: np.ndarray, beyond: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eliminate from the outermost row inwards: psi_j = ratio_j psi_{j-1} + ..."""
    rows = len(grid.eta)
    conductance = 1.0 / grid.gap
    pivot, ratio = np.zeros((rows, len(k))), np.zeros((rows, len(k)))
    diagonal = conductance[-2] + k * beyond + grid.width[-1] * k**2
    for j in range(rows - 1, 0, -1):
        if j < rows - 1:
            diagonal = (conductance[j - 1] + conductance[j] * (1.0 - ratio[j + 1])
                        + grid.width[j] * k**2)
        pivot[j] = 1.0 / diagonal
        ratio[j] = conductance[j - 1] * pivot[j]
    return pivot, ratio


def _interpolation(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return cubic weights for the faces; face 0 uses the slope at the membrane."""
    rows = len(grid.eta)
    corner = np.zeros((rows, 4))
    for j in range(1, rows - 1):
        first = min(j - 1, rows - 4)
        nodes = grid.eta[first:first + 4]
        for m in range(4):
            others = np.delete(nodes, m)
            corner[j, m] = np.prod((grid.face[j] - others) / (nodes[m] - others))
    powers = np.arange(4)
    at = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0],
                   grid.eta[1]**powers, grid.eta[2]**powers])
    return corner, np.linalg.solve(at.T, grid.face[0]**powers)


@stage
def wall_slope(p, q_hat, psi_wall, outer):
    """Return d psi' / d eta (modes,) at the membrane without solving for psi."""
    rows, twice = p.decay.shape
    modes = twice // 2
    total = np.zeros(twice)
    for j in range(rows):
        for k in range(twice):
            total[k] += p.decay[j, k] * q_hat[j, k]
    slope = np.empty(modes, dtype=np.complex128)
    for k in range(modes):
        slope[k] = p.slope[k] * psi_wall[k] + complex(total[k], total[modes + k])
    slope[0] += outer
    return slope


@stage
def solve(p, q_hat, psi_wall, outer, psi):
    """Write the modes of psi' on the rows."""
    rows, twice = p.pivot.shape
    modes, last = twice // 2, rows - 1
    for k in range(twice):
        psi[last, k] = p.width[last] * q_hat[last, k] * p.pivot[last, k]
    psi[last, 0] += outer * p.pivot[last, 0]
    above = last
    for j in p.inwards:
        width, conductance = p.width[j], p.conductance[j]
        for k in range(twice):
            psi[j, k] = (width * q_hat[j, k] + conductance * psi[above, k]) * p.pivot[j, k]
        above = j
    for k in range(modes):
        psi[0, k], psi[0, modes + k] = psi_wall[k].real, psi_wall[k].imag
    below = 0
    for j in p.outwards:
        for k in range(twice):
            psi[j, k] += p.ratio[j, k] * psi[below, k]
        below = j


@stage
def to_corners(p, psi, slope_wall, outer, out):
    """Write the modes of psi' at the cell corners, (face j, half a step beyond node i)."""
    rows, twice = psi.shape
    modes = twice // 2
    for k in range(modes):
        c = p.wall[1]
        out[0, k], out[0, modes + k] = c * slope_wall[k].real, c * slope_wall[k].imag
    for k in range(twice):
        out[0, k] += p.wall[0] * psi[0, k] + p.wall[2] * psi[1, k] + p.wall[3] * psi[2, k]
        out[rows - 1, k] = p.beyond[k] * psi[rows - 1, k]
    for j in range(1, rows - 1):
        a = min(j - 1, rows - 4)
        c0, c1, c2, c3 = p.corner[j, 0], p.corner[j, 1], p.corner[j, 2], p.corner[j, 3]
        for k in range(twice):
            out[j, k] = (c0 * psi[a, k] + c1 * psi[a + 1, k]
                         + c2 * psi[a + 2, k] + c3 * psi[a + 3, k])
    for j in range(rows):
        for k in range(modes):
            x, y, c, s = out[j, k], out[j, modes + k], p.shift[k].real, p.shift[k].imag
            out[j, k], out[j, modes + k] = c * x - s * y, s * x + c * y
    out[rows - 1, 0] += outer * p.last_gap

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From vorticity to stream function: Fourier in xi, tridiagonal in eta.

psi' is the stream function less that of the free stream.  With q = h^2 omega its modes obey

    psi_k'' - k^2 psi_k = -q_k,   psi_k given at the membrane and decaying as exp(-k eta) outside.

The operator is the same for every shape of the membrane.  Mode 0 carries the circulation: its
slope at infinity is Gamma / 2 pi, with Gamma the (clockwise) circulation of wing and wake.
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.conformal.fourier import Line
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.kernels import kernel


@dataclass(frozen=True)
class Poisson:
    """Factors of the tridiagonal systems, one a mode, and what is derived from them."""

    grid: Grid
    line: Line
    pivot: np.ndarray               # (rows, modes), row 0 unused
    ratio: np.ndarray               # (rows, modes)
    decay: np.ndarray               # (rows, modes) discrete exp(-k eta): 1 at the membrane
    slope: np.ndarray               # (modes,) d psi / d eta at the membrane for unit psi there
    corner: np.ndarray              # (rows, 4) weights from rows to the faces in eta
    wall: np.ndarray                # (4,) weights of psi_0, slope_0, psi_1, psi_2 for face 0
    shift: np.ndarray               # (modes,) half a step in xi
    beyond: np.ndarray              # (modes,) from the last row to the boundary
    integral: np.ndarray            # (modes,) 1 / (i k), 0 for mode 0 and the sawtooth

    @classmethod
    def of(cls, grid: Grid) -> 'Poisson':
        """Factor the systems of ``grid``."""
        k = grid.wavenumbers
        beyond = np.exp(-k * (grid.face[-1] - grid.eta[-1]))
        pivot, ratio = _factor(grid, k, beyond)
        decay = np.cumprod(np.concatenate((np.ones((1, len(k))), ratio[1:])), axis=0)
        slope = (decay[1] - 1.0) / grid.gap[0] - k**2 * grid.width[0]
        shift = np.exp(0.5j * k * grid.step)
        shift[-1] = 0.0             # the shifted sawtooth vanishes on the nodes
        corner, wall = _interpolation(grid)
        integral = np.zeros(len(k), dtype=complex)
        integral[1:-1] = 1.0 / (1j * k[1:-1])
        return cls(grid, Line.of(len(grid.xi)), pivot, ratio, decay, slope, corner, wall, shift,
                   beyond, integral)

    def wall_value(self, v_wall: np.ndarray) -> np.ndarray:
        """Return the modes of psi' at the membrane for the flux V (n,) through it."""
        return self.line.modes(v_wall) * self.integral

    def wall_slope(self, q_hat: np.ndarray, psi_wall: np.ndarray, circulation: float,
                   ) -> np.ndarray:
        """Return d psi' / d eta (modes,) at the membrane without solving for psi."""
        outer = len(self.grid.xi) * circulation / (2.0 * np.pi)
        return _wall_slope(self.slope, psi_wall, outer, self.decay, self.grid.width, q_hat)

    def solve(self, q_hat: np.ndarray, psi_wall: np.ndarray, circulation: float) -> np.ndarray:
        """Return the modes of psi' on the rows."""
        outer = len(self.grid.xi) * circulation / (2.0 * np.pi)
        return _solve(self.pivot, self.ratio, self.grid.width, 1.0 / self.grid.gap, q_hat,
                      psi_wall, outer)

    def corners(self, psi_hat: np.ndarray, slope_wall: np.ndarray, circulation: float,
                ) -> np.ndarray:
        """Return the modes of psi' at the cell corners, (face j, half a step beyond node i)."""
        outer = (len(self.grid.xi) * circulation / (2.0 * np.pi)
                 * (self.grid.face[-1] - self.grid.eta[-1]))
        return _corners(psi_hat, slope_wall, self.corner, self.wall, self.shift, self.beyond,
                        outer)


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


@kernel
def _wall_slope(slope, psi_wall, outer, decay, width, q_hat):
    rows, modes = decay.shape
    total = slope * psi_wall
    total[0] += outer
    for j in range(rows):
        for k in range(modes):
            total[k] += (decay[j, k] * width[j]) * q_hat[j, k]
    return total


@kernel
def _solve(pivot, ratio, width, conductance, q_hat, psi_wall, outer):
    rows, modes = pivot.shape
    psi = np.empty((rows, modes), dtype=np.complex128)
    last = rows - 1
    for k in range(modes):
        psi[last, k] = width[last] * q_hat[last, k] * pivot[last, k]
    psi[last, 0] += outer * pivot[last, 0]
    for j in range(last - 1, 0, -1):
        for k in range(modes):
            psi[j, k] = (width[j] * q_hat[j, k] + conductance[j] * psi[j + 1, k]) * pivot[j, k]
    for k in range(modes):
        psi[0, k] = psi_wall[k]
    for j in range(1, rows):
        for k in range(modes):
            psi[j, k] += ratio[j, k] * psi[j - 1, k]
    return psi


@kernel
def _corners(psi, slope_wall, corner, wall, shift, beyond, outer):
    rows, modes = psi.shape
    out = np.empty((rows, modes), dtype=np.complex128)
    for k in range(modes):
        out[0, k] = shift[k] * (wall[0] * psi[0, k] + wall[1] * slope_wall[k]
                                + wall[2] * psi[1, k] + wall[3] * psi[2, k])
    for j in range(1, rows - 1):
        a = min(j - 1, rows - 4)
        for k in range(modes):
            out[j, k] = shift[k] * (corner[j, 0] * psi[a, k] + corner[j, 1] * psi[a + 1, k]
                                    + corner[j, 2] * psi[a + 2, k] + corner[j, 3] * psi[a + 3, k])
    for k in range(modes):
        out[rows - 1, k] = shift[k] * beyond[k] * psi[rows - 1, k]
    out[rows - 1, 0] += outer
    return out

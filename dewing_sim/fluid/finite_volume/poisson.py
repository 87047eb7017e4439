# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Direct solution of the flat pressure equation around a plate, and the exact added mass.

The five-point Laplacian on the tensor grid is -(Kx My + Mx Ky).  Generalised eigenvectors Q of
(Ky, My), Q' My Q = 1, leave one tridiagonal system in x per mode, factored once.  The grid is
symmetric about the plate, so even and odd modes part and each transform has half the size.  The
plate cuts the passage between the cells below and above it, which only odd modes feel: with J the
pressure jump (above minus below) over the plate and W = dx / dyf,

    (1 - C W) J = J0,    C = 2 sum_k q_k(0)^2 [(Kx + lambda_k Mx)^-1]_plate,plate,

the capacitance matrix.  A wall that moves up with w leaves J0 = C dx w / theta, hence the discrete
added-mass matrix M_A = (1 - C W)^-1 C diag(dx).
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from dewing_sim.fluid.finite_volume.grid import Grid
from dewing_sim.machine.kernels import kernel


@dataclass(frozen=True)
class Factors:
    """Batched symmetric tridiagonal factors, one system a mode: shapes (nx, modes)."""

    pivot: np.ndarray
    ratio: np.ndarray


@dataclass(frozen=True)
class Poisson:
    """The factored pressure equation of one grid."""

    even: np.ndarray                # Q of the even modes (ny/2, ny/2), rows from the plate out
    odd: np.ndarray
    even_factors: Factors
    odd_factors: Factors
    plate: slice
    passage: np.ndarray             # W on the plate
    cut: np.ndarray                 # (1 - C W)^-1
    added_mass: np.ndarray          # M_A, pressure jump per wall acceleration

    @classmethod
    def of(cls, grid: Grid) -> 'Poisson':
        """Factor the pressure equation of ``grid``."""
        stiffness, mass = _chordwise(grid)
        (even_values, even), (odd_values, odd) = _normal_modes(grid)
        even_factors = _factor(stiffness, mass, even_values)
        odd_factors = _factor(stiffness, mass, odd_values)
        capacitance = _capacitance(odd, odd_factors, grid.plate)
        dx = grid.dx[grid.plate]
        passage = dx / grid.dyf[grid.middle]
        cut = np.linalg.inv(np.eye(len(dx)) - capacitance * passage)
        return cls(even, odd, even_factors, odd_factors, grid.plate, passage, cut,
                   cut @ (capacitance * dx))

    def forward(self, r: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return modal even and odd solutions and the pressure jump without wall motion.

        ``r`` (nx, ny) is the divergence of the fluxes integrated over each cell, over theta; the
        jump (plate columns,) is above minus below.
        """
        even, odd = _fold(r)
        even_hat = even @ self.even
        odd_hat = odd @ self.odd
        _solve(self.even_factors.pivot, self.even_factors.ratio, even_hat)
        _solve(self.odd_factors.pivot, self.odd_factors.ratio, odd_hat)
        return even_hat, odd_hat, self.cut @ (2.0 * (odd_hat[self.plate] @ self.odd[0]))

    def backward(self, even_hat: np.ndarray, odd_hat: np.ndarray, jump: np.ndarray,
                 wall_flux: np.ndarray) -> np.ndarray:
        """Return phi (nx, ny) given the jump and the added wall flux dx w / theta (plate,).

        Both act as a pair of opposite sources in the cells beside the plate.
        """
        source = np.zeros((len(odd_hat), len(self.odd)))
        source[self.plate] = np.outer(self.passage * jump + wall_flux, self.odd[0])
        _solve(self.odd_factors.pivot, self.odd_factors.ratio, source)
        return _unfold(even_hat @ self.even.T, (odd_hat + source) @ self.odd.T)


def _chordwise(grid: Grid) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Return Kx as (diagonal, off-diagonal) and the diagonal of Mx; p = 0 on the outlet face."""
    conductance = 1.0 / grid.dxf[1:]
    diagonal = conductance.copy()
    diagonal[1:] += conductance[:-1]
    return (diagonal, -conductance[:-1]), grid.dx


def _normal_modes(grid: Grid):
    """Return eigenvalues and vectors of the upper half for even and for odd modes."""
    dy = grid.dy[grid.middle:]
    conductance = 1.0 / grid.dyf[grid.middle + 1:-1]
    diagonal = np.zeros(len(dy))
    diagonal[:-1] += conductance
    diagonal[1:] += conductance
    even = np.diag(diagonal) - np.diag(conductance, 1) - np.diag(conductance, -1)
    odd = even.copy()
    odd[0, 0] += 2.0 / grid.dyf[grid.middle]
    modes = []
    for matrix in (even, odd):
        values, vectors = eigh(matrix, np.diag(dy))
        modes.append((np.maximum(values, 0.0), np.ascontiguousarray(vectors)))
    return modes


def _factor(stiffness, mass: np.ndarray, eigenvalues: np.ndarray) -> Factors:
    diagonal, off = stiffness
    pivot = np.empty((len(mass), len(eigenvalues)))
    ratio = np.zeros_like(pivot)
    matrix = diagonal[:, None] + mass[:, None] * eigenvalues
    pivot[0] = 1.0 / matrix[0]
    for i in range(1, len(mass)):
        ratio[i - 1] = -off[i - 1] * pivot[i - 1]
        pivot[i] = 1.0 / (matrix[i] + off[i - 1] * ratio[i - 1])
    return Factors(pivot, ratio)


def _capacitance(odd: np.ndarray, factors: Factors, plate: slice) -> np.ndarray:
    """Return C: the jump from unit opposite sources beside the plate in the uncut domain."""
    columns = range(plate.start, plate.stop)
    capacitance = np.empty((len(columns), len(columns)))
    for number, column in enumerate(columns):
        response = np.zeros_like(factors.pivot)
        response[column] = odd[0]
        _solve(factors.pivot, factors.ratio, response)
        capacitance[:, number] = 2.0 * (response[plate] @ odd[0])
    return capacitance


@kernel
def _solve(pivot, ratio, d):
    """Solve all modes in place: d (nx, modes); the inner loops run over modes."""
    nx, modes = d.shape
    for i in range(1, nx):
        for k in range(modes):
            d[i, k] += ratio[i - 1, k] * d[i - 1, k]
    for k in range(modes):
        d[nx - 1, k] *= pivot[nx - 1, k]
    for i in range(nx - 2, -1, -1):
        for k in range(modes):
            d[i, k] = d[i, k] * pivot[i, k] + ratio[i, k] * d[i + 1, k]


@kernel
def _fold(r):
    """Return the even and odd parts (nx, ny/2) of -r, rows from the plate outwards."""
    nx, ny = r.shape
    half = ny // 2
    even = np.empty((nx, half))
    odd = np.empty((nx, half))
    for i in range(nx):
        for k in range(half):
            above, below = r[i, half + k], r[i, half - 1 - k]
            even[i, k] = -0.5 * (above + below)
            odd[i, k] = -0.5 * (above - below)
    return even, odd


@kernel
def _unfold(even, odd):
    nx, half = even.shape
    phi = np.empty((nx, 2 * half))
    for i in range(nx):
        for k in range(half):
            phi[i, half + k] = even[i, k] + odd[i, k]
            phi[i, half - 1 - k] = even[i, k] - odd[i, k]
    return phi

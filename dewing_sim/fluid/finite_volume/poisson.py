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

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

from dewing_sim.fluid.finite_volume.grid import Grid
from dewing_sim.fluid.finite_volume.projection import outflow
from dewing_sim.machine.kernels import kernel, scratch, stage


class Modes(NamedTuple):
    """Even or odd modes, and their symmetric tridiagonal factors (nx, modes), one system each."""

    vectors: np.ndarray             # Q (ny/2, modes), rows from the plate out
    transposed: np.ndarray
    pivot: np.ndarray
    ratio: np.ndarray


class Poisson(NamedTuple):
    """The factored pressure equation of one grid."""

    even: Modes
    odd: Modes
    leading: int                    # columns leading <= i < trailing touch the plate
    trailing: int
    passage: np.ndarray             # W on the plate
    cut: np.ndarray                 # (1 - C W)^-1
    added_mass: np.ndarray          # M_A, pressure jump per wall acceleration
    halves: np.ndarray              # (2, nx, ny/2) scratch

    @classmethod
    def of(cls, grid: Grid) -> 'Poisson':
        """Factor the pressure equation of ``grid``."""
        stiffness, mass = _chordwise(grid)
        even, odd = (Modes(vectors, np.ascontiguousarray(vectors.T),
                           *_factor(stiffness, mass, values))
                     for values, vectors in _normal_modes(grid))
        capacitance = _capacitance(odd, grid.plate)
        dx = grid.dx[grid.plate]
        passage = dx / grid.dyf[grid.middle]
        cut = np.linalg.inv(np.eye(len(dx)) - capacitance * passage)
        return cls(even, odd, grid.leading, grid.trailing, passage, cut,
                   cut @ (capacitance * dx), *scratch(1, 2, len(mass), grid.middle))


@kernel
def forward(fx, fy, dx, dy, theta, poisson):
    """Return modal even and odd solutions and the pressure jump without wall motion.

    The right-hand side is the divergence of the fluxes over theta; the jump (plate columns,) is
    above minus below.
    """
    even, odd = poisson.even, poisson.odd
    _fold(fx, fy, dx, dy, -0.5 / theta, poisson.halves)
    even_hat = np.dot(poisson.halves[0], even.vectors)
    odd_hat = np.dot(poisson.halves[1], odd.vectors)
    _solve(even.pivot, even.ratio, even_hat)
    _solve(odd.pivot, odd.ratio, odd_hat)
    uncut = 2.0 * np.dot(odd_hat[poisson.leading:poisson.trailing], odd.vectors[0])
    return even_hat, odd_hat, np.dot(poisson.cut, uncut)


@kernel
def backward(even_hat, odd_hat, jump, wall_flux, poisson):
    """Return even and odd parts (2, nx, ny/2) of phi given the jump and the added wall flux.

    That is dx w / theta (plate,). Both act as a pair of opposite sources in the cells beside the
    plate. The result lasts until the next call.
    """
    even, odd, halves = poisson.even, poisson.odd, poisson.halves
    source, total = halves[0], halves[1]
    source[:, :] = 0.0
    for n in range(len(jump)):
        strength = poisson.passage[n] * jump[n] + wall_flux[n]
        for k in range(source.shape[1]):
            source[poisson.leading + n, k] = strength * odd.vectors[0, k]
    _solve(odd.pivot, odd.ratio, source)
    for i in range(source.shape[0]):
        for k in range(source.shape[1]):
            source[i, k] += odd_hat[i, k]
    np.dot(source, odd.transposed, total)
    np.dot(even_hat, even.transposed, source)
    return halves


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


def _factor(stiffness, mass: np.ndarray, eigenvalues: np.ndarray,
            ) -> tuple[np.ndarray, np.ndarray]:
    """Return pivots and ratios (nx, modes)."""
    diagonal, off = stiffness
    pivot = np.empty((len(mass), len(eigenvalues)))
    ratio = np.zeros_like(pivot)
    matrix = diagonal[:, None] + mass[:, None] * eigenvalues
    pivot[0] = 1.0 / matrix[0]
    for i in range(1, len(mass)):
        ratio[i - 1] = -off[i - 1] * pivot[i - 1]
        pivot[i] = 1.0 / (matrix[i] + off[i - 1] * ratio[i - 1])
    return pivot, ratio


def _capacitance(odd: Modes, plate: slice) -> np.ndarray:
    """Return C: the jump from unit opposite sources beside the plate in the uncut domain."""
    columns = range(plate.start, plate.stop)
    capacitance = np.empty((len(columns), len(columns)))
    for number, column in enumerate(columns):
        response = np.zeros_like(odd.pivot)
        response[column] = odd.vectors[0]
        _solve(odd.pivot, odd.ratio, response)
        capacitance[:, number] = 2.0 * (response[plate] @ odd.vectors[0])
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


@stage
def _fold(fx, fy, dx, dy, share, halves):
    """Fill the even and the odd part of ``share`` times the outflow, rows from the plate out."""
    half = len(dy) // 2
    for i in range(len(dx)):
        for k in range(half):
            above = outflow(fx, fy, dx, dy, i, half + k)
            below = outflow(fx, fy, dx, dy, i, half - 1 - k)
            halves[0, i, k] = share * (above + below)
            halves[1, i, k] = share * (above - below)

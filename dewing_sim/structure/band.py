# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Symmetric banded matrices plus a matrix of low rank: the linear algebra of a time step.

The stiffness of a strip couples neighbours only, while the flow's added mass couples every node
to the few columns of the flow. Sherman, Morrison and Woodbury's formula joins the two. Sums are
written out, so that no BLAS or thread changes a bit of the result.
"""

from dataclasses import dataclass

import numba
import numpy as np


@numba.njit(cache=True)
def full(band):
    """Return the full matrix of a band (2 w + 1, m), in the layout of `solve_banded`."""
    width, m = band.shape[0] // 2, band.shape[1]
    matrix = np.zeros((m, m))
    for column in range(m):
        for row in range(max(0, column - width), min(m, column + width + 1)):
            matrix[row, column] = band[width + row - column, column]
    return matrix


@numba.njit(cache=True)
def factorise(band):
    """Return L below and D on the diagonal of L D L^T in rows (m, w + 1) by columns of L."""
    width, m = band.shape[0] // 2, band.shape[1]
    factors = np.ascontiguousarray(band[width:].T)
    for column in range(m):
        reach = min(width, m - 1 - column)
        pivot = factors[column, 0]
        for i in range(1, reach + 1):
            share = factors[column, i] / pivot
            for k in range(i, reach + 1):
                factors[column + i, k - i] -= share * factors[column, k]
        for i in range(1, reach + 1):
            factors[column, i] /= pivot
    return factors


@numba.njit(cache=True)
def substitute(factors, right):
    """Return the solution for every row of ``right`` (k, m)."""
    m, width = factors.shape[0], factors.shape[1] - 1
    solution = right.copy()
    for row in range(right.shape[0]):
        x = solution[row]
        for column in range(m):
            for i in range(1, min(width, m - 1 - column) + 1):
                x[column + i] -= factors[column, i] * x[column]
        for column in range(m - 1, -1, -1):
            value = x[column] / factors[column, 0]
            for i in range(1, min(width, m - 1 - column) + 1):
                value -= factors[column, i] * x[column + i]
            x[column] = value
    return solution


@numba.njit(cache=True)
def _correct(solution, basis, update):
    """Return solution - update^T basis solution, all of the low rank's rows (k, m)."""
    result = solution.copy()
    for k in range(basis.shape[0]):
        share = 0.0
        for i in range(solution.size):
            share += basis[k, i] * solution[i]
        for i in range(solution.size):
            result[i] -= share * update[k, i]
    return result


@dataclass(frozen=True, eq=False)
class LowRank:
    """The matrix basis^T weight basis with ``basis`` (k, m), ``weight`` (k, k)."""

    basis: np.ndarray
    weight: np.ndarray

    @classmethod
    def zero(cls, m: int) -> 'LowRank':
        """Return the zero matrix of size m."""
        return cls(np.zeros((0, m)), np.zeros((0, 0)))

    def full(self) -> np.ndarray:
        """Return the matrix (m, m)."""
        return self.basis.T @ self.weight @ self.basis


@dataclass(frozen=True, eq=False)
class Inverse:
    """The inverse of a symmetric band plus a multiple of a `LowRank`."""

    factors: np.ndarray
    basis: np.ndarray
    update: np.ndarray          # (k, m)

    @classmethod
    def of(cls, band: np.ndarray, low_rank: LowRank, factor: float) -> 'Inverse':
        """Return the inverse of ``band`` (2 w + 1, m) + ``factor`` * ``low_rank``."""
        factors = factorise(band)
        basis = np.ascontiguousarray(low_rank.basis)
        solved = substitute(factors, basis)                 # rows are band^-1 basis^T
        core = np.eye(len(basis)) + factor * (low_rank.weight @ (basis @ solved.T))
        with np.errstate(all='ignore'):
            update = np.linalg.solve(core, factor * (low_rank.weight @ solved))
        return cls(factors, basis, np.ascontiguousarray(update))

    def __call__(self, vector: np.ndarray) -> np.ndarray:
        """Return the product with ``vector`` (m,)."""
        solution = substitute(self.factors, vector.reshape(1, -1))[0]
        return _correct(solution, self.basis, self.update) if len(self.basis) else solution

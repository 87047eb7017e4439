# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Symmetric banded matrices plus a matrix of low rank: the linear algebra of a time step.

The stiffness of a strip couples neighbours only, while the flow's added mass couples every node
to the few columns of the flow. Sherman, Morrison and Woodbury's formula joins the two. Sums are
written out, so that no BLAS or thread changes a bit of the result.
"""

from dataclasses import dataclass, replace

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
    """Return the solutions (m, k) for the columns of ``right`` (m, k)."""
    m, width = factors.shape[0], factors.shape[1] - 1
    solution = right.copy()
    for column in range(m):
        for i in range(1, min(width, m - 1 - column) + 1):
            factor = factors[column, i]
            for k in range(right.shape[1]):
                solution[column + i, k] -= factor * solution[column, k]
    for column in range(m - 1, -1, -1):
        pivot = factors[column, 0]
        for k in range(right.shape[1]):
            solution[column, k] /= pivot
        for i in range(1, min(width, m - 1 - column) + 1):
            factor = factors[column, i]
            for k in range(right.shape[1]):
                solution[column, k] -= factor * solution[column + i, k]
    return solution


@numba.njit(cache=True)
def substitute_one(factors, right):
    """Return the solution (m,) for ``right`` (m,)."""
    m, width = factors.shape[0], factors.shape[1] - 1
    solution = right.copy()
    for column in range(m):
        value = solution[column]
        for i in range(1, min(width, m - 1 - column) + 1):
            solution[column + i] -= factors[column, i] * value
    for column in range(m - 1, -1, -1):
        value = solution[column] / factors[column, 0]
        for i in range(1, min(width, m - 1 - column) + 1):
            value -= factors[column, i] * solution[column + i]
        solution[column] = value
    return solution


@numba.njit(cache=True)
def _solve(factors, basis, answer, vector):
    """Return x - answer^T basis^T x, with the solution x (m,) of the band alone."""
    solution = substitute_one(factors, vector)
    share = np.zeros(answer.shape[0])
    for i in range(solution.size):
        for k in range(share.size):
            share[k] += basis[i, k] * solution[i]
    for k in range(share.size):
        for i in range(solution.size):
            solution[i] -= answer[k, i] * share[k]
    return solution


@dataclass(frozen=True, eq=False)
class LowRank:
    """The matrix basis weight basis^T with ``basis`` (m, k), ``weight`` (k, k)."""

    basis: np.ndarray
    weight: np.ndarray

    @classmethod
    def zero(cls, m: int) -> 'LowRank':
        """Return the zero matrix of size m."""
        return cls(np.zeros((m, 0)), np.zeros((0, 0)))


@dataclass(frozen=True, eq=False)
class Inverse:
    """The inverse of a symmetric band plus a multiple of a `LowRank`."""

    factors: np.ndarray
    basis: np.ndarray           # (m, k)
    answer: np.ndarray          # (k, m), of the low rank to what basis^T sees

    @classmethod
    def of(cls, band: np.ndarray, low_rank: LowRank, factor: float) -> 'Inverse':
        """Return the inverse of ``band`` (2 w + 1, m) + ``factor`` * ``low_rank``."""
        factors = factorise(band)
        basis, weight = low_rank.basis, factor * low_rank.weight
        solved = substitute(factors, basis)
        core = np.eye(len(weight)) + weight @ (basis.T @ solved)
        answer = solved @ np.linalg.solve(core, weight)
        return cls(factors, basis, np.ascontiguousarray(answer.T))

    def about(self, band: np.ndarray) -> 'Inverse':
        """Return the inverse for another ``band`` with the correction for the low rank as here.

        It is inexact to the extent that the bands differ: good enough for iterations.
        """
        return replace(self, factors=factorise(band))

    def __call__(self, vector: np.ndarray) -> np.ndarray:
        """Return the product with ``vector`` (m,)."""
        return _solve(self.factors, self.basis, self.answer, vector)

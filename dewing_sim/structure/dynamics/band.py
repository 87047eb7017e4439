# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Symmetric banded matrices plus a matrix of low rank: the linear algebra of a time step.

The stiffness of a strip couples neighbours only, while the flow's added mass couples every node
to the few columns of the flow. Sherman, Morrison and Woodbury's formula joins the two. Sums are
written out, so that no BLAS or thread changes a bit of the result.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.machine.kernels import checked_kernel, kernel


@checked_kernel
def full(band):
    """Return the full matrix of a band (2 w + 1, m), in the layout of `solve_banded`."""
    width, m = band.shape[0] // 2, band.shape[1]
    matrix = np.zeros((m, m))
    for column in range(m):
        for row in range(max(0, column - width), min(m, column + width + 1)):
            matrix[row, column] = band[width + row - column, column]
    return matrix


@kernel
def factorise(band):
    """Return L D L^T in rows (m, w + 1) by columns of L: 1 / D, then L below the diagonal."""
    width, m = band.shape[0] // 2, band.shape[1]
    factors = np.empty((m, width + 1))
    for column in range(m):
        for i in range(width + 1):
            factors[column, i] = band[width + i, column]
    for column in range(m):
        reach = min(width, m - 1 - column)
        factors[column, 0] = 1.0 / factors[column, 0]
        for i in range(1, reach + 1):
            share = factors[column, i] * factors[column, 0]
            for k in range(i, reach + 1):
                factors[column + i, k - i] -= share * factors[column, k]
        for i in range(1, reach + 1):
            factors[column, i] *= factors[column, 0]
    return factors


@checked_kernel
def substitute(factors, rows):
    """Replace each right-hand side in ``rows`` (k, m) by its solution."""
    m, width = factors.shape[0], factors.shape[1] - 1
    for k in range(rows.shape[0]):
        value = rows[k, 0]          # the latest result does not go through memory: that is slow
        for column in range(m - 1):
            for i in range(2, min(width, m - 1 - column) + 1):
                rows[k, column + i] -= factors[column, i] * value
            value = rows[k, column + 1] - factors[column, 1] * value
            rows[k, column + 1] = value
        value = 0.0
        for column in range(m - 1, -1, -1):
            right = rows[k, column] * factors[column, 0]
            for i in range(min(width, m - 1 - column), 1, -1):
                right -= factors[column, i] * rows[k, column + i]
            value = right - factors[column, 1] * value
            rows[k, column] = value


class Parts(NamedTuple):
    """What the compiled `solve` takes of an `Inverse`."""

    factors: np.ndarray         # of the band, see `factorise`
    row: np.ndarray             # of the entries of the basis (m, k) that are not zero
    column: np.ndarray
    value: np.ndarray
    answer: np.ndarray          # (k, m), of the low rank to what basis^T sees


@checked_kernel
def solve(inverse, right):
    """Replace ``right`` (1, m) by x - answer^T basis^T x, with x the solution for the band alone.

    Return the largest entry, NaN if one is. ``inverse`` are the `Parts` of an `Inverse`.
    """
    substitute(inverse.factors, right)
    share = np.empty(inverse.answer.shape[0])
    for k in range(share.size):
        share[k] = 0.0
    for entry in range(inverse.value.size):
        share[inverse.column[entry]] += inverse.value[entry] * right[0, inverse.row[entry]]
    for k in range(share.size):
        for i in range(right.shape[1]):
            right[0, i] -= inverse.answer[k, i] * share[k]
    largest = 0.0
    for i in range(right.shape[1]):
        size = abs(right[0, i])
        if size > largest or math.isnan(size):
            largest = size
    return largest


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

    parts: Parts

    @classmethod
    def of(cls, band: np.ndarray, low_rank: LowRank, factor: float) -> 'Inverse':
        """Return the inverse of ``band`` (2 w + 1, m) + ``factor`` * ``low_rank``."""
        factors = factorise(band)
        basis, weight = low_rank.basis, factor * low_rank.weight
        solved = np.array(basis.T, order='C')
        substitute(factors, solved)
        core = np.eye(len(weight)) + weight @ (solved @ basis).T
        answer = np.linalg.solve(core, weight).T @ solved
        row, column = np.array(np.nonzero(basis))
        return cls(Parts(factors, row, column, basis[row, column], answer))

    def about(self, band: np.ndarray) -> 'Inverse':
        """Return the inverse for another ``band`` with the correction for the low rank as here.

        It is inexact to the extent that the bands differ: good enough for iterations.
        """
        return Inverse(self.parts._replace(factors=factorise(band)))

    def __call__(self, vector: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the product with ``vector`` (m,) and the size of its largest entry."""
        product = np.array(vector, ndmin=2, order='C')
        return product[0], solve(self.parts, product)

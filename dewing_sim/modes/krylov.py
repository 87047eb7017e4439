# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Eigenvalues of a propagator by Arnoldi's method, orthogonalised twice.

    P V_m = V_m H_m + h_m+1,m v_m+1 e_m^T,      V_m^T V_m = 1,      v_1 = b / |b|

An eigenpair (mu, s) of H_m gives the Ritz pair (mu, V_m s) of P with the residual
h_m+1,m |s_m| / |mu|, and the kick b has the share c of it, where sum_j c_j s_j = |b| e_1.
ARPACK needs the same steps where the whole basis is kept, see `scipy.sparse.linalg.eigs`, but
neither gives the shares nor shows how the values settle: so the thirty lines are ours.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

EXHAUSTED = 1.0e-13         # what is left of a vector, relative, when its space holds it


@dataclass(frozen=True, eq=False)
class Ritz:
    """The pairs of a Krylov space of m vectors, largest |mu| first."""

    basis: np.ndarray           # (m, n), the rows are V_m
    values: np.ndarray          # (m,) complex, mu
    vectors: np.ndarray         # (m, m) complex, the columns are s
    shares: np.ndarray          # (m,) complex, c
    residuals: np.ndarray       # (m,)

    def vector(self, k: int) -> np.ndarray:
        """Return the k-th eigenvector (n,), complex, of norm 1."""
        return self.vectors[:, k] @ self.basis


class Space:
    """A growing orthonormal basis with the operator projected on it, (k + 1, k)."""

    def __init__(self, operate: Callable[[np.ndarray], np.ndarray], first: np.ndarray,
                 vectors: int):
        """Begin with ``first`` (n,), which must not vanish."""
        self.norm = float(np.linalg.norm(first))
        self._operate, self.size = operate, 0
        self._basis = np.empty((vectors + 1, first.size))
        self._basis[0] = first / self.norm
        self._hessenberg = np.zeros((vectors + 1, vectors))

    @property
    def basis(self) -> np.ndarray:
        """V_m (m, n)."""
        return self._basis[:self.size]

    @property
    def hessenberg(self) -> np.ndarray:
        """The projected operator (m + 1, m)."""
        return self._hessenberg[:self.size + 1, :self.size]

    def grow(self) -> bool:
        """Add a vector; return whether there was one: not if the space is exhausted."""
        k, basis = self.size, self._basis
        grown = self._operate(basis[k])
        scale = np.linalg.norm(grown)
        for _twice in range(2):
            along = basis[:k + 1] @ grown
            grown = grown - along @ basis[:k + 1]
            self._hessenberg[:k + 1, k] += along
        rest = self._hessenberg[k + 1, k] = np.linalg.norm(grown)
        self.size = k + 1
        if rest <= EXHAUSTED * scale:
            return False
        basis[k + 1] = grown / rest
        return True


def arnoldi(propagate: Callable[[np.ndarray], np.ndarray], first: np.ndarray, vectors: int,
            progress: Callable[[int, int], None] | None = None) -> Ritz:
    """Return the Ritz pairs of ``propagate`` from ``first`` (n,) with that many ``vectors``.

    There are fewer where P v lies in the space but for rounding.
    """
    space = Space(propagate, first, vectors)
    while space.grow() and space.size < vectors:
        if progress:
            progress(space.size, vectors)
    return _pairs(space)


def gmres(operate: Callable[[np.ndarray], np.ndarray], right: np.ndarray, vectors: int,
          tolerance: float) -> np.ndarray:
    """Return x (n,) with |operate(x) - right| at most ``tolerance`` |right|, or the best there is.

    The perturbations are those of the Krylov space of ``right``, as differences of runs must be,
    which `scipy.sparse.linalg.gmres` with its restarts does not say.
    """
    space = Space(operate, right, vectors)
    while True:
        more = space.grow()
        wanted = np.zeros(space.size + 1)
        wanted[0] = space.norm
        weights = np.linalg.lstsq(space.hessenberg, wanted, rcond=None)[0]
        left = np.linalg.norm(space.hessenberg @ weights - wanted)
        if left <= tolerance * space.norm or not more or space.size == vectors:
            return weights @ space.basis


def _pairs(space: Space) -> Ritz:
    """Return the eigenpairs of the projected operator."""
    count, hessenberg = space.size, space.hessenberg
    values, vectors = np.linalg.eig(hessenberg[:count])
    order = np.argsort(-np.abs(values), kind='stable')
    values, vectors = values[order].astype(complex), vectors[:, order].astype(complex)
    start = np.zeros(count)
    start[0] = space.norm
    with np.errstate(divide='ignore'):
        residuals = hessenberg[count, count - 1] * np.abs(vectors[-1]) / np.abs(values)
    return Ritz(space.basis, values, vectors, np.linalg.solve(vectors, start), residuals)

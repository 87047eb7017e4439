# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Block Hankel matrices of Markov parameters, and the leading part of their decomposition.

Block (i, j) is h[i + j], so that H x is a correlation of h and x, which the Fourier transform
takes in N log N operations: the matrix of a long record is never stored.
"""

import numpy as np
from scipy import fft, linalg

OVERSAMPLING = 10                       # directions sought beside those asked for


class Hankel:
    """H (rows outputs, columns inputs) of h (outputs, inputs, rows + columns - 1); takes @."""

    __array_ufunc__ = None              # numpy leaves x @ H to `__rmatmul__`

    def __init__(self, h: np.ndarray, rows: int, columns: int):
        self.rows, self.columns = rows, columns
        self.h = h[:, :, :rows + columns - 1]
        self.length = fft.next_fast_len(self.h.shape[2], real=True)
        self.spectrum = fft.rfft(self.h, self.length).transpose(2, 0, 1)

    @property
    def shape(self) -> tuple[int, int]:
        """Return the shape of the matrix."""
        return self.rows * self.h.shape[0], self.columns * self.h.shape[1]

    def dense(self) -> np.ndarray:
        """Return the matrix itself."""
        blocks = self.h[:, :, np.add.outer(np.arange(self.rows), np.arange(self.columns))]
        return blocks.transpose(2, 0, 3, 1).reshape(self.shape)

    def __matmul__(self, x: np.ndarray) -> np.ndarray:
        """Return H x for x (columns inputs, k)."""
        return self._correlate(self.spectrum, x, self.columns, self.rows)

    def __rmatmul__(self, x: np.ndarray) -> np.ndarray:
        """Return x H for x (k, rows outputs)."""
        return self._correlate(self.spectrum.transpose(0, 2, 1), x.T, self.rows, self.columns).T

    def _correlate(self, spectrum: np.ndarray, x: np.ndarray, taken: int, made: int) -> np.ndarray:
        """Return y[i] = sum_j h[i + j] x[j] for ``made`` blocks i from ``taken`` blocks j."""
        blocks = x.reshape(taken, -1, x.shape[1])[::-1]
        product = spectrum @ fft.rfft(blocks, self.length, axis=0)
        return fft.irfft(product, self.length, axis=0)[taken - 1:taken - 1 + made].reshape(
            -1, x.shape[1])


def leading(hankel: Hankel, values: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the ``values`` leading singular triplets U, S, V^T of ``hankel``.

    Randomised range finder with one power iteration (Halko, Martinsson and Tropp 2011,
    doi:10.1137/090771806, algorithms 4.4 and 5.1) from a fixed seed: the same record gives the
    same bits.
    """
    width = min(values + OVERSAMPLING, *hankel.shape)
    start = np.random.default_rng(1).standard_normal((hankel.shape[1], width))
    found = _orthonormal(hankel @ start)
    found = _orthonormal(hankel @ _orthonormal((found.T @ hankel).T))
    left, singular_values, right = linalg.svd(found.T @ hankel, full_matrices=False)
    kept = slice(min(values, width))
    return (found @ left)[:, kept], singular_values[kept], right[kept]


def _orthonormal(columns: np.ndarray) -> np.ndarray:
    return linalg.qr(columns, mode='economic')[0]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Block Hankel matrices of Markov parameters, and the leading part of their decomposition.

Block (i, j) is h[i + j], so that H x is a correlation of h and x, which the Fourier transform
takes in N log N operations: the matrix of a long record is never stored.
"""

import numpy as np
from scipy import fft, linalg

OVERSAMPLING = 10                       # directions sought beside those asked for
GROUP = 4                               # vectors transformed at a time, to stay in the cache


class Hankel:
    """H (rows outputs, columns inputs) of h (outputs, inputs, rows + columns - 1); takes @."""

    __array_ufunc__ = None              # numpy leaves x @ H to `__rmatmul__`

    def __init__(self, h: np.ndarray, rows: int, columns: int):
        self.rows, self.columns = rows, columns
        self.h = h[:, :, :rows + columns - 1]
        self.length = fft.next_fast_len(self.h.shape[2], real=True)
        self.spectrum = fft.rfft(self.h, self.length)

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
        return _columns(self.forth(x.reshape(self.columns, -1, x.shape[1]).transpose(2, 1, 0)))

    def __rmatmul__(self, x: np.ndarray) -> np.ndarray:
        """Return x H for x (k, rows outputs)."""
        return _columns(self.back(x.reshape(len(x), self.rows, -1).transpose(0, 2, 1))).T

    def forth(self, x: np.ndarray) -> np.ndarray:
        """Return H x for k signals x (k, inputs, columns) as (k, outputs, rows)."""
        return self._correlate(self.spectrum, x, self.rows)

    def back(self, y: np.ndarray) -> np.ndarray:
        """Return H^T y for k signals y (k, outputs, rows) as (k, inputs, columns)."""
        return self._correlate(self.spectrum.transpose(1, 0, 2), y, self.columns)

    def _correlate(self, spectrum: np.ndarray, x: np.ndarray, made: int) -> np.ndarray:
        """Return y[i] = sum_j h[i + j] x[j] for ``made`` samples i, in the precision of x."""
        taken, spectrum = x.shape[2], spectrum.astype(np.result_type(x.dtype, 1j), copy=False)
        y = np.empty((len(x), len(spectrum), made), x.dtype)
        for group in range(0, len(x), GROUP):
            some = slice(group, group + GROUP)
            of_x = fft.rfft(x[some, :, ::-1], self.length)
            product = sum(spectrum[:, i] * of_x[:, i:i + 1] for i in range(x.shape[1]))
            y[some] = fft.irfft(product, self.length)[:, :, taken - 1:taken - 1 + made]
        return y


def _columns(signals: np.ndarray) -> np.ndarray:
    """Return signals (k, channels, samples) as columns (samples channels, k) of blocks."""
    return signals.transpose(2, 1, 0).reshape(-1, len(signals))


def leading(hankel: Hankel, values: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the ``values`` leading singular triplets U, S, V^T of ``hankel``.

    Randomised range finder with one power iteration (Halko, Martinsson and Tropp 2011,
    doi:10.1137/090771806, algorithms 4.4 and 5.1) from a fixed seed: the same record gives the
    same bits. The first two of its four products only find directions and are made in single
    precision; a triangular factorisation is enough between two products in double precision.
    """
    outputs, width = hankel.h.shape[0], min(values + OVERSAMPLING, *hankel.shape)
    signs = np.random.default_rng(1).integers(0, 2, (width, outputs, hankel.rows), np.int8)
    rough = hankel.forth(_orthonormal(hankel.back((2 * signs - 1).astype(np.float32))))
    right = _orthonormal(hankel.back(_independent(rough.astype(float))))
    left, triangle = linalg.qr(_flat(hankel.forth(right)).T, mode='economic', overwrite_a=True,
                               check_finite=False)
    turn, singular_values, turn_right = linalg.svd(triangle)
    kept = min(values, width)
    left = (turn.T[:kept] @ left.T).reshape(kept, outputs, -1)
    right = (turn_right[:kept] @ _flat(right)).reshape(kept, *right.shape[1:])
    return _columns(left), singular_values[:kept], _columns(right).T


def _flat(signals: np.ndarray) -> np.ndarray:
    return signals.reshape(len(signals), -1)


def _orthonormal(signals: np.ndarray) -> np.ndarray:
    """Return orthonormal signals that span the same space; overwrites ``signals``."""
    return linalg.qr(_flat(signals).T, mode='economic', overwrite_a=True,
                     check_finite=False)[0].T.reshape(signals.shape)


def _independent(signals: np.ndarray) -> np.ndarray:
    """Return well-conditioned signals that span the same space; overwrites ``signals``."""
    return linalg.lu(_flat(signals).T, permute_l=True, overwrite_a=True,
                     check_finite=False)[0].T.reshape(signals.shape)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fourier transforms of one line of nodes, as products with matrices.

For a single line of some hundred nodes a product takes less time than the call of a library; whole
fields are transformed by `scipy.fft`.
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.kernels import kernel


@dataclass(frozen=True)
class Line:
    """The transforms `rfft` and `irfft` of n (even) real values."""

    cos: np.ndarray             # (modes, n) of k xi_i, with xi_0 = 0
    sin: np.ndarray
    cos_of_node: np.ndarray     # their transposes
    sin_of_node: np.ndarray

    @classmethod
    def of(cls, n: int) -> 'Line':
        """Return the transforms of ``n`` values."""
        turns = np.outer(np.arange(n // 2 + 1), np.arange(n)) % n
        cos, sin = np.cos(2.0 * np.pi / n * turns), np.sin(2.0 * np.pi / n * turns)
        sin[-1] = 0.0
        return cls(cos, sin, np.ascontiguousarray(cos.T), np.ascontiguousarray(sin.T))

    def modes(self, values: np.ndarray) -> np.ndarray:
        """Return sum_i values_i exp(-i k xi_i), complex (modes,)."""
        return _modes(values, self.cos_of_node, self.sin_of_node)

    def values(self, modes: np.ndarray) -> np.ndarray:
        """Return the values (n,) of which these are the modes."""
        return _values(modes, self.cos, self.sin)


@kernel
def _modes(values, cos, sin):
    n, count = cos.shape
    even, odd = np.zeros(count), np.zeros(count)
    for i in range(n):
        value = values[i]
        for k in range(count):
            even[k] += value * cos[i, k]
            odd[k] += value * sin[i, k]
    out = np.empty(count, dtype=np.complex128)
    for k in range(count):
        out[k] = complex(even[k], -odd[k])
    return out


@kernel
def _values(modes, cos, sin):
    count, n = cos.shape
    out = np.zeros(n)
    for k in range(count):
        share = (1.0 if k == 0 or k == count - 1 else 2.0) / n
        even, odd = share * modes[k].real, share * modes[k].imag
        for i in range(n):
            out[i] += even * cos[k, i] - odd * sin[k, i]
    return out

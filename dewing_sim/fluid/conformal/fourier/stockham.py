# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fourier transforms along xi of all rows at once, by Stockham's self-sorting algorithm.

A field (n, rows) holds line after line, so that each butterfly runs along a whole line and every
row is a SIMD lane.  That takes less than half the time of a library, which transforms row by row,
and compiled code can call it: a single line takes little more than a microsecond.  A stage of
radix r joins r transforms of m values each,

    Y_(k + j m) = sum_a exp(-2 pi i (k + j m) a / (m r)) X_(a, k),   k < m, j < r,

with real and imaginary parts apart (Van Loan 1992, doi 10.1137/1.9781611970999, section 1.7).
"""

from functools import cache
from typing import NamedTuple

import llvmlite.binding
import numba
import numpy as np
from numba import types

from dewing_sim.errors import BadInput
from dewing_sim.machine.kernels import c_function, kernel, part, scratch

RADICES = (3, 2, 4)         # in the order of the stages: the last has the shortest loops
SIN_3 = np.sin(np.pi / 3.0)
SYMBOL = 'dewing_stockham'
REALS, INTEGERS = types.CPointer(types.float64), types.CPointer(types.int64)
SIGNATURE = types.int64(REALS, REALS, REALS, REALS, types.int64, types.int64, INTEGERS,
                        types.int64, REALS, REALS)
_stockham = types.ExternalFunction(SYMBOL, SIGNATURE)


class TwiddleFactors(NamedTuple):
    """Radices of the stages and the factors exp(-2 pi i k a / (m r)) of all of them in a row."""

    radices: np.ndarray
    cos: np.ndarray
    sin: np.ndarray

    @classmethod
    def of(cls, n: int) -> 'TwiddleFactors':
        """Return those for ``n`` values; raise `BadInput` for other factors than 2 and 3."""
        _compile()
        radices = _factors(n)
        m, twiddles = 1, []
        for r in radices:
            twiddles.append(np.outer(np.arange(m), np.arange(1, r)).ravel() / (m * r))
            m *= r
        angles = -2.0 * np.pi * np.concatenate(twiddles)
        return cls(np.array(radices, dtype=np.int64), np.cos(angles), np.sin(angles))

    def __reduce__(self) -> tuple:
        """Let a copy in another process find the stages compiled there, too."""
        return _restored, tuple(self)


def _restored(*parts: np.ndarray) -> 'TwiddleFactors':
    _compile()
    return TwiddleFactors(*parts)


def _factors(n: int) -> list[int]:
    radices, rest = [], n
    for r in sorted(RADICES, reverse=True):
        while rest % r == 0:
            radices.append(r)
            rest //= r
    if rest != 1:
        raise BadInput(f'{n} values to transform: not a product of 2 and 3')
    return sorted(radices, key=RADICES.index)


class Buffers(NamedTuple):
    """Real and imaginary parts, and room for those of the next stage; all 1-D."""

    re: np.ndarray
    im: np.ndarray
    next_re: np.ndarray
    next_im: np.ndarray

    @classmethod
    def of(cls, size: int) -> 'Buffers':
        """Return buffers for ``size`` values."""
        return cls(*scratch(4, size))


@kernel
def transform(b, n, lanes, twiddles):
    """Return sum_i x_i exp(-2 pi i k i / n) of x (n, lanes) in ``b``, real and imaginary part."""
    size = n * lanes
    stages = twiddles.radices.size
    _stockham(b.re.ctypes, b.im.ctypes, b.next_re.ctypes, b.next_im.ctypes, n, lanes,
              twiddles.radices.ctypes, stages, twiddles.cos.ctypes, twiddles.sin.ctypes)
    re, im = (b.re, b.im) if stages % 2 == 0 else (b.next_re, b.next_im)
    return re[:size].reshape((n, lanes)), im[:size].reshape((n, lanes))


@cache
def _compile() -> object:
    """Compile the stages once, for all kernels to call by name; return what keeps them in memory.

    Called as other kernels are, they would be compiled into each of their callers and into the
    callers of these, which takes half a minute.
    """
    compiled = c_function(_stages, SIGNATURE)
    llvmlite.binding.add_symbol(SYMBOL, compiled.address)
    return compiled


def _stages(re, im, next_re, next_im, n, lanes, radices, stages, cos, sin):
    """Run all stages, to and fro between two pairs of buffers."""
    size = n * lanes
    m, done = 1, 0
    for stage in range(stages):
        r = radices[stage]
        w = size // (m * r)
        there, back = (m, r, w), (r, m, w)
        x, y = numba.carray(re, there), numba.carray(im, there)
        next_x, next_y = numba.carray(next_re, back), numba.carray(next_im, back)
        factors = m * (r - 1)
        c = numba.carray(cos, done + factors)[done:]
        s = numba.carray(sin, done + factors)[done:]
        if r == 4:
            _join_4(x, y, next_x, next_y, c, s)
        elif r == 3:
            _join_3(x, y, next_x, next_y, c, s)
        else:
            _join_2(x, y, next_x, next_y, c, s)
        re, im, next_re, next_im = next_re, next_im, re, im
        done += factors
        m *= r
    return stages


@part
def _join_2(x, y, next_x, next_y, cos, sin):
    m, _, w = x.shape
    for k in range(m):
        c, s = cos[k], sin[k]
        for t in range(w):
            u, v = c * x[k, 1, t] - s * y[k, 1, t], s * x[k, 1, t] + c * y[k, 1, t]
            next_x[0, k, t] = x[k, 0, t] + u
            next_y[0, k, t] = y[k, 0, t] + v
            next_x[1, k, t] = x[k, 0, t] - u
            next_y[1, k, t] = y[k, 0, t] - v


@part
def _join_3(x, y, next_x, next_y, cos, sin):
    m, _, w = x.shape
    for k in range(m):
        c1, s1, c2, s2 = cos[2 * k], sin[2 * k], cos[2 * k + 1], sin[2 * k + 1]
        for t in range(w):
            u1, v1 = c1 * x[k, 1, t] - s1 * y[k, 1, t], s1 * x[k, 1, t] + c1 * y[k, 1, t]
            u2, v2 = c2 * x[k, 2, t] - s2 * y[k, 2, t], s2 * x[k, 2, t] + c2 * y[k, 2, t]
            even_x, even_y = u1 + u2, v1 + v2
            odd_x, odd_y = SIN_3 * (u1 - u2), SIN_3 * (v1 - v2)
            mean_x, mean_y = x[k, 0, t] - 0.5 * even_x, y[k, 0, t] - 0.5 * even_y
            next_x[0, k, t] = x[k, 0, t] + even_x
            next_y[0, k, t] = y[k, 0, t] + even_y
            next_x[1, k, t] = mean_x + odd_y
            next_y[1, k, t] = mean_y - odd_x
            next_x[2, k, t] = mean_x - odd_y
            next_y[2, k, t] = mean_y + odd_x


@part
def _join_4(x, y, next_x, next_y, cos, sin):
    m, _, w = x.shape
    for k in range(m):
        c1, c2, c3 = cos[3 * k], cos[3 * k + 1], cos[3 * k + 2]
        s1, s2, s3 = sin[3 * k], sin[3 * k + 1], sin[3 * k + 2]
        for t in range(w):
            u1, v1 = c1 * x[k, 1, t] - s1 * y[k, 1, t], s1 * x[k, 1, t] + c1 * y[k, 1, t]
            u2, v2 = c2 * x[k, 2, t] - s2 * y[k, 2, t], s2 * x[k, 2, t] + c2 * y[k, 2, t]
            u3, v3 = c3 * x[k, 3, t] - s3 * y[k, 3, t], s3 * x[k, 3, t] + c3 * y[k, 3, t]
            sum_x, sum_y = x[k, 0, t] + u2, y[k, 0, t] + v2
            gap_x, gap_y = x[k, 0, t] - u2, y[k, 0, t] - v2
            next_x[0, k, t] = sum_x + (u1 + u3)
            next_y[0, k, t] = sum_y + (v1 + v3)
            next_x[1, k, t] = gap_x + (v1 - v3)
            next_y[1, k, t] = gap_y - (u1 - u3)
            next_x[2, k, t] = sum_x - (u1 + u3)
            next_y[2, k, t] = sum_y - (v1 + v3)
            next_x[3, k, t] = gap_x - (v1 - v3)
            next_y[3, k, t] = gap_y + (u1 - u3)

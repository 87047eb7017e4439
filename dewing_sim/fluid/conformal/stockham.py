# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fourier transforms along xi, of all rows at once or of one, by Stockham's self-sorting algorithm.

A field (n, rows) holds line after line, so that each butterfly runs along a whole line and every
row is a SIMD lane.  That takes less than half the time of a library, which transforms row by row,
and compiled code can call it: a single line takes little more than a microsecond.  A stage of radix r joins r transforms of m values each,

    Y_(k + j m) = sum_a exp(-2 pi i (k + j m) a / (m r)) X_(a, k),   k < m, j < r,

with real and imaginary parts apart (Van Loan 1992, doi 10.1137/1.9781611970999, section 1.7).
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.fluid.kernels import kernel, scratch

RADICES = (5, 3, 2, 4)
SIN_3 = np.sin(np.pi / 3.0)
COS_5 = tuple(np.cos(2.0 * np.pi / 5.0 * np.array([1.0, 2.0])))
SIN_5 = tuple(np.sin(2.0 * np.pi / 5.0 * np.array([1.0, 2.0])))


class Turns(NamedTuple):
    """Radices of the stages and the factors exp(-2 pi i k a / (m r)) of all of them in a row."""

    radices: np.ndarray
    cos: np.ndarray
    sin: np.ndarray

    @classmethod
    def of(cls, n: int) -> 'Turns':
        """Return the plan for ``n`` values; raise `BadInput` for other factors than 2, 3, 5."""
        radices = _factors(n)
        m, turns = 1, []
        for r in radices:
            turns.append(np.outer(np.arange(m), np.arange(1, r)).ravel() / (m * r))
            m *= r
        angles = -2.0 * np.pi * np.concatenate(turns)
        return cls(np.array(radices), np.cos(angles), np.sin(angles))


def _factors(n: int) -> list[int]:
    radices, rest = [], n
    for r in sorted(RADICES, reverse=True):
        while rest % r == 0:
            radices.append(r)
            rest //= r
    if rest != 1:
        raise BadInput(f'{n} nodes around the wing: not a product of 2, 3 and 5')
    return sorted(radices, key=RADICES.index)


class Plan(NamedTuple):
    """What transforms of n values need; all are made of transforms of n / 2."""

    half: Turns                     # of n / 2 values
    cos: np.ndarray                 # (n / 2 + 1,) real part of W^k = exp(-2 pi i k / n)
    sin: np.ndarray                 # (n / 2 + 1,) its imaginary part

    @classmethod
    def of(cls, n: int) -> 'Plan':
        """Return the plan for an even ``n``."""
        angles = -2.0 * np.pi / n * np.arange(n // 2 + 1)
        return cls(Turns.of(n // 2), np.cos(angles), np.sin(angles))


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
def transform(b, n, lanes, turns):
    """Return sum_i x_i exp(-2 pi i k i / n) of x (n, lanes) in ``b``, real and imaginary part."""
    size = n * lanes
    re, im, next_re, next_im = b.re[:size], b.im[:size], b.next_re[:size], b.next_im[:size]
    m, done = 1, 0
    for r in turns.radices:
        w = size // (m * r)
        cos, sin = turns.cos[done:], turns.sin[done:]
        x, y = re.reshape((m, r, w)), im.reshape((m, r, w))
        next_x, next_y = next_re.reshape((r, m, w)), next_im.reshape((r, m, w))
        if r == 4:
            _join_4(x, y, next_x, next_y, cos, sin)
        elif r == 2:
            _join_2(x, y, next_x, next_y, cos, sin)
        elif r == 3:
            _join_3(x, y, next_x, next_y, cos, sin)
        else:
            _join_5(x, y, next_x, next_y, cos, sin)
        re, im, next_re, next_im = next_re, next_im, re, im
        done += m * (r - 1)
        m *= r
    return re.reshape((n, lanes)), im.reshape((n, lanes))


@kernel
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


@kernel
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


@kernel
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


@kernel
def _join_5(x, y, next_x, next_y, cos, sin):
    """Join five in two loops, each with few enough arrays for the compiler to tell them apart."""
    m, _, w = x.shape
    for k in range(m):
        for pair in range(2):
            a, b = (COS_5[0], COS_5[1]) if pair == 0 else (COS_5[1], COS_5[0])
            c, d = (SIN_5[0], SIN_5[1]) if pair == 0 else (SIN_5[1], -SIN_5[0])
            first, second = 1 + pair, 4 - pair
            c1, c2, c3, c4 = cos[4 * k], cos[4 * k + 1], cos[4 * k + 2], cos[4 * k + 3]
            s1, s2, s3, s4 = sin[4 * k], sin[4 * k + 1], sin[4 * k + 2], sin[4 * k + 3]
            for t in range(w):
                u1, v1 = c1 * x[k, 1, t] - s1 * y[k, 1, t], s1 * x[k, 1, t] + c1 * y[k, 1, t]
                u2, v2 = c2 * x[k, 2, t] - s2 * y[k, 2, t], s2 * x[k, 2, t] + c2 * y[k, 2, t]
                u3, v3 = c3 * x[k, 3, t] - s3 * y[k, 3, t], s3 * x[k, 3, t] + c3 * y[k, 3, t]
                u4, v4 = c4 * x[k, 4, t] - s4 * y[k, 4, t], s4 * x[k, 4, t] + c4 * y[k, 4, t]
                mean_x = x[k, 0, t] + a * (u1 + u4) + b * (u2 + u3)
                mean_y = y[k, 0, t] + a * (v1 + v4) + b * (v2 + v3)
                odd_x, odd_y = c * (u1 - u4) + d * (u2 - u3), c * (v1 - v4) + d * (v2 - v3)
                next_x[0, k, t] = x[k, 0, t] + (u1 + u4) + (u2 + u3)
                next_y[0, k, t] = y[k, 0, t] + (v1 + v4) + (v2 + v3)
                next_x[first, k, t] = mean_x + odd_y
                next_y[first, k, t] = mean_y - odd_x
                next_x[second, k, t] = mean_x - odd_y
                next_y[second, k, t] = mean_y + odd_x


@kernel
def to_modes(field, rows, b, plan, out):
    """Write the modes of the first ``rows`` of a real field (n, all) to ``out`` (all, 2 modes).

    Real parts come first, then imaginary parts. Even lines are transformed as real parts, odd
    lines as imaginary parts: Z_k = A_k + i B_k, and X_k = A_k + exp(-2 pi i k / n) B_k.
    """
    last = field.shape[0] // 2
    size, modes = last * rows, last + 1
    re, im = b.re[:size].reshape((last, rows)), b.im[:size].reshape((last, rows))
    for i in range(last):
        for j in range(rows):
            re[i, j], im[i, j] = field[2 * i, j], field[2 * i + 1, j]
    re, im = transform(b, last, rows, plan.half)
    for k in range(modes):
        now, mirror = k % last, (last - k) % last
        c, s = 0.5 * plan.cos[k], 0.5 * plan.sin[k]
        for j in range(rows):
            x, y = re[now, j] + re[mirror, j], im[now, j] + im[mirror, j]
            u, v = re[now, j] - re[mirror, j], im[now, j] - im[mirror, j]
            out[j, k], out[j, modes + k] = 0.5 * x + c * y + s * u, 0.5 * v - c * u + s * y


@kernel
def to_field(modes, b, plan, out):
    """Write the real field (n, rows) of ``modes`` (rows, 2 (n / 2 + 1)) to ``out``."""
    n, rows = out.shape
    last = n // 2
    count, size = last + 1, last * rows
    re, im = b.re[:size].reshape((last, rows)), b.im[:size].reshape((last, rows))
    for k in range(last):
        c, s = plan.cos[k], plan.sin[k]
        turned = 1.0 if k else 0.0          # modes 0 and n / 2 of a real field are real
        for j in range(rows):
            x, u = modes[j, k] + modes[j, last - k], modes[j, k] - modes[j, last - k]
            y = turned * (modes[j, count + k] - modes[j, count + last - k])
            v = turned * (modes[j, count + k] + modes[j, count + last - k])
            # The inverse transform is the transform of real and imaginary part exchanged.
            im[k, j], re[k, j] = x - c * v + s * u, y + c * u + s * v
    im, re = transform(b, last, rows, plan.half)
    for i in range(last):
        for j in range(rows):
            out[2 * i, j], out[2 * i + 1, j] = re[i, j] / n, im[i, j] / n


@kernel
def line_modes(values, b, plan):
    """Return the modes, complex (n / 2 + 1,), of one real line (n,)."""
    count = values.size // 2 + 1
    out = np.empty((1, 2 * count))
    to_modes(values.reshape((-1, 1)), 1, b, plan, out)
    modes = np.empty(count, dtype=np.complex128)
    for k in range(count):
        modes[k] = complex(out[0, k], out[0, count + k])
    return modes


@kernel
def line_values(modes, b, plan):
    """Return the real line (n,) of which these are the modes (n / 2 + 1,)."""
    count = modes.size
    parts, out = np.empty((1, 2 * count)), np.empty((2 * count - 2, 1))
    for k in range(count):
        parts[0, k], parts[0, count + k] = modes[k].real, modes[k].imag
    to_field(parts, b, plan, out)
    return out[:, 0]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fields and lines of real values on the nodes, and their modes along xi."""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.fourier.stockham import TwiddleFactors, transform
from dewing_sim.machine.kernels import kernel


class Plan(NamedTuple):
    """What transforms of n values need; all are made of transforms of n / 2."""

    half: TwiddleFactors            # of n / 2 values
    cos: np.ndarray                 # (n / 2 + 1,) real part of W^k = exp(-2 pi i k / n)
    sin: np.ndarray                 # (n / 2 + 1,) its imaginary part

    @classmethod
    def of(cls, n: int) -> 'Plan':
        """Return the plan for an even ``n``."""
        angles = -2.0 * np.pi / n * np.arange(n // 2 + 1)
        return cls(TwiddleFactors.of(n // 2), np.cos(angles), np.sin(angles))


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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Power series of exp(-zeta) outside the membrane, summed on the nodes by a Fourier transform."""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.spectral import Plan
from dewing_sim.fluid.conformal.stockham import transform
from dewing_sim.machine.kernels import kernel


class Exterior(NamedTuple):
    """The strip as the series see it."""

    decay: np.ndarray               # (modes, rows) exp(-k eta), k < n / 2
    on_wall: np.ndarray             # (modes, 1) the same at the membrane: one
    start: np.ndarray               # (modes,) exp(-i k xi_0)
    sinh: np.ndarray                # (rows,) of eta
    cosh: np.ndarray
    cos: np.ndarray                 # (n,) of xi
    sin: np.ndarray
    xi: np.ndarray
    plan: Plan

    @classmethod
    def of(cls, grid: Grid) -> 'Exterior':
        """Return the tables of ``grid``."""
        k = grid.wavenumbers[:-1]
        return cls(np.exp(-np.outer(k, grid.eta)), np.ones((len(k), 1)),
                   np.exp(-1j * k * grid.xi[0]), np.sinh(grid.eta), np.cosh(grid.eta),
                   np.cos(grid.xi), np.sin(grid.xi), grid.xi, Plan.of(len(grid.xi)))

    @property
    def shape(self) -> tuple[int, int]:
        """Lines and rows."""
        return len(self.cos), len(self.sinh)


@kernel
def series(modes, decay, exterior, b):
    """Return real and imaginary part (n, rows) of sum_k modes_k decay_kj exp(-i k xi) in ``b``.

    With W = exp(-2 pi i / n), even lines are the transform of c_k, odd lines that of W^k c_k, each
    of n / 2 values: side by side they come out in order.
    """
    count, rows = decay.shape
    size, plan = 2 * count * rows, exterior.plan
    x, y = b.re[:size].reshape((count, 2, rows)), b.im[:size].reshape((count, 2, rows))
    for k in range(count):
        even = modes[k] * exterior.start[k]
        odd = even * complex(plan.cos[k], plan.sin[k])
        for j in range(rows):
            x[k, 0, j], y[k, 0, j] = even.real * decay[k, j], even.imag * decay[k, j]
            x[k, 1, j], y[k, 1, j] = odd.real * decay[k, j], odd.imag * decay[k, j]
    x, y = transform(b, count, 2 * rows, plan.half)
    return x.reshape((2 * count, rows)), y.reshape((2 * count, rows))


@kernel
def wall_series(modes, exterior, b):
    """Return real and imaginary part (n,) of sum_k modes_k exp(-i k xi) in ``b``."""
    x, y = series(modes, exterior.on_wall, exterior, b)
    return x[:, 0], y[:, 0]

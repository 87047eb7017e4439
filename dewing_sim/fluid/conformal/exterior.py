# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Power series of exp(-zeta) outside the membrane, summed on the nodes by a Fourier transform."""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.stockham import Plan, transform
from dewing_sim.fluid.kernels import kernel


class Exterior(NamedTuple):
    """The strip as the series see it."""

    decay: np.ndarray               # (modes, rows) exp(-k eta), k < n / 2
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
        return cls(np.exp(-np.outer(k, grid.eta)), np.exp(-1j * k * grid.xi[0]),
                   np.sinh(grid.eta), np.cosh(grid.eta), np.cos(grid.xi), np.sin(grid.xi),
                   grid.xi, Plan.of(len(grid.xi)))

    @property
    def shape(self) -> tuple[int, int]:
        """Lines and rows."""
        return len(self.cos), len(self.sinh)


@kernel
def series(modes, exterior, b):
    """Return real and imaginary part (n, rows) of sum_k modes_k exp(-k zeta)."""
    count, rows = exterior.decay.shape
    size = 2 * count * rows
    re, im = b.re[:size].reshape((2 * count, rows)), b.im[:size].reshape((2 * count, rows))
    for k in range(count):
        mode = modes[k] * exterior.start[k]
        for j in range(rows):
            re[k, j] = mode.real * exterior.decay[k, j]
            im[k, j] = mode.imag * exterior.decay[k, j]
    re[count:] = 0.0
    im[count:] = 0.0
    return transform(b, 2 * count, rows, exterior.plan.full)


@kernel
def wall_series(modes, exterior, b):
    """Return real and imaginary part (n,) of sum_k modes_k exp(-i k xi) in ``b``."""
    count = modes.size
    for k in range(count):
        mode = modes[k] * exterior.start[k]
        b.re[k], b.im[k] = mode.real, mode.imag
    b.re[count:2 * count] = 0.0
    b.im[count:2 * count] = 0.0
    re, im = transform(b, 2 * count, 1, exterior.plan.full)
    return re[:, 0], im[:, 0]

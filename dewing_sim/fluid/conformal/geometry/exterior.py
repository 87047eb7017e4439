# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Power series of exp(-zeta) outside the membrane, summed on the nodes by a Fourier transform.

Products of those of z_zeta and z_t give metric and motion of the grid, h^2 = |z_zeta|^2 and
G_V + i G_U = z_t conj(z_zeta).
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.fourier.modes import Plan
from dewing_sim.fluid.conformal.fourier.stockham import Buffers, transform
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.machine.kernels import kernel, stage


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
        return cls(
            decay=np.exp(-np.outer(k, grid.eta)), on_wall=np.ones((len(k), 1)),
            start=np.exp(-1j * k * grid.xi[0]), sinh=np.sinh(grid.eta), cosh=np.cosh(grid.eta),
            cos=np.cos(grid.xi), sin=np.sin(grid.xi), xi=grid.xi, plan=Plan.of(len(grid.xi)))

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


def metric_and_flux(exterior: Exterior, shape: np.ndarray, scale: float, shape_rate: np.ndarray,
                    scale_rate: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return h^2, G_V and G_U (n, rows) of the map b_k = ``shape``, a = ``scale``; see `measure`.

    The rates are those of b_k and a.
    """
    fields = np.empty((3, *exterior.shape))
    measure(shape, scale, shape_rate, scale_rate, exterior, Buffers.of(fields[0].size), *fields)
    return tuple(fields)


@stage
def measure(shape, scale, shape_rate, scale_rate, exterior, b, h2, grid_v, grid_u):
    """Write h^2, G_V and G_U (n, rows) of the map ``shape``, ``scale`` with these rates."""
    n, rows = h2.shape
    slope_x, slope_y = series(shape * np.arange(shape.size), exterior.decay, exterior, b)
    for i in range(n):
        cos, sin = 2.0 * scale * exterior.cos[i], 2.0 * scale * exterior.sin[i]
        for j in range(rows):
            x = cos * exterior.sinh[j] - slope_x[i, j]
            y = sin * exterior.cosh[j] - slope_y[i, j]
            h2[i, j], grid_v[i, j], grid_u[i, j] = x * x + y * y, x, y
    rate_x, rate_y = series(shape_rate, exterior.decay, exterior, b)
    for i in range(n):
        cos, sin = 2.0 * scale_rate * exterior.cos[i], 2.0 * scale_rate * exterior.sin[i]
        for j in range(rows):
            x, y = grid_v[i, j], grid_u[i, j]
            u = cos * exterior.cosh[j] + rate_x[i, j]
            v = sin * exterior.sinh[j] + rate_y[i, j]
            grid_v[i, j], grid_u[i, j] = u * x + v * y, v * x - u * y

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Metric and motion of the grid: h^2 = |z_zeta|^2 and G_V + i G_U = z_t conj(z_zeta).

Both are products of the power series of z_zeta and z_t.
"""

import numpy as np

from dewing_sim.fluid.conformal.exterior import Exterior, series
from dewing_sim.fluid.conformal.mapping import Map
from dewing_sim.fluid.conformal.stockham import Buffers
from dewing_sim.machine.kernels import stage


def metric(exterior: Exterior, m: Map) -> np.ndarray:
    """Return h^2 (n, rows) of a map on the nodes."""
    return metric_and_flux(exterior, m, np.zeros_like(m.shape), 0.0)[0]


def metric_and_flux(exterior: Exterior, m: Map, shape_rate: np.ndarray, scale_rate: float,
                    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return h^2, G_V and G_U (n, rows) of a map for the rates of b_k and a."""
    fields = np.empty((3, *exterior.shape))
    measure(m.shape, m.scale, shape_rate, scale_rate, exterior, Buffers.of(fields[0].size),
            *fields)
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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Alternating-direction implicit sweeps: (1 + Ax)(1 + Ay) d = r, overwriting r with d.

Each factor is tridiagonal along one grid direction.  The recurrences run along the line and the
inner loops across lines, so that they fill SIMD lanes; in y a block of lines is transposed into a
buffer that stays in the first-level cache.
"""

import numpy as np

from dewing_sim.machine.kernels import kernel

LANES = 16


@kernel
def sweep_x(r, west, east, ratio, rows):
    """Solve (1 + Ax) d = r in place for rows 1 <= i < ``rows``; the others hold given values."""
    ny = r.shape[1]
    ratio[0, :] = 0.0
    for i in range(1, rows):
        for j in range(1, ny - 1):
            pivot = 1.0 / (1.0 + west[i, j] + east[i, j] - west[i, j] * ratio[i - 1, j])
            ratio[i, j] = east[i, j] * pivot
            r[i, j] = (r[i, j] + west[i, j] * r[i - 1, j]) * pivot
    for i in range(rows - 2, 0, -1):
        for j in range(1, ny - 1):
            r[i, j] += ratio[i, j] * r[i + 1, j]


@kernel
def sweep_y(r, south, north, wall, rows):
    """Solve (1 + Ay) d = r in place for rows 1 <= i < ``rows``; ends of the lines are given.

    ``wall`` (2, nx) adds to the diagonal of the two entries beside the middle of the line.
    """
    ny = r.shape[1]
    middle = ny // 2
    lower = np.zeros((ny, LANES))
    upper = np.zeros((ny, LANES))
    extra = np.zeros((ny, LANES))
    d = np.zeros((ny, LANES))
    for start in range(1, rows, LANES):
        lanes = min(LANES, rows - start)
        for k in range(lanes):
            for j in range(ny):
                lower[j, k] = south[start + k, j]
                upper[j, k] = north[start + k, j]
                d[j, k] = r[start + k, j]
            extra[middle - 1, k] = wall[0, start + k]
            extra[middle, k] = wall[1, start + k]
        for k in range(LANES):
            upper[0, k] = 0.0
        for j in range(1, ny - 1):
            for k in range(LANES):
                pivot = 1.0 / (1.0 + lower[j, k] + upper[j, k] + extra[j, k]
                               - lower[j, k] * upper[j - 1, k])
                d[j, k] = (d[j, k] + lower[j, k] * d[j - 1, k]) * pivot
                upper[j, k] *= pivot
        for j in range(ny - 2, 0, -1):
            for k in range(LANES):
                d[j, k] += upper[j, k] * d[j + 1, k]
        for k in range(lanes):
            for j in range(1, ny - 1):
                r[start + k, j] = d[j, k]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Alternating-direction implicit sweeps: (1 + Ax)(1 + Ay) d = r.

Each factor is tridiagonal along one grid direction.  The recurrences run along the line and the
inner loops across lines, so that they fill SIMD lanes; in y a block of lines is transposed into a
buffer that stays in the first-level cache.
"""

import numpy as np

from dewing_sim.machine.kernels import part, stage

LANES = 16


@stage
def eliminate(i, rows, phi, ahead, beta_x, beta_y, per_width, lines, ratio, r):
    """Carry the elimination of (1 + Ax) from the line i - 1 to the line i, filling r and ratio.

    The right-hand side is the source and the part of the neighbours in xi, the next of which is
    the line ``ahead``; ``per_width`` is theta / width.
    """
    over_j, source, run, along = lines.over_j, lines.source, lines.run, lines.along
    west, east = (i + 1) % 2, i % 2
    for j in range(1, rows - 1):
        half, scale = 0.5 * max(beta_x, beta_y[j]), per_width * over_j[j]
        a, b = run[west, j], run[east, j]
        low = scale * (along[west, j] + 0.5 * a + half * abs(a))
        up = scale * (along[east, j] - 0.5 * b + half * abs(b))
        pivot = 1.0 / (1.0 + low + up - low * ratio[i - 1, j])
        here = phi[i, j]
        ratio[i, j] = up * pivot
        r[i, j] = (source[j] - low * (here - phi[i - 1, j]) - up * (here - phi[ahead, j])
                   + low * r[i - 1, j]) * pivot


@part
def finish(phi, south, north, drag, ratio, r, out):
    """Finish (1 + Ax), solve (1 + Ay) and fill ``out`` with ``phi`` + d; the far field is given.

    ``drag`` (2, lines) adds to the diagonal of the two entries beside the middle of a line.
    """
    lines, rows = phi.shape
    block = (np.zeros((rows, LANES)), np.zeros((rows, LANES)), np.zeros((rows, LANES)))
    for j in range(rows):
        out[0, j] = phi[0, j]
    stop = lines
    while stop > 1:
        start = max(1, stop - LANES)
        for i in range(min(stop, lines - 1) - 1, start - 1, -1):
            for j in range(1, rows - 1):
                r[i, j] += ratio[i, j] * r[i + 1, j]
        _solve_across(start, south, north, drag, r, block, rows)
        for k in range(stop - start):
            i = start + k
            out[i, 0], out[i, rows - 1] = phi[i, 0], phi[i, rows - 1]
            for j in range(1, rows - 1):
                out[i, j] = phi[i, j] + block[2][j, k]
        stop = start


@stage
def _solve_across(start, south, north, drag, r, block, rows):
    """Solve (1 + Ay) d = r for a block of lines; the ends of a line are given."""
    lower, upper, d = block
    _turn(start, rows, south, lower)
    _turn(start, rows, north, upper)
    _turn(start, rows, r, d)
    for j in range(rows // 2 - 1, rows // 2 + 1):
        for k in range(LANES):
            share = 1.0 / (1.0 + drag[j - rows // 2 + 1, start + k])
            lower[j, k], upper[j, k], d[j, k] = (lower[j, k] * share, upper[j, k] * share,
                                                 d[j, k] * share)
    for k in range(LANES):                          # the elimination fills the rest anew
        upper[0, k] = 0.0
    for j in range(1, rows - 1):
        for k in range(LANES):
            pivot = 1.0 / (1.0 + lower[j, k] + upper[j, k] - lower[j, k] * upper[j - 1, k])
            d[j, k] = (d[j, k] + lower[j, k] * d[j - 1, k]) * pivot
            upper[j, k] *= pivot
    for j in range(rows - 2, 0, -1):
        for k in range(LANES):
            d[j, k] += upper[j, k] * d[j + 1, k]


@stage
def _turn(start, rows, lines, block):
    for j in range(1, rows - 1):
        for k in range(LANES):
            block[j, k] = lines[start + k, j]

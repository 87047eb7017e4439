# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A pressure jump that stays normal to a line of straight segments, and its load stiffness."""

import numba
import numpy as np


def pressure_force(line: np.ndarray, pressure) -> np.ndarray:
    """Return the nodal forces (n+1, 2) of a pressure jump, scalar or (n,), pushing to +y.

    Both nodes of a segment (dx, dy) get p/2 (-dy, dx).
    """
    step = np.diff(line, axis=0)
    half = 0.5 * np.reshape(pressure, (-1, 1)) * np.stack([-step[:, 1], step[:, 0]], axis=1)
    force = np.zeros_like(line)
    force[:-1] += half
    force[1:] += half
    return force


@numba.njit(cache=True)
def subtract_stiffness(band, pressure, equation, share):
    """Subtract d(pressure force)/d(position) from a band (2 w + 1, m), in place.

    Line node i is sum_a share[i, a] times the a-th structure node at that place, whose equations
    are ``equation[i, a]`` (x and y), negative where fixed.
    """
    width = band.shape[0] // 2
    for k in range(pressure.size):
        half = 0.5 * pressure[k]
        for row_end in range(2):
            for end in range(2):
                turn = half if end == 1 else -half          # step = right - left
                for a in range(share.shape[1]):
                    for b in range(share.shape[1]):
                        value = turn * share[k + row_end, a] * share[k + end, b]
                        _add(band, width, equation[k + row_end, a, 0],
                             equation[k + end, b, 1], value)
                        _add(band, width, equation[k + row_end, a, 1],
                             equation[k + end, b, 0], -value)


@numba.njit(cache=True)
def _add(band, width, row, column, value):
    if row >= 0 and column >= 0:
        band[width + row - column, column] += value

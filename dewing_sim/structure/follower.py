# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A pressure jump that stays normal to a line of straight segments, and its load stiffness."""

from itertools import product

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


def subtract_stiffness(band: np.ndarray, pressure: np.ndarray, equation: np.ndarray,
                       share: np.ndarray) -> None:
    """Subtract d(pressure force)/d(position) from a band (2 w + 1, m), in place.

    Line node i is sum_a share[i, a] times the a-th structure node at that place, whose equations
    are ``equation[i, a]`` (x and y), negative where fixed.
    """
    n = pressure.size
    ends, nodes = (slice(0, n), slice(1, n + 1)), range(share.shape[1])
    for row, column, a, b in product(ends, ends, nodes, nodes):
        turn = 0.5 * pressure if column is ends[1] else -0.5 * pressure     # step = right - left
        value = turn * share[row, a] * share[column, b]
        _add(band, equation[row, a, 0], equation[column, b, 1], value)
        _add(band, equation[row, a, 1], equation[column, b, 0], -value)


def _add(band: np.ndarray, row: np.ndarray, column: np.ndarray, value: np.ndarray) -> None:
    free = (row >= 0) & (column >= 0)
    row, column = row[free], column[free]
    band[len(band) // 2 + row - column, column] += value[free]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Mean and largest deflection of a line of nodes, compiled: each step is measured.

The sum is written out, so that no BLAS changes a bit of the result.
"""

import math

import numpy as np

from dewing_sim.machine.kernels import kernel


def camber(line: np.ndarray) -> tuple[float, float, float]:
    """Return the chord average of y, the deflection of largest magnitude and its place in x.

    ``line`` (n+1, 2) are nodes. The largest is that of a parabola through three nodes, negative
    where the membrane bends down further than up.
    """
    return _camber(line)


def peak(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Return the deflection of largest magnitude and its place, see `camber`."""
    return camber(np.stack((x, y), axis=1))[1:]


@kernel
def _camber(line):
    mean, k, last = 0.0, 0, line.shape[0] - 1
    for i in range(last):
        mean += 0.5 * (line[i + 1, 1] + line[i, 1]) * (line[i + 1, 0] - line[i, 0])
        if abs(line[i + 1, 1]) > abs(line[k, 1]):
            k = i + 1
    x, y = line[k, 0], line[k, 1]
    if math.isnan(mean):                # of a line with such a node: it is the largest
        return mean, mean, mean
    if k == 0 or k == last:
        return mean, y, x
    sign = -1.0 if y < 0.0 else 1.0
    before, after = x - line[k - 1, 0], line[k + 1, 0] - x
    rise, fall = sign * (y - line[k - 1, 1]) / before, sign * (line[k + 1, 1] - y) / after
    if fall >= rise:
        return mean, y, x
    slope = (rise * after + fall * before) / (before + after)
    offset = 0.5 * slope * (before + after) / (rise - fall)
    return mean, y + sign * 0.5 * slope * offset, x + offset

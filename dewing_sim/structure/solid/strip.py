# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The mesh of a strip along the chord: lengths, masses, and its edges as the flow sees them."""

import numpy as np

from dewing_sim.machine.kernels import checked_kernel
from dewing_sim.structure.sheet import Sheet

STRAIGHT = 0.3              # of the thickness: as near to the pins lies the line of tension
GROWTH = 1.5                # of element lengths away from the edges


def lengths(elements: int, first: float) -> np.ndarray:
    """Return the shares (n,) of the chord: equal in the middle, growing from ``first``."""
    place = np.minimum(np.arange(elements), np.arange(elements)[::-1])
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        length = np.minimum(middle, first * GROWTH ** np.minimum(place, 100.0))
        low, high = (middle, high) if length.sum() < 1.0 else (low, middle)
    return length / length.sum()


def nodal_mass(length: np.ndarray, sheet: Sheet, density: float) -> np.ndarray:
    """Return nodal masses per span, a quarter of each element's at each of its nodes."""
    quarter = 0.25 * density * sheet.initial_thickness / sheet.lateral_stretch * length
    station = np.zeros(length.size + 1)
    station[:-1] += quarter
    station[1:] += quarter
    return np.repeat(station, 2)


def straight_edges(line: np.ndarray, layer: float, thickness: float,
                   ) -> tuple[int, np.ndarray, np.ndarray]:
    """Return how many stations of ``line`` (n+1, 2) lie within ``layer`` of an edge, with weights.

    A long first element, which the tension turns, belongs to the layer too: all up to the last
    station that is further from the pins than `STRAIGHT` times the ``thickness``.

    The weights (k, 2) put these k stations at the left and at the right on straight lines between
    the edge and the first station beyond.
    """
    x, y = line.T
    away = np.flatnonzero(np.abs(y[:y.size // 2]) > STRAIGHT * thickness)
    if away.size:
        layer = max(layer, float(x[away[-1] + 1]))
    inner = max(1, min(int(np.searchsorted(x, layer)), x.size // 2))
    left, right = x[:inner] / x[inner], (x[-1] - x[-inner:]) / (x[-1] - x[-1 - inner])
    return inner, np.stack([1.0 - left, left], axis=1), np.stack([1.0 - right, right], axis=1)


@checked_kernel
def mid_line(nodal, share):
    """Return the weighted means (n+1, 2) of bottom and top, ``nodal`` (2(n+1), 2)."""
    line = np.empty((share.shape[0], 2))
    for k in range(share.shape[0]):
        for axis in range(2):
            line[k, axis] = (share[k, 0] * nodal[2 * k, axis]
                             + share[k, 1] * nodal[2 * k + 1, axis])
    return line


@checked_kernel
def to_nodes(force, share):
    """Return the nodal forces (2(n+1), 2) of forces on the mean line, the transpose."""
    nodal = np.empty((2 * share.shape[0], 2))
    for k in range(share.shape[0]):
        for axis in range(2):
            nodal[2 * k, axis] = share[k, 0] * force[k, axis]
            nodal[2 * k + 1, axis] = share[k, 1] * force[k, axis]
    return nodal


@checked_kernel
def straighten(line, inner, left, right):
    """Put the first and last ``inner`` stations on the lines of `straight_edges`, in place."""
    last = line.shape[0] - 1
    first = last - inner + 1
    for axis in range(2):
        start, start_end = line[0, axis], line[inner, axis]
        end, end_start = line[last, axis], line[last - inner, axis]
        for k in range(inner):
            line[k, axis] = left[k, 0] * start + left[k, 1] * start_end
            line[first + k, axis] = right[k, 0] * end + right[k, 1] * end_start


@checked_kernel
def gather(force, inner, left, right):
    """Move forces from the first and last ``inner`` stations, in place: the transpose."""
    last = force.shape[0] - 1
    first = last - inner + 1
    for axis in range(2):
        start, start_end, end, end_start = 0.0, 0.0, 0.0, 0.0
        for k in range(inner):
            start += left[k, 0] * force[k, axis]
            start_end += left[k, 1] * force[k, axis]
            end += right[k, 0] * force[first + k, axis]
            end_start += right[k, 1] * force[first + k, axis]
            force[k, axis], force[first + k, axis] = 0.0, 0.0
        force[0, axis] += start
        force[inner, axis] += start_end
        force[last, axis] += end
        force[last - inner, axis] += end_start

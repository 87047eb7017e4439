# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The mesh of a strip along the chord: lengths, masses, and its edges as the flow sees them."""

import numpy as np

from dewing_sim.structure.sheet import Sheet

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


def straight_edges(x: np.ndarray, layer: float) -> tuple[int, np.ndarray, np.ndarray]:
    """Return how many stations ``x`` (n+1,) lie within ``layer`` of an edge, with weights.

    The weights (k, 2) put these k stations at the left and at the right on straight lines between
    the edge and the first station beyond.
    """
    inner = max(1, min(int(np.searchsorted(x, layer)), x.size // 2))
    left, right = x[:inner] / x[inner], (x[-1] - x[-inner:]) / (x[-1] - x[-1 - inner])
    return inner, np.stack([1.0 - left, left], axis=1), np.stack([1.0 - right, right], axis=1)

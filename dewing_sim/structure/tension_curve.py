# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The tension over the stretch at one V^2: one curve for all elements of an elastic sheet."""

import math
from dataclasses import dataclass

import numpy as np

from dewing_sim.errors import Diverged
from dewing_sim.machine.kernels import kernel
from dewing_sim.structure.sheet import Sheet

LOWEST, HIGHEST = 0.98, 1.10    # of the prestretch
POINTS = np.cos(np.pi * (np.arange(10) + 0.5) / 10)     # Chebyshev's, of the range from -1 to 1
SMOOTH = 1.0e-9     # last divided difference, thousands of times the relative error
# Newton's polynomials prod_{k<j} (x_i - x_k) at the points turn differences into values.
_DIFFERENCES = np.linalg.inv(np.array([
    [np.prod(x - POINTS[:j]) for j in range(POINTS.size)] for x in POINTS]))


@dataclass(frozen=True, eq=False)
class TensionCurve:
    """A polynomial through Chebyshev points, exact to round-off.

    Its variable is (stretch - middle) / half; ``differences`` are Newton's, of `POINTS`.
    """

    middle: float
    half: float
    differences: np.ndarray

    @classmethod
    def of(cls, sheet: Sheet, prestretch: float, v_squared: float) -> 'TensionCurve | None':
        """Return the curve about ``prestretch``, None where no polynomial follows it closely."""
        middle = 0.5 * (HIGHEST + LOWEST) * prestretch
        half = 0.5 * (HIGHEST - LOWEST) * prestretch
        try:
            tension = sheet.respond(middle + half * POINTS, v_squared).tension
        except Diverged:
            return None
        differences = _DIFFERENCES @ tension
        if abs(differences[-1]) > SMOOTH * abs(differences[0]):
            return None
        return cls(middle, half, differences)

    def along(self, position: np.ndarray, stretch_per_length: np.ndarray,
              ) -> tuple[np.ndarray, float, bool]:
        """Return the tensions (n,) between nodes (n + 1, 2), the lowest, and whether all hold.

        They do not if a stretch is beyond the curve.
        """
        return along(position, stretch_per_length, self.middle, self.half, self.differences)


@kernel
def along(position, stretch_per_length, middle, half, differences):
    """Return what `TensionCurve.along` does."""
    n, last = stretch_per_length.size, differences.size - 1
    place, tension = np.empty(n), np.empty(n)
    for k in range(n):
        x, y = position[k + 1, 0] - position[k, 0], position[k + 1, 1] - position[k, 1]
        place[k] = (math.sqrt(x * x + y * y) * stretch_per_length[k] - middle) / half
        tension[k] = differences[last]
    for i in range(last - 1, -1, -1):
        for k in range(n):
            tension[k] = differences[i] + (place[k] - POINTS[i]) * tension[k]
    lowest, farthest = tension[0], 0.0
    for k in range(n):
        lowest, farthest = min(lowest, tension[k]), max(farthest, abs(place[k]))
    return tension, lowest, farthest <= 1.0

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The V^2 that a moving membrane bears in its present shape, so that no command slackens it.

At a given stretch the tension falls by eps/h per V^2, to zero at V_L^2 = V^2 + T h/eps (exact if
incompressible). V_L^2 rises with the stretch, so the least stretched element goes slack first. As
the shape changes within a step, a share of V_L^2 is kept back, which leaves that share of the
tension without voltage.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dewing_sim.errors import Diverged
from dewing_sim.machine.kernels import checked_kernel
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.tension_curve import HIGHEST, LOWEST, POINTS

SMOOTH = 1.0e-6     # of V_L^2: the last coefficient of a series that has converged


@dataclass(frozen=True, eq=False)
class Bearable:
    """The largest V^2 that leaves ``margin`` (0 to 1) of the tension of every element.

    A margin of zero bears everything: the step that slackens the membrane then fails.
    """

    structure: Moving
    margin: float

    def __call__(self, motion: Motion, v_squared: float) -> float:
        """Return it for the membrane that moves as ``motion`` under ``v_squared``."""
        if not self.margin:
            return math.inf
        lost = self._on_the_curve(motion) or self._by_element(motion, v_squared)
        return max((1.0 - self.margin) * lost, 0.0)

    def _by_element(self, motion: Motion, v_squared: float) -> float:
        present = self.structure.settled(motion).respond(motion.position, v_squared)
        permittivity = self.structure.sheet.elastomer.permittivity
        return v_squared + float(np.min(present.tension * present.thickness)) / permittivity

    def _on_the_curve(self, motion: Motion) -> float:
        """Return V_L^2 of an elastic membrane, zero where there is no curve for its stretch."""
        if self._curve is None:
            return 0.0
        return _lost(motion.position, self.structure.stretch_per_length, *self._curve)

    @cached_property
    def _curve(self) -> tuple[float, float, np.ndarray] | None:
        """V_L^2 over the stretch as a Chebyshev series: middle and half of its range, series."""
        structure = self.structure
        if not isinstance(structure, Membrane) or structure.viscosity is not None:
            return None
        middle, half = (0.5 * (HIGHEST + sign * LOWEST) * structure.prestretch
                        for sign in (1.0, -1.0))
        try:
            values = [structure.sheet.loss_of_tension_v_squared(middle + half * point)
                      for point in POINTS]
        except Diverged:
            return None
        series = np.polynomial.chebyshev.chebfit(POINTS, values, POINTS.size - 1)
        smooth = abs(series[-1]) < SMOOTH * abs(series[0]) and np.all(np.diff(values) < 0.0)
        return (middle, half, series) if smooth else None


@checked_kernel
def _lost(position, stretch_per_length, middle, half, series):
    """Return the Chebyshev series at the least stretch, zero if that is beyond its range."""
    least = np.inf
    for k in range(stretch_per_length.size):
        x, y = position[k + 1, 0] - position[k, 0], position[k + 1, 1] - position[k, 1]
        least = min(least, math.sqrt(x * x + y * y) * stretch_per_length[k])
    place = (least - middle) / half
    if not abs(place) <= 1.0:
        return 0.0
    one, two = 0.0, 0.0                             # Clenshaw's recurrence
    for k in range(series.size - 1, 0, -1):
        one, two = series[k] + 2.0 * place * one - two, one
    return series[0] + place * one - two

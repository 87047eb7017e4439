# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of time with their first two derivatives, as the equations of a flow need them."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Trajectory = Callable[[float], np.ndarray]      # time -> value, rate, acceleration (3, ...)


@dataclass(frozen=True)
class Course:
    """A shape in time between 0 and 1, or -1 and 1, starting at ``start`` over ``duration``."""

    shape: str
    start: float
    duration: float

    def __call__(self, time: float) -> np.ndarray:
        """Return value, rate and acceleration at ``time``.

        ramp: from 0 to 1 as 10 s^3 - 15 s^4 + 6 s^5, smooth in acceleration;
        one_minus_cosine: (1 - cos 2 pi s) / 2, back to 0 after ``duration``;
        sine: sin 2 pi s, faded in by the ramp over its first period.
        """
        s = (time - self.start) / self.duration
        if self.shape == 'none' or s <= 0.0:
            return np.zeros(3)
        return SHAPES[self.shape](s) / self.duration**np.arange(3)


@dataclass(frozen=True)
class Differentiated:
    """A function of time that a user gives, with central differences over ``step`` as rates.

    Value, rate and acceleration are in the units of ``function``, which may return an array.
    """

    function: Callable[[float], float | np.ndarray]
    step: float

    def __call__(self, time: float) -> np.ndarray:
        """Return value, rate and acceleration at ``time``, (3, ...)."""
        before, now, after = (np.asarray(self.function(time + shift), float)
                              for shift in (-self.step, 0.0, self.step))
        return np.stack([now, (after - before) / (2.0 * self.step),
                         (after - 2.0 * now + before) / self.step**2])


def _ramp(s: float) -> np.ndarray:
    if s >= 1.0:
        return np.array([1.0, 0.0, 0.0])
    return np.array([s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s))**2,
                     60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)])


def _one_minus_cosine(s: float) -> np.ndarray:
    if s >= 1.0:
        return np.zeros(3)
    angle, turn = 2.0 * math.pi * s, 2.0 * math.pi
    return 0.5 * np.array([1.0 - math.cos(angle), turn * math.sin(angle),
                           turn**2 * math.cos(angle)])


def _sine(s: float) -> np.ndarray:
    angle, turn = 2.0 * math.pi * s, 2.0 * math.pi
    value, rate, acceleration = (math.sin(angle), turn * math.cos(angle),
                                 -turn**2 * math.sin(angle))
    fade, fade_rate, fade_acceleration = _ramp(s)
    return np.array([fade * value, fade * rate + fade_rate * value,
                     fade * acceleration + 2.0 * fade_rate * rate + fade_acceleration * value])


SHAPES = {'ramp': _ramp, 'one_minus_cosine': _one_minus_cosine, 'sine': _sine}

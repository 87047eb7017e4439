# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gusts and rigid motion as functions of time, and the inflow that they make."""

import math
from dataclasses import dataclass

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.parameters import Gust, RigidMotion
from dewing_sim.scales import Scales

STRONGEST = 1.0         # gust or motion over free-stream speed


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


@dataclass(frozen=True)
class InflowSchedule:
    """A gust and a rigid motion, dimensionless; see `Gust` and `RigidMotion` for their meaning."""

    alpha: float
    gust: complex = 0.0                     # along the stream and upwards
    gust_course: Course = Course('none', 0.0, 1.0)
    heave: float = 0.0
    pitch: float = 0.0
    pivot: float = 0.0
    motion_course: Course = Course('none', 0.0, 1.0)

    @classmethod
    def of(cls, alpha: float, gust: Gust, motion: RigidMotion, scales: Scales) -> 'InflowSchedule':
        """Return what the sections say; raise `BadInput` for what outruns the free stream."""
        found = cls(alpha, complex(gust.horizontal, gust.vertical) / scales.speed,
                    _course(gust, scales), motion.heave / scales.length,
                    motion.pitch, motion.pivot, _course(motion, scales))
        for name, course, amplitude in (
                ('gust', found.gust_course, abs(found.gust)),
                ('rigid_motion', found.motion_course, 2.0 * math.pi * max(
                    abs(found.heave), abs(found.pitch)) / found.motion_course.duration)):
            if course.shape != 'none' and amplitude > STRONGEST:
                raise BadInput(f'{name}: it reaches {amplitude:.3g} free-stream speeds, '
                               f'at most {STRONGEST:g}')
        return found

    @property
    def is_steady(self) -> bool:
        """Whether nothing ever disturbs the stream."""
        return self.gust_course.shape == self.motion_course.shape == 'none'

    def at(self, time: float) -> Inflow:
        """Return the inflow at ``time`` (c/U)."""
        value, rate, _ = self.gust_course(time)
        course = self.motion_course(time)
        heave, pitch = self.heave * course, self.pitch * course
        incidence = self.alpha + pitch[0]
        axes = complex(math.cos(incidence), math.sin(incidence))
        return Inflow(stream=axes * (1.0 + self.gust * value - 1j * heave[1]),
                      stream_rate=axes * (self.gust * rate - 1j * heave[2]),
                      incidence=incidence, pitch_rate=pitch[1], pitch_acceleration=pitch[2],
                      pivot=self.pivot, pivot_acceleration=axes * 1j * heave[2])


def _course(section: Gust | RigidMotion, scales: Scales) -> Course:
    return Course(section.shape, section.start / scales.time, section.duration / scales.time)

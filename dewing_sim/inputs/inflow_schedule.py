# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gusts and rigid motion as functions of time, and the inflow that they make."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.trajectory import Course, Differentiated, Trajectory
from dewing_sim.parameters import Case, Gust, RigidMotion
from dewing_sim.scales import Scales
from dewing_sim.schema.numerals import apart

STRONGEST = 1.0         # gust or motion over free-stream speed
SHARP = 0.1             # of a time step, over which a user's function is differentiated


class Outside(NamedTuple):
    """A gust (2, 2), along the stream and upwards, and a motion (3, 2), heave and pitch.

    Each holds the values, their rates and, of the motion, the accelerations; dimensionless.
    """

    gust: np.ndarray
    motion: np.ndarray


@dataclass(frozen=True)
class InflowSchedule:
    """A gust and a rigid motion, dimensionless; see `Gust` and `RigidMotion` for their meaning.

    ``more_gust`` (along the stream and upwards) and ``more_motion`` (heave and pitch) are those
    of a user, each (3, 2), and add to the first.
    """

    alpha: float
    gust: complex = 0.0                     # along the stream and upwards
    gust_course: Course = Course('none', 0.0, 1.0)
    heave: float = 0.0
    pitch: float = 0.0
    pivot: float = 0.0
    motion_course: Course = Course('none', 0.0, 1.0)
    more_gust: Trajectory | None = None
    more_motion: Trajectory | None = None

    @classmethod
    def of(cls, case: Case, scales: Scales) -> 'InflowSchedule':
        """Return what ``case`` says; raise `BadInput` for what outruns the free stream."""
        gust, motion = case.gust, case.rigid_motion
        found = cls(case.flow.angle_of_attack,
                    complex(gust.horizontal, gust.vertical) / scales.speed,
                    _course(gust, scales), motion.heave / scales.length,
                    motion.pitch, motion.pivot, _course(motion, scales))
        for name, course, amplitude in (
                ('gust', found.gust_course, abs(found.gust)),
                ('rigid_motion', found.motion_course, 2.0 * math.pi * max(
                    abs(found.heave), abs(found.pitch)) / found.motion_course.duration)):
            if course.shape != 'none' and amplitude > STRONGEST:
                raise BadInput(f'{name}: it reaches {apart(amplitude, STRONGEST, 3)[0]} '
                               'free-stream speeds, '
                               f'at most {STRONGEST:g}')
        return found

    def joined_by(self, gust: Callable | None, motion: Callable | None, scales: Scales,
                  step: float) -> 'InflowSchedule':
        """Return the schedule with functions of time in SI added, see `wing.Wing`.

        Their rates are central differences over `SHARP` of ``step`` (s), the time step.
        """
        units = {'more_gust': (gust, np.full(2, scales.speed)),
                 'more_motion': (motion, np.array([scales.length, 1.0]))}
        step *= SHARP / scales.time
        return replace(self, **{
            name: Differentiated(_dimensionless(function, unit, scales.time), step)
            for name, (function, unit) in units.items() if function is not None})

    @cached_property
    def is_steady(self) -> bool:
        """Whether nothing ever disturbs the stream."""
        return (self.gust_course.shape == self.motion_course.shape == 'none'
                and self.more_gust is None and self.more_motion is None)

    def at(self, time: float, outside: Outside | None = None) -> Inflow:
        """Return the inflow at ``time`` (c/U), with what comes from ``outside`` added."""
        value, rate, _ = self.gust_course(time)
        course = self.motion_course(time)
        gust, gust_rate = self.gust * value, self.gust * rate
        heave, pitch = self.heave * course, self.pitch * course
        if self.more_gust is not None:
            more = self.more_gust(time)
            gust, gust_rate = gust + complex(*more[0]), gust_rate + complex(*more[1])
        if self.more_motion is not None:
            more = self.more_motion(time)
            heave, pitch = heave + more[:, 0], pitch + more[:, 1]
        if outside is not None:
            gust = gust + complex(*outside.gust[0])
            gust_rate = gust_rate + complex(*outside.gust[1])
            heave, pitch = heave + outside.motion[:, 0], pitch + outside.motion[:, 1]
        incidence = self.alpha + pitch[0]
        axes = complex(math.cos(incidence), math.sin(incidence))
        return Inflow(stream=axes * (1.0 + gust - 1j * heave[1]),
                      stream_rate=axes * (gust_rate - 1j * heave[2]),
                      incidence=incidence, pitch_rate=pitch[1], pitch_acceleration=pitch[2],
                      pivot=self.pivot, pivot_acceleration=axes * 1j * heave[2])


def _course(section: Gust | RigidMotion, scales: Scales) -> Course:
    return Course(section.shape, section.start / scales.time, section.duration / scales.time)


def _dimensionless(function: Callable, unit: np.ndarray, time_scale: float) -> Callable:
    return lambda time: np.asarray(function(time * time_scale), float) / unit

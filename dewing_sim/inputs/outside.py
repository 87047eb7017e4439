# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gust, wall pressure and rigid motion that come from outside while a wing flies, in SI units.

What was given last is held. A pressure acts as it is, since no rate of it does; gust and motion
are followed smoothly, see `following`, over a lag of at least two time steps: the rates are then
sampled finely enough that they add up to what the value changes by. A motion that comes with its
rates goes on at them for as long as passed between its last two messages, then is held too.
"""

import heapq
import math
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.following import STEEPEST, Following
from dewing_sim.inputs.inflow_schedule import STRONGEST

NAMES = {'gust': ('gust_along', 'gust_up'), 'pressure_disturbance': ('wall_pressure',),
         'motion': ('heave', 'pitch')}
UNITS = {'gust_along': 'm/s', 'gust_up': 'm/s', 'wall_pressure': 'Pa', 'heave': 'm',
         'pitch': 'rad'}
LARGEST_PRESSURE = 10.0     # in q
LARGEST = {'heave': 10.0, 'pitch': math.radians(30.0)}      # as in the section rigid_motion
QUEUED = 10_000             # messages that wait for their time
STEPS = 2                   # least time steps in a lag


class Open(Protocol):
    """A plant that may be disturbed: `wing.Wing`, or one from outside."""

    dt: float
    open_to: frozenset[str]     # of `NAMES`

    def meets(self, time: float, gust: np.ndarray, motion: np.ndarray) -> Inflow:
        """Return the inflow at ``time`` (s) with ``gust`` (2, 2) and ``motion`` (3, 2) added."""


class Given(NamedTuple):
    """What is to act from the step on that begins at ``stamp`` (ns), or later."""

    stamp: int
    number: int                 # of arrival
    kind: str
    value: tuple[float, ...]
    rate: tuple[float, ...]


class OutsideInputs:
    """What was given and is followed; `during` makes the inputs of the next step of it."""

    def __init__(self, plant: Any, speed: float, dynamic_pressure: float, chord: float,
                 lag: float):
        """Be ready for ``plant``, in a stream of ``speed`` (m/s), with ``lag`` in s."""
        self._plant, self.open_to = plant, frozenset(getattr(plant, 'open_to', ()))
        self._pressure, self.lag = dynamic_pressure, max(lag, STEPS * plant.dt)
        self._fastest = {'gust_along': STRONGEST * speed, 'gust_up': STRONGEST * speed,
                         'heave': STRONGEST * speed, 'pitch': STRONGEST * speed / chord}
        self.late = 0           # given for steps that had been made
        self._number = 0        # of all that was given
        self.restart()

    def restart(self) -> None:
        """Forget all that was given: a run begins undisturbed."""
        self._queue: list[Given] = []
        self.last = {kind: np.zeros(len(names)) for kind, names in NAMES.items()}
        self._since: dict[str, tuple[int, int]] = {}    # of the last, and from the one before
        self._pressure_now = 0.0
        self._following = {kind: Following.at_rest(self.lag, 2) for kind in ('gust', 'motion')}
        self.active: set[str] = set()

    def give(self, kind: str, stamp: int, now: int, value: Sequence[float],
             rate: Sequence[float] = ()) -> None:
        """Take what acts from the first step on that does not begin before ``stamp`` (ns).

        ``now`` is the stamp at which the next step begins; a ``stamp`` of zero means this step.
        Raises `BadInput` for what the plant cannot meet.
        """
        rate = tuple(rate) or (0.0,) * len(value)
        self._check(kind, value, rate)
        if len(self._queue) >= QUEUED:
            raise BadInput(f'{kind}: {QUEUED} messages wait for their time, no more are taken')
        self.late += 0 < stamp < now
        self.last[kind] = np.array(value, float)
        heapq.heappush(self._queue, Given(max(stamp, now), self._number, kind, tuple(value), rate))
        self._number += 1

    def _check(self, kind: str, value: Sequence[float], rate: Sequence[float]) -> None:
        if kind not in self.open_to:
            raise BadInput(f'{kind}: this plant takes '
                           + (f"only {', '.join(sorted(self.open_to))}" if self.open_to
                              else 'no input but V^2'))
        for k, name in enumerate(NAMES[kind]):
            unit = UNITS[name]
            if not (math.isfinite(value[k]) and math.isfinite(rate[k])):
                raise BadInput(f'{kind}: {name} = {value[k]} {unit} at {rate[k]} {unit}/s is not '
                               'finite')
            largest = self._largest(name)
            if abs(value[k]) > largest:
                raise BadInput(f'{kind}: {name} = {value[k]:g} {unit} is out of range, from '
                               f'{-largest:g} to {largest:g} {unit}')
        if kind == 'gust' and math.hypot(*value) > self._fastest['gust_up']:
            raise BadInput(f'gust: {math.hypot(*value):g} m/s is more than the free stream, '
                           f"{self._fastest['gust_up']:g} m/s")
        if kind == 'motion':
            self._check_speed(value, rate)

    def _largest(self, name: str) -> float:
        if name == 'wall_pressure':
            return LARGEST_PRESSURE * self._pressure
        return LARGEST.get(name, self._fastest.get(name, math.inf))

    def _check_speed(self, value: Sequence[float], rate: Sequence[float]) -> None:
        """Refuse a jump that would be followed, or a rate, faster than the free stream."""
        waiting = any(given.kind == 'motion' for given in self._queue)
        before = self.last['motion'] if waiting else self._following['motion'].target[0]
        for k, name in enumerate(NAMES['motion']):
            jump = abs(value[k] - before[k])
            speed, fastest = STEEPEST * jump / self.lag + abs(rate[k]), self._fastest[name]
            if speed > fastest:
                unit = UNITS[name]
                raise BadInput(
                    f'motion: {name} would move at {speed:.4g} {unit}/s, at most {fastest:.4g} '
                    f'{unit}/s: a jump of {jump:.4g} {unit} is followed within '
                    f'inputs.smoothing = {self.lag:g} s, so give it in smaller ones')

    def during(self, v_squared: float, begin: int, end: float) -> Inputs:
        """Return the inputs of the step that begins at the stamp ``begin`` and ends at ``end`` s.

        They are V^2 alone until something has been given.
        """
        while self._queue and self._queue[0].stamp <= begin:
            self._begin(heapq.heappop(self._queue), begin)
        if not self.active:
            return Inputs(v_squared)
        self._hold(begin)
        for kind, following in self._following.items():
            self._following[kind] = following.after(self._plant.dt)
        inflow = None
        if self.active - {'pressure_disturbance'}:
            inflow = self._plant.meets(end, self._following['gust'].now[:2],
                                       self._following['motion'].now)
        return Inputs(v_squared, self._pressure_now / self._pressure, inflow)

    def _begin(self, given: Given, now: int) -> None:
        kind = given.kind
        self.active.add(kind)
        if kind == 'pressure_disturbance':
            self._pressure_now = given.value[0]
            return
        before = self._since.get(kind)
        self._since[kind] = now, now - before[0] if before else 0
        self._following[kind] = self._following[kind].towards(
            np.array(given.value), np.array(given.rate))

    def _hold(self, now: int) -> None:
        """Hold values whose next message has not come."""
        for kind, (began, interval) in self._since.items():
            following = self._following[kind]
            if now - began >= interval and following.target[1].any():
                self._following[kind] = following.towards(
                    following.target[0], np.zeros_like(following.target[1]))

    @property
    def used(self) -> bool:
        """Whether anything was ever given."""
        return self._number > 0

    @property
    def acting(self) -> tuple[tuple[str, ...], list[float], list[float]]:
        """Names, values and rates of what acts now, of all that the plant is open to."""
        names, values, rates = [], [], []
        for kind in NAMES:
            if kind in self.open_to:
                value, rate, *_ = (self._following[kind].now.tolist() if kind in self._following
                                   else ([self._pressure_now], [0.0]))
                names, values, rates = names + [*NAMES[kind]], values + value, rates + rate
        return tuple(names), values, rates

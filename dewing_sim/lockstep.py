# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant stepped by commands that carry the stamp of the measurement they answer."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.outside import OutsideInputs
from dewing_sim.plant import Measurement, Outputs, Plant, measure
from dewing_sim.quantities import schema


def nanoseconds(time: float) -> int:
    """Return ``time`` (s) as the whole nanoseconds of a stamp."""
    return round(time * 1.0e9)


@dataclass
class LockStep:
    """The present state of a run and its counters; never steps on a command it refuses.

    Only what is measured is known after each step. The other `outputs` are observed when they are
    asked for; if they are not finite, the state before is the present one again.
    """

    plant: Plant
    state: Any
    v_squared_max: float
    outside: OutsideInputs | None = None    # what else acts on the plant
    measurement: Measurement = field(init=False)
    v_squared: float = field(init=False)    # in force
    steps: int = 0                          # made in this run
    stale: int = 0                          # commands with another stamp
    rejected: int = 0                       # unusable commands
    unanswered: int = 0                     # steps that could not wait for their command
    late: int = 0                           # commands that came after their step was made
    plant_seconds: float = 0.0              # wall time spent in the plant

    def __post_init__(self):
        """Observe the first state."""
        self.restart(self.state)

    def restart(self, state: Any):
        """Continue from ``state`` with the V^2 that led to it."""
        self.measurement = self._measure(state)
        self.state = self._before = state
        self._outputs: Outputs | None = None
        self.v_squared = self.measurement.v_squared
        if self.outside is not None:
            self.outside.restart()

    @property
    def outputs(self) -> Outputs:
        """All outputs of the present state; raises `Diverged` for numbers that are not finite."""
        if self._outputs is None:
            outputs = self.plant.observe(self.state)
            known = schema(type(outputs))
            before, present = self._before, self.state
            self.state = before         # unless all is well
            _check(*known.given(outputs, known.scalars), self.steps, before)
            self.state, self._outputs = present, outputs
        return self._outputs

    @property
    def time(self) -> float:
        """Simulated time in s."""
        return self.measurement.time

    @property
    def stamp(self) -> int:
        """Stamp of the present measurement in ns of simulated time."""
        return nanoseconds(self.measurement.time)

    def expects(self, stamp: int) -> bool:
        """Return whether ``stamp`` is that of the present measurement; count it if not."""
        if stamp == self.stamp:
            return True
        self.stale += 1
        return False

    def check(self, v_squared: float):
        """Raise `BadInput` unless ``v_squared`` is admissible."""
        if not 0.0 <= v_squared <= self.v_squared_max:
            raise BadInput(f'command v_squared = {v_squared} V^2 is out of range, '
                           f'from 0 to {self.v_squared_max:g} V^2')

    def advance(self, v_squared: float):
        """Make one step; on `RunFailed` the last good state stays in ``state``."""
        began = perf_counter()
        state = self.plant.step(self.state, self._inputs(v_squared))
        self.measurement = self._measure(state)
        self._before, self.state, self._outputs = self.state, state, None
        self.v_squared = v_squared
        self.steps += 1
        self.plant_seconds += perf_counter() - began

    def _inputs(self, v_squared: float) -> Inputs:
        if self.outside is None or not self.outside.used:
            return Inputs(v_squared)
        return self.outside.during(v_squared, self.stamp, self.outputs.time + self.plant.dt)

    def figures(self, wall: float) -> dict[str, float]:
        """Return counters and speeds of a run that has taken ``wall`` s."""
        made = max(self.steps, 1)
        return dict(
            simulated_time=self.time, v_squared=self.v_squared, steps=self.steps,
            stale=self.stale, rejected=self.rejected, unanswered=self.unanswered,
            late=self.late,
            clipped=getattr(self.state, 'clipped', 0),
            rtf=self.steps * self.plant.dt / wall if wall else 0.0,
            ms_per_step=1.0e3 * self.plant_seconds / made,
            overhead_ms_per_step=1.0e3 * max(wall - self.plant_seconds, 0.0) / made)

    def _measure(self, state: Any) -> Measurement:
        seen = measure(self.plant, state)
        if not math.isfinite(sum(seen)):
            _check(seen._fields, seen, self.steps + 1, self.state)
        return seen


def _check(names: Iterable[str], values: Iterable[float], step: int, last_good: Any):
    for name, value in zip(names, values):
        if not math.isfinite(value):
            raise Diverged(f'{name} = {value} after step {step}', last_good)


@dataclass
class Deadlines:
    """When steps are due, ``period`` s of wall time apart, and how many began too late.

    A step that begins more than a period after it was due is a miss; what follows is due a
    period after it, so that one delay counts once and is not made up for by a rush.
    """

    period: float
    missed: int = 0
    due: float = 0.0

    def start(self, now: float):
        """Let the first step be due a period after ``now``."""
        self.due = now + self.period

    def begin(self, now: float):
        """Note that the step that was due begins."""
        if now - self.due > self.period:
            self.missed += 1
            self.due = now
        self.due += self.period

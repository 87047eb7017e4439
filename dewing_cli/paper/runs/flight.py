# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A wing flown without feedback: passive, at another voltage, or with V^2 swinging."""

import functools
import math
from dataclasses import dataclass
from typing import Mapping

import numpy as np

from dewing_cli.paper.runs.quantities import shedding
from dewing_cli.paper.runs.result import Result, Tick
from dewing_cli.paper.runs.watched import TICK_STEPS
from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.fluid import engines
from dewing_sim.inputs.base import Inputs
from dewing_sim.parameters import Case
from dewing_sim.records.history import Recorder
from dewing_sim.scales import Scales
from dewing_sim.wing import Wing

KEPT = ('time', 'v_squared', 'cl', 'cd', 'camber_mean', 'camber_max', 'camber_max_position',
        'tension', 'shape_time', 'x', 'y')

COUPLED = 1.5                       # time of a coupled step over that of a rigid plate, expected


@functools.lru_cache(maxsize=64)
def case_of(text: str) -> Case:
    """Return the case of a YAML text."""
    return parameters.from_yaml(text)


def convective_time(case: Case) -> float:
    """Return c/U in s."""
    return Scales.of(case.flow, case.membrane.chord).time


def cost(case: Case, duration: float) -> float:
    """Return the expected milliseconds of the start and ``duration`` s of a coupled wing."""
    time = case.numerics.trim_time * convective_time(case) + duration
    preset = engines.find(case.numerics.engine).grids[case.numerics.grid]
    return COUPLED * preset.milliseconds * time / case.numerics.time_step


def trimmed(wing: Wing, tick: Tick, share: float):
    """Return the rest state; the march to it counts for ``share`` of the run."""
    return wing.rest(lambda done, total: tick(share * done / total))


@dataclass(frozen=True)
class Flight:
    """A wing from its rest state, sampled every ``sample`` s, its shape every ``frame`` s.

    V^2 = voltage^2 (1 + swing cos 2 pi f t), at rest that of the case; ``duration`` in c/U. f is
    in Hz, or in units of the shedding frequency of the flight ``lock``.
    """

    case: str                       # YAML
    duration: float
    sample: float = 2.0e-4
    frame: float = 4.0e-4
    voltage: float = 0.0
    swing: float = 0.0
    frequency: float = 0.0          # f
    lock: str = ''

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the runs whose results it takes."""
        return (self.lock,) if self.lock else ()

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        case = case_of(self.case)
        return cost(case, self.duration * convective_time(case))

    def v_squared(self, time: float, frequency: float) -> float:
        """Return V^2 at ``time`` s for f = ``frequency`` in Hz."""
        swing = self.swing * math.cos(2.0 * math.pi * frequency * time)
        return self.voltage**2 * (1.0 + swing)

    def hertz(self, inputs: Mapping[str, Result]) -> float:
        """Return f in Hz; raise `RunFailed` if the flight to lock to has no line."""
        if not self.lock:
            return self.frequency
        flown = inputs[self.lock]
        line = shedding(flown)
        if not line:
            raise RunFailed(f'the lift of {self.lock} has no line: no frequency to lock to')
        return self.frequency * line

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Fly; return scalars (samples,), shapes (frames, nodes) and the scales."""
        case = case_of(self.case)
        wing = Wing(case)
        steps = max(1, round(self.duration * wing.scales.time / wing.dt))
        every = max(1, round(self.sample / wing.dt))
        share = case.numerics.trim_time / (case.numerics.trim_time + self.duration)
        frequency = self.hertz(inputs)
        state = trimmed(wing, tick, share)
        recorder = Recorder(case, max(1, round(self.frame / (every * wing.dt))))
        recorder.add(wing.observe(state))
        for step in range(1, steps + 1):
            state = wing.step(state, Inputs(self.v_squared((step - 1) * wing.dt, frequency)))
            if step % every == 0:
                recorder.add(wing.observe(state))
            if step % TICK_STEPS == 0:
                tick(share + (1.0 - share) * step / steps)
        history = recorder.history()
        values = {
            'dt': wing.dt, 'sample': every * wing.dt, 'y_ref': wing.reference_deflection,
            'chord': wing.scales.length, 'convective_time': wing.scales.time,
            'frequency': frequency, 'engine': case.numerics.engine, 'grid': case.numerics.grid,
            'v_slack': math.sqrt(wing.v_squared_slack),
            'cells': int(wing.fluid.cells)}
        return Result(values, {name: np.asarray(getattr(history, name)) for name in KEPT})

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A parameter sweep: its points, and one point as a pure function of its inputs.

A point is the case with one value of each varied parameter, simulated from its rest state under
its constant `actuation.voltage`. Nothing here knows how points are distributed.
"""

import hashlib
import itertools
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Iterator, NamedTuple, Sequence

import numpy as np

from dewing_cli.run_metrics import mean_name
from dewing_sim import parameters
from dewing_sim.errors import BadInput, DewingError
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine import jobs
from dewing_sim.machine.fingerprint import fingerprint
from dewing_sim.machine.job import Failed, Job
from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema

MOST_POINTS = 100_000
MISSING, DONE, FAILED, LOST = range(4)      # LOST: neither a result nor a reason of our own
STATUS = ('missing', 'done', 'failed', 'lost')

METRICS = {
    **{mean_name(each.name): (each.unit, f'time average: {each.meaning}')
       for each in schema(Outputs).quantities
       if each.recorded and not (each.required or each.is_shape)},
    'cl_rms': ('-', 'standard deviation of the lift coefficient'),
    'cl_amplitude': ('-', 'half the range of the lift coefficient'),
    'strouhal': ('-', 'f c / U of the strongest line of the lift, missing if it is steady'),
    'y_star': ('-', 'mean largest deflection over q c^2 / (8 T0)'),
    'camber_amplitude': ('m', 'half the range of the chord average of the camber'),
    'electric_field_max': ('V/m', 'largest true field V/h along the chord and in time'),
    'seconds': ('s', 'wall time of the point, rest state included'),
}


class Axis(NamedTuple):
    """A varied parameter and its values, all of one type."""

    key: str
    values: tuple


class Point(NamedTuple):
    """One place of a sweep: indices along its axes, and the case there."""

    index: tuple[int, ...]
    case: Case


class Result(NamedTuple):
    """What became of a point: one of `STATUS`, the reason of a failure, some of `METRICS`."""

    status: int
    reason: str
    metrics: dict[str, float]


@dataclass(frozen=True)
class Sweep:
    """Every combination of the values of all axes; times in s, averages from ``skip`` on."""

    base: Case
    axes: tuple[Axis, ...]
    duration: float
    skip: float

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of values of each axis."""
        return tuple(len(axis.values) for axis in self.axes)

    @cached_property
    def points(self) -> list[Point]:
        """All points, the last axis fastest; raises `BadInput` for a value out of range."""
        keys = [axis.key for axis in self.axes]
        combinations = itertools.product(*(axis.values for axis in self.axes))
        return [Point(index, parameters.replace(self.base, dict(zip(keys, values))))
                for index, values in zip(np.ndindex(*self.shape), combinations)]

    def fingerprint(self, point: Point) -> str:
        """Return a hash of all that the result of ``point`` depends on, the code included."""
        inputs = parameters.to_yaml(point.case) + f'{self.duration!r} {self.skip!r}'
        code = fingerprint(__name__, *parameters.outside_modules(point.case))
        return hashlib.sha256((inputs + code).encode()).hexdigest()[:24]


def parse_axes(texts: Sequence[str]) -> tuple[Axis, ...]:
    """Return the axes of ``key=a,b,c`` texts; raise `BadInput` for anything ambiguous."""
    axes = tuple(map(_axis, texts))
    keys = [axis.key for axis in axes]
    for key in keys:
        if keys.count(key) > 1:
            raise BadInput(f'--vary {key} is given twice: name all its values at once')
    points = np.prod([len(axis.values) for axis in axes], dtype=float)
    if points > MOST_POINTS:
        raise BadInput(f'{points:.0f} points are out of range: from 1 to {MOST_POINTS}')
    return axes


def _axis(text: str) -> Axis:
    key, equals, listed = text.partition('=')
    if not equals:
        raise BadInput(f'--vary {parameters.shown(text)} is not of the form section.key=a,b,c')
    values = tuple(parameters.parse_assignment(f'{key}={value}')[1]
                   for value in listed.split(','))
    for value in values:
        if isinstance(value, (list, dict)):
            raise BadInput(f'--vary {key}: {parameters.shown(value)} is not one value')
        if values.count(value) > 1:
            raise BadInput(f'--vary {key}: {parameters.shown(value)} is given twice')
    return Axis(key.strip(), values)


def run_point(case: Case, duration: float, skip: float) -> Result:
    """Simulate one point; a failure on purpose of the solvers is a result with its reason."""
    try:
        return Result(DONE, '', _simulate(case, duration, skip))
    except DewingError as error:
        return Result(FAILED, f'{type(error).__name__}: {" ".join(str(error).split())}', {})


def run_points(sweep: Sweep, points: Sequence[Point], workers: jobs.Workers,
               ) -> Iterator[list[tuple[Point, Result]]]:
    """Yield the results of ``points`` as they come, all that are there at a time.

    A point whose process is killed, or that raises what no solver raises on purpose, is `LOST`.
    Raises `BadInput` if no scheduler answers.
    """
    planned = {point.index: Job(partial(run_point, point.case, sweep.duration, sweep.skip))
               for point in points}
    by_index = {point.index: point for point in points}
    for batch in jobs.run(planned, workers):
        yield [(by_index[index], Result(LOST, outcome.reason, {})
                if isinstance(outcome, Failed) else outcome) for index, outcome in batch]


def _simulate(case: Case, duration: float, skip: float) -> dict[str, float]:
    from dewing_cli.progress import Laps
    from dewing_sim.plant import rollout
    from dewing_sim.records.history import Recorder
    from dewing_sim.wing import Wing
    laps = Laps()
    wing = Wing(case)
    steps = round(duration / wing.dt)
    recorder = Recorder(every=steps)
    held = Inputs(case.actuation.voltage**2)
    for _, outputs in rollout(wing, wing.rest(), lambda _: held, steps):
        recorder.add(outputs)
    laps.add()
    history = recorder.history()
    metrics = _metrics(wing, history.since(skip))
    return metrics | {'electric_field_max': float(history.electric_field.max()),
                      'seconds': laps.total}


def _metrics(wing: Any, late: Any) -> dict[str, float]:
    """Return the metrics of the averaged part of a run; a steady wing has no Strouhal number."""
    from dewing_cli.run_metrics import averages
    from dewing_sim.records.spectrum import shedding_lines
    metrics = averages(late, wing.reference_deflection)
    metrics['cl_amplitude'] = 0.5 * float(np.ptp(late.cl))
    metrics['camber_amplitude'] = 0.5 * float(np.ptp(late.camber_mean))
    lines = shedding_lines(late.cl, wing.dt)
    return metrics | ({'strouhal': lines[0] * wing.scales.time} if lines else {})

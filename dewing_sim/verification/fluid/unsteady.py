# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A rigid plate that heaves and pitches, and one that meets a uniform gust."""

from dataclasses import dataclass
from typing import Any, Iterator

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.fluid.base import INFLOWS, Wall
from dewing_sim.fluid.plate import starting_circulation
from dewing_sim.inputs.inflow_schedule import Course, InflowSchedule
from dewing_sim.verification.closed_forms import TRIPLE_DECK, WAGNER, oscillating_plate
from dewing_sim.verification.fluid.rigid_flow import step_cost
from dewing_sim.verification.signals import limit
from dewing_sim.verification.study import Check, Study

AMPLITUDE = 0.02                # chords, radians, free-stream speeds: the response is linear
OMEGA = 1.0                     # U/c, a reduced frequency of 0.5
PIVOT = 0.25
REYNOLDS = (1000.0, 2500.0, 5000.0)
REFERENCE = 2500.0
PERIODS = 4
TIME_STEPS = {'fast': 0.01, 'standard': 0.005}      # c/U
RAMP = 0.2                      # c/U, of the gust that stands for a step
MOTIONS = {'heave': {'heave': AMPLITUDE}, 'pitch': {'pitch': AMPLITUDE, 'pivot': PIVOT},
           'gust': {'gust': 1j * AMPLITUDE}}
THEODORSEN = 'Theodorsen 1935, ideal flow'


@dataclass(frozen=True)
class UnsteadyRun:
    """A flat plate at ``alpha`` (deg) in a ``shape`` of `Course`; returns t* and Cl (2, steps).

    ``kind`` is one of `MOTIONS`, of the given amplitude unless ``pitch`` (deg) is.  The flow
    starts with the circulation of the angle ``start`` (deg).
    """

    engine: str
    grid: str
    kind: str
    shape: str
    length: float               # c/U, of the course
    duration: float             # c/U
    reynolds: float = REFERENCE
    alpha: float = 0.0
    pitch: float | None = None
    start: float = 0.0

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return step_cost(self.engine, self.grid) * self.duration / TIME_STEPS[self.grid]

    def __call__(self) -> np.ndarray:
        """March the flow."""
        return np.array(list(self._march())).T

    @property
    def inflow(self) -> str:
        """Which of `INFLOWS` the plate meets."""
        return 'gust' if self.kind == 'gust' else 'motion'

    def schedule(self) -> InflowSchedule:
        """Return gust and motion."""
        course = Course(self.shape, 0.0, self.length)
        amounts = dict(MOTIONS[self.kind])
        if self.pitch is not None:
            amounts['pitch'] = np.radians(self.pitch)
        name = f'{self.inflow}_course'
        return InflowSchedule(np.radians(self.alpha), **amounts, **{name: course})

    def _march(self) -> Iterator[tuple[float, float]]:
        steps = round(self.duration / TIME_STEPS[self.grid])
        dt, schedule = self.duration / steps, self.schedule()
        fluid = engines.make(self.engine, self.grid, self.reynolds, schedule.alpha, dt)
        wall = Wall.flat(fluid.columns)
        flow = fluid.rest(wall, starting_circulation(np.radians(self.start), 0.0))
        in_axes = self.inflow in fluid.inflows
        for step in range(1, steps + 1):
            if in_axes:
                prediction = fluid.predict(flow, wall, schedule.at(step * dt))
            else:
                wall = moving_plate(fluid.columns, schedule, step * dt)
                prediction = fluid.predict(flow, wall)
            flow = fluid.correct(prediction, wall.velocity)
            yield step * dt, fluid.loads(flow).cl


def moving_plate(columns: np.ndarray, schedule: InflowSchedule, time: float) -> Wall:
    """Return heave and pitch as a motion of the wall in a steady stream, for small angles."""
    heave, rise, _ = schedule.heave * schedule.motion_course(time)
    pitch, turn, _ = schedule.pitch * schedule.motion_course(time)
    arms = columns - schedule.pivot
    centres = 0.5 * (arms[1:] + arms[:-1])
    return Wall(heave - pitch * arms, rise - turn * centres,
                (rise - turn * arms[0], rise - turn * arms[-1]))


def oscillation(engine: str, grid: str, kind: str, reynolds: float) -> UnsteadyRun:
    """Return a few periods of a sine."""
    period = 2.0 * np.pi / OMEGA
    return UnsteadyRun(engine, grid, kind, 'sine', period, PERIODS * period, reynolds)


def runs(engine: str, quick: bool) -> dict[str, UnsteadyRun]:
    """Return oscillations, and on the engine that has them gusts and a lasting pitch."""
    taken = engines.find(engine).inflows
    kinds = ('heave', 'pitch', 'gust') if 'gust' in taken else ('heave', 'pitch')
    grid, numbers = ('fast', (REFERENCE,)) if quick else ('standard', REYNOLDS)
    found = {f'{kind} {reynolds:g}': oscillation(engine, grid, kind, reynolds)
             for kind in kinds for reynolds in numbers}
    if not taken >= INFLOWS:
        return found
    found |= {'pitched': UnsteadyRun(engine, grid, 'pitch', 'ramp', 2.0, 30.0, alpha=2.0,
                                     pitch=2.0, start=2.0),
              'inclined': UnsteadyRun(engine, grid, 'pitch', 'none', 1.0, 30.0, alpha=4.0,
                                      start=2.0)}
    if not quick:
        found |= {f'step {reynolds:g}': UnsteadyRun(
            engine, grid, 'gust', 'ramp', RAMP, 6.0, reynolds) for reynolds in REYNOLDS}
    return found


def response(history: np.ndarray) -> complex:
    """Return Cl over the amplitude in the last period: in phase with sin, and with cos."""
    time, cl = history[:, history[0] > history[0, -1] - 2.0 * np.pi / OMEGA]
    basis = np.column_stack([np.ones_like(time), np.sin(OMEGA * time), np.cos(OMEGA * time)])
    (_, sine, cosine), *_ = np.linalg.lstsq(basis, cl, rcond=None)
    return complex(sine, cosine) / AMPLITUDE


def checks(engine: str, results: dict[str, np.ndarray]) -> list[Check]:
    """Compare with ideal flow; judge its limit and what must be the same."""
    found = []
    for kind in MOTIONS:
        if f'{kind} {REFERENCE:g}' in results:
            found += _oscillation(engine, kind, results)
    if engines.find(engine).inflows >= INFLOWS:
        found += _equivalences(engine, results)
    if f'step {REFERENCE:g}' in results:
        found += _step(engine, results)
    return found


def _oscillation(engine: str, kind: str, results: dict[str, Any]) -> list[Check]:
    ideal = oscillating_plate(
        OMEGA, **{name: value / (1j if name == 'gust' else 1.0) / (
            1.0 if name == 'pivot' else AMPLITUDE) for name, value in MOTIONS[kind].items()})
    values = [response(results[f'{kind} {reynolds:g}']) for reynolds in REYNOLDS
              if f'{kind} {reynolds:g}' in results]
    ratio = response(results[f'{kind} {REFERENCE:g}']) / ideal
    name = f'{kind}, k = 0.5'
    found = [Check(f'{name}, Re 2500: amplitude of Cl over ideal flow', engine, abs(ratio), 1.0,
                   THEODORSEN),
             Check(f'{name}, Re 2500: phase of Cl to ideal flow, deg', engine,
                   float(np.degrees(np.angle(ratio))), 0.0, THEODORSEN, None, 1.0)]
    if len(values) > 1:
        parameter, values = np.array(REYNOLDS)**TRIPLE_DECK, np.array(values)
        best = complex(limit(parameter, values.real), limit(parameter, values.imag))
        found.append(Check(f'{name}, Re to infinity: distance of Cl from ideal flow, over its '
                           'amplitude', engine, abs(best - ideal) / abs(ideal), 0.0, THEODORSEN,
                           0.05, 1.0))
    return found


def _equivalences(engine: str, results: dict[str, Any]) -> list[Check]:
    heave = response(results[f'heave {REFERENCE:g}']) / (-1j * OMEGA)
    gust = response(results[f'gust {REFERENCE:g}'])
    return [Check('heave as the opposite of a gust: distance of Cl, over its amplitude', engine,
                  abs(heave - gust) / abs(gust), 0.0, 'relative velocity', 0.005, 1.0),
            Check('plate at 2 deg pitched by 2 deg, 30 c/U: Cl', engine,
                  float(results['pitched'][1, -1]), float(results['inclined'][1, -1]),
                  'plate at 4 deg', 0.005)]


def _step(engine: str, results: dict[str, Any]) -> list[Check]:
    parameter = np.array(REYNOLDS)**TRIPLE_DECK
    found = []
    for s, exact in WAGNER.items():
        values = [np.interp(0.5 * (s + RAMP), *results[f'step {reynolds:g}'])
                  / (2.0 * np.pi * AMPLITUDE) for reynolds in REYNOLDS]
        found.append(Check(f'step gust, Re to infinity: Cl / 2 pi w after {s:g} semichords',
                           engine, limit(parameter, np.array(values)), exact,
                           "Wagner's function: the gust meets the whole plate at once", 0.05))
    return found


STUDY = Study(
    'unsteady', 'Heave, pitch and gusts',
    'A flat plate heaves, pitches about the quarter chord or meets a gust that is uniform in '
    'space, at a reduced frequency of 0.5. The conformal engine computes all three in the axes of '
    'the chord; the finite-volume engine, which knows none of them, sees the first two as a '
    'motion of its wall. At Re = 2500 the viscous trailing edge takes lift away, as it does in '
    'steady flow; a parabola in Re^-3/8 through three Reynolds numbers leads to the limit. A gust '
    'that rises within 0.2 c/U stands for a step, whose middle starts the count of semichords.',
    runs, checks)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Metrics, figure and table of the demo, all from its two bags."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping

import numpy as np

from dewing_sim.errors import RunFailed
from dewing_sim.identity import Identity
from dewing_sim.parameters import Case
from dewing_sim.records import bag

MEASUREMENT = '/dewing/measurement'
OPEN, CLOSED, TARGET = '#0072B2', '#D55E00', '#555555'      # told apart by every eye


@dataclass(frozen=True)
class Run:
    """One recorded run: series by name, each (steps + 1,), and the simulator's last words."""

    identity: Identity
    series: dict[str, np.ndarray]
    status: dict[str, str]

    @classmethod
    def read(cls, path: Path) -> 'Run':
        """Read a bag; raise `BadInput` if it is none, `RunFailed` if it lacks the identity."""
        identity, status = None, {}
        for topic, _, message in bag.read(path):
            if topic == '/dewing/case':
                identity = Identity.from_yaml(message.data)
            elif topic == '/diagnostics':
                for item in message.status:
                    if item.name == '/dewing/simulator':
                        status = {value.key: value.value for value in item.values}
        if identity is None or not status:
            raise RunFailed(f'{path}: the recording lacks the case or the diagnostics')
        return cls(identity, bag.series(path, MEASUREMENT), status)

    @property
    def camber(self) -> np.ndarray:
        """Mean camber relative to the passive one, minus one."""
        return self.series['camber_mean'] / self.identity.passive('camber_mean') - 1.0

    @property
    def voltage(self) -> np.ndarray:
        """V in volt."""
        return np.sqrt(self.series['v_squared'])

    def late(self, frequency: float) -> np.ndarray:
        """Return which samples lie in the second half, in whole periods if there is one."""
        time = self.series['time']
        half = 0.5 * time[-1]
        periods = np.floor(half * frequency + 1.0e-9)
        length = periods / frequency if periods else half
        return time > time[-1] - length + 0.5 * self.identity.dt

    def lost(self, duration: float) -> int:
        """Return how many steps of ``duration`` (s) the bag does not have."""
        return round(duration / self.identity.dt) + 1 - len(self.series['time'])


def loop_metrics(run: Run, frequency: float) -> dict[str, float]:
    """Return camber and voltage over the late part of a run, and its wall time a step."""
    late = run.late(frequency)
    camber, voltage = run.camber[late], run.voltage[late]
    return dict(camber_mean=float(camber.mean()), camber_amplitude=0.5 * float(np.ptp(camber)),
                v_min=float(voltage.min()), v_max=float(voltage.max()),
                ms_per_step=float(run.status['ms_per_step']))


def saturation_share(run: Run, limit: float) -> float:
    """Return the share of all steps at V = 0 or at the voltage ``limit``."""
    voltage = run.voltage[1:]       # the first sample precedes every command
    return float(np.mean((voltage <= 0.0) | (voltage >= limit * (1.0 - 1.0e-9))))


def metrics(runs: Mapping[str, Run], case: Case, limit: float, duration: float,
            ) -> dict[str, Any]:
    """Return the metrics of open and closed loop; ``seconds`` is the caller's to add.

    ``limit`` is the controller's largest voltage. Camber is relative to the undisturbed passive
    camber; ``steps_lost`` counts measurements missing from the bags and commands that answered
    another step than the one in progress.
    """
    closed = runs['closed_loop']
    result = {name: loop_metrics(run, case.disturbance.frequency) for name, run in runs.items()}
    limit = min(limit, closed.identity.v_squared_max**0.5)
    result['closed_loop']['saturation_share'] = saturation_share(closed, limit)
    mismatched = sum(max(0, int(run.status['stale']) - int(run.status['resent']))
                     for run in runs.values())
    return result | dict(
        steps=sum(int(run.status['steps']) for run in runs.values()),
        steps_lost=mismatched + sum(run.lost(duration) for run in runs.values()),
        overhead_ms_per_step=float(closed.status['overhead_ms_per_step']))


def draw(runs: Mapping[str, Run], target: float, path: Path) -> None:
    """Draw camber, with its relative ``target``, and voltage against time into a PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    figure = Figure(figsize=(7.0, 5.0), layout='constrained')
    FigureCanvasAgg(figure)
    camber, voltage = figure.subplots(2, 1, sharex=True)
    for (name, run), colour in zip(runs.items(), (OPEN, CLOSED)):
        label = name.replace('_', ' ')
        camber.plot(run.series['time'], 100.0 * run.camber, color=colour, label=label)
        voltage.plot(run.series['time'], run.voltage, color=colour, label=label)
    camber.axhline(100.0 * target, color=TARGET, linestyle='--', linewidth=1.0, label='target')
    camber.set_ylabel('mean camber change (%)')
    voltage.set_ylabel('voltage (V)')
    voltage.set_xlabel('time (s)')
    camber.legend(ncols=3, loc='center right', bbox_to_anchor=(1.0, 0.72))
    for axes in (camber, voltage):
        axes.grid(alpha=0.3)
        axes.margins(x=0.0)
    figure.savefig(path, dpi=200)


def print_table(result: Mapping[str, Any]) -> None:
    """Print open and closed loop side by side on standard output."""
    rows = (('mean camber change', 'camber_mean', 100.0, '%'),
            ('camber oscillation, +-', 'camber_amplitude', 100.0, '%'),
            ('lowest voltage', 'v_min', 1.0, 'V'), ('highest voltage', 'v_max', 1.0, 'V'),
            ('wing, wall time a step', 'ms_per_step', 1.0, 'ms'))
    print(f"{'':26}{'open loop':>12}{'closed loop':>14}")
    for label, key, scale, unit in rows:
        values = [scale * result[name][key] for name in ('open_loop', 'closed_loop')]
        print(f'{label:26}{values[0]:12.3f}{values[1]:14.3f} {unit}')
    print(f"V saturated in {result['closed_loop']['saturation_share']:.1%} of the closed loop")
    print(f"{result['steps']} steps, {result['steps_lost']} lost, lock-step overhead "
          f"{result['overhead_ms_per_step']:.2f} ms a step, {result['seconds']:.0f} s in all")

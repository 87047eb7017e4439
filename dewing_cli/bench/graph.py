# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Laps of the closed loop: offline, with both nodes in one process, and in two over DDS.

A lap goes from the beginning of one step of the wing to that of the next. Its overhead is what
the lap takes beyond the wing's own step and measurement.
"""

import tempfile
from contextlib import ExitStack
from time import perf_counter
from typing import Any

import numpy as np

from dewing_cli.bench.timing import WARM_UP
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.parameters import Case

PATIENCE = 600.0            # s


class Watched:
    """A plant that notes when each step begins, and what step and measurement take."""

    def __init__(self, plant: Any):
        """Watch ``plant``."""
        self._plant = plant
        self.began: list[float] = []
        self.spent: list[float] = []

    def step(self, state: Any, inputs: Any) -> Any:
        """Step the plant."""
        began = perf_counter()
        self.began.append(began)
        state = self._plant.step(state, inputs)
        self.spent.append(perf_counter() - began)
        return state

    def measure(self, state: Any) -> Any:
        """Measure on the plant."""
        began = perf_counter()
        measured = self._plant.measure(state)
        if self.spent:
            self.spent[-1] += perf_counter() - began
        return measured

    def __getattr__(self, name: str) -> Any:
        return getattr(self._plant, name)

    def figures(self) -> dict[str, float]:
        """Return times per lap in ms, and the simulated over the wall time."""
        if len(self.began) < 2 * WARM_UP:
            raise RunFailed(f'{len(self.began)} laps were made, {2 * WARM_UP} are needed')
        laps = 1.0e3 * np.diff(self.began[WARM_UP:])
        spent = 1.0e3 * np.array(self.spent[WARM_UP:WARM_UP + laps.size])
        overhead = laps - spent
        return {'lap_ms_median': float(np.median(laps)),
                'plant_ms_median': float(np.median(spent)),
                'overhead_ms_median': float(np.median(overhead)),
                'overhead_ms_p99': float(np.percentile(overhead, 99.0)),
                'rtf': 1.0e3 * self._plant.dt / float(laps.mean()),
                'rtf_median': 1.0e3 * self._plant.dt / float(np.median(laps))}


def offline(case: Case, settings: ControllerSettings, steps: int) -> dict[str, float]:
    """Return the figures of the closed loop in this process, without ROS."""
    from dewing_control.trial.closed_loop import closed_loop, controller
    from dewing_sim.build import build_wing
    built = build_wing(case)
    plant = Watched(built.plant)
    for _ in closed_loop(plant, built.rest, controller(settings, built.identity), steps):
        pass
    return plant.figures()


def over_ros(case: Case, settings: ControllerSettings, steps: int, composed: bool,
             ) -> dict[str, float]:
    """Return the figures of simulator and controller in lock-step, in one process or in two."""
    from dewing_control.node import ControllerNode
    from dewing_sim.machine import signals
    from dewing_sim.ros import harness
    from dewing_sim.ros.node import SimulatorNode
    chosen = {name: value for name, value, _ in parameters.leaves(settings)}
    with ExitStack() as stack:
        domain = stack.enter_context(harness.reserved_domain())
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix='dewing-bench-'))
        if not composed:
            process = harness.start_node('dewing_control.node', chosen,
                                         harness.environment(domain, folder))
            stack.callback(signals.end, process)
        session = stack.enter_context(harness.Session(domain))
        simulator = session.add(SimulatorNode, {
            name: value for name, value, _ in parameters.leaves(case)} | {
            'run.duration': steps * case.numerics.time_step, 'run.subscribers': 1})
        simulator.lockstep.plant = plant = Watched(simulator.lockstep.plant)
        if composed:
            session.add(ControllerNode, chosen)
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    if simulator.exit_status:
        raise RunFailed(simulator.reason)
    return plant.figures()

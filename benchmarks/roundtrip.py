# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time of a lock-step over ROS 2: from one step of a linear plant to the next.

The plant takes some 10 us a step, which the figures include; the rest is the graph: measurement
out, controller, command back. In one process simulator and controller share an executor, in two
they talk over DDS, and with a recorder a third one writes everything to a bag.
"""

import argparse
import importlib.util
import json
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from dewing_sim.files import check_free
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model

WARM_UP = 200               # steps
CONFIGURATIONS = {'one_process': (), 'two_processes': ('dewing_control.node',),
                  'two_processes_and_recorder': ('dewing_control.node', 'dewing_sim.ros.recorder')}
PATIENCE = 1.0e5            # s


def oscillator() -> reduced.Reduced:
    """Return a damped oscillation of camber at 72 Hz, stepped by 0.1 ms."""
    pole = 0.998 * np.exp(2.0j * np.pi * 72.0e-4)
    A = np.array([[pole.real, -pole.imag], [pole.imag, pole.real]])
    return reduced.Reduced(Model(
        A, np.array([[0.0], [1.0e-10]]), np.array([[2.0e-5, 0.0], [3.0e-5, 0.0]]),
        np.zeros((2, 1)), 1.0e-4, ('camber_mean', 'camber_max'), np.array([2.6e-5, 4.0e-5]),
        1.69e6, v_squared_max=1.56e6))


class Timed:
    """A plant that notes when it steps, and says so to ``watch(step)``."""

    def __init__(self, plant: Any, times: np.ndarray, watch: Callable):
        """Note into ``times``."""
        self._plant, self._step = plant, plant.step
        self._times, self._watch, self._made = times, watch, 0

    def step(self, state: Any, inputs: Any) -> Any:
        """Return the next state."""
        self._times[self._made] = perf_counter()
        self._watch(self._made)
        self._made += 1
        return self._step(state, inputs)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._plant, name)


def run(children: tuple[str, ...], steps: int, watch: Callable | None = None) -> dict[str, Any]:
    """Run ``steps`` lock-steps with nodes in ``children`` processes; return times in ms.

    ``watch(step, processes)`` is called before every step.
    """
    from dewing_control.node import ControllerNode
    from dewing_sim.machine import signals
    from dewing_sim.ros import harness
    from dewing_sim.ros.node import SimulatorNode
    times, processes = np.full(steps, np.nan), []

    with ExitStack() as stack:
        domain = stack.enter_context(harness.reserved_domain())
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix='dewing-bench-')))
        reduced.save(folder / 'model.npz', oscillator())
        for module in children:
            settings = {'output': folder / 'run.mcap'} if 'recorder' in module else {}
            processes.append(harness.start_node(
                module, settings, harness.environment(domain, str(folder))))
            stack.callback(signals.end, processes[-1])
        session = stack.enter_context(harness.Session(domain))
        if not children:
            session.add(ControllerNode)
        simulator = session.add(SimulatorNode, {
            'run.plant': 'reduced', 'model': str(folder / 'model.npz'),
            'run.duration': 1.0e-4 * steps, 'run.subscribers': max(len(children), 1)})
        simulator.lockstep.plant = Timed(simulator.plant, times, lambda step: (
            watch and watch(step, processes)))
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    if simulator.exit_status:
        raise SystemExit(simulator.reason)
    return _figures(simulator.lockstep, 1.0e3 * np.diff(times[WARM_UP:]))


def _figures(lockstep: Any, laps: np.ndarray) -> dict[str, Any]:
    return {'steps': lockstep.steps, 'median_ms': float(np.median(laps)),
            'p99_ms': float(np.percentile(laps, 99)), 'mean_ms': float(laps.mean()),
            'plant_ms': 1.0e3 * lockstep.plant_seconds / lockstep.steps,
            'stale': lockstep.stale, 'rejected': lockstep.rejected}


def main() -> None:
    """Measure every configuration; print and write what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--steps', type=int, default=5000, help='lock-steps (default: 5000)')
    parser.add_argument('--json', metavar='FILE', help='write the figures as JSON')
    parser.add_argument('--force', action='store_true', help='write over an existing file')
    arguments = parser.parse_args()
    if arguments.json:
        check_free(arguments.json, arguments.force)
    if importlib.util.find_spec('rclpy') is None:
        print('no ROS in this environment: the lock-step is not timed')
        return
    found = {name: run(children, arguments.steps) for name, children in CONFIGURATIONS.items()}
    print(f"{'lock-step over ROS 2':30}{'median':>10}{'p99':>10}{'mean':>10}{'plant':>10}  ms")
    for name, row in found.items():
        print(f'{name:30}' + ''.join(f"{row[f'{key}_ms']:10.3f}"
                                     for key in ('median', 'p99', 'mean', 'plant')))
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(found, indent=2) + '\n', encoding='utf-8')


if __name__ == '__main__':
    sys.exit(main())

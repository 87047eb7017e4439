# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The wing for real time under its controller: two processes, as fast as they go together."""

from time import monotonic
from typing import Any

import numpy as np

from dewing_cli.demo.graph import SIMULATOR, graph
from dewing_cli.progress import bar
from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import controller
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.errors import RunFailed
from dewing_sim.inputs.disturbance import DISTURBANCES
from dewing_sim.machine.signals import Stop
from dewing_sim.parameters import Case
from dewing_sim.ros.onlooker import Onlooker

NAME = 'realtime'           # of the case and of the controller
SAMPLED = 100.0             # Hz, of the camber that is looked at
PATIENCE = 10.0             # s, for the last words of a simulator that has ended


def fly(duration: float, quiet: bool, stop: Stop) -> dict[str, Any]:
    """Return figures of ``duration`` s in lock-step under the disturbance of Fig. 5.

    ``rtf`` is the simulated over the wall time from the first step on. Cambers are relative to
    the passive one, over the last second, or half of the run if that is less.
    """
    changes = DISTURBANCES['fig5']
    settings = parameters.load(NAME, ControllerSettings)
    with bar('trim', quiet=quiet) as show:
        identity = build_wing(parameters.load(NAME, Case, changes), show).identity
    controller(settings, identity)
    with graph() as nodes:
        nodes.start('dewing_control.node',
                    {name: value for name, value, _ in parameters.leaves(settings)})
        simulator = nodes.start(SIMULATOR, {
            'case': NAME, **changes, 'run.duration': duration, 'run.mode': 'lockstep',
            'run.subscribers': 1, 'run.scalar_rate': SAMPLED})
        session = nodes.session()
        onlooker = session.add(Onlooker)
        with bar('real time', quiet=quiet) as show:
            nodes.wait(NAME, simulator, session, stop,
                       lambda: show(onlooker.time, duration, onlooker.time))
        until = monotonic() + PATIENCE
        while not (stop.asked or onlooker.time > duration - 0.5 * identity.dt
                   or monotonic() > until):
            session.executor.spin_once(timeout_sec=0.1)     # its last words, which it delivered
    return _figures(onlooker, identity.passive('camber_mean'), duration)


def _figures(onlooker: Onlooker, passive: float, duration: float) -> dict[str, Any]:
    late = round(SAMPLED * min(1.0, 0.5 * duration))
    camber = np.array(onlooker.camber[-late:] or [passive]) / passive - 1.0
    said = onlooker.said
    if 'rtf' not in said:
        raise RunFailed('real time: the simulator reached its end, but nothing that it reported '
                        'has arrived')
    return {'case': NAME, 'mode': 'lockstep', 'duration': onlooker.time,
            **{name: float(said[name]) for name in ('rtf', 'ms_per_step', 'overhead_ms_per_step')},
            **{name: int(said[name]) for name in ('steps', 'clipped')},
            'camber_mean': float(camber.mean()), 'camber_amplitude': 0.5 * float(np.ptp(camber))}


def sentence(figures: dict[str, Any]) -> str:
    """Say how fast the wing flew and how well it was held."""
    return (f"{figures['duration']:g} s of the case {figures['case']} in two processes: "
            f"{figures['rtf']:.2f} times as fast as time, {figures['ms_per_step']:.2f} ms a step "
            f"and {figures['overhead_ms_per_step']:.2f} ms beside it; mean camber change "
            f"{100.0 * figures['camber_mean']:.2f} +- "
            f"{100.0 * figures['camber_amplitude']:.2f} %")

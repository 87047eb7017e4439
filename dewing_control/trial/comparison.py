# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Run every controller on every scenario; controllers know the nominal wing only.

On a wing that differs from the nominal one a controller still measures the camber against the
passive one, which an operator can read off, but V_L^2, model and sampling time are nominal.
"""

import dataclasses
from dataclasses import dataclass
from functools import partial
from typing import Any, Iterator, Sequence

from dewing_control.law.registry import LAWS
from dewing_control.law.supervisor import Controller
from dewing_control.settings import ControllerSettings
from dewing_control.trial import closed_loop, trial
from dewing_control.trial.late import late
from dewing_control.trial.scenarios import SCENARIOS, Scenario
from dewing_control.tuning.printed import printed_gains
from dewing_sim import parameters
from dewing_sim.build import Built, build_wing
from dewing_sim.identity import Identity
from dewing_sim.inputs.disturbance import wall_pressure
from dewing_sim.machine.job import Failed, Job
from dewing_sim.machine.jobs import HERE, Workers
from dewing_sim.machine.jobs import results as results_of
from dewing_sim.parameters import Case
from dewing_sim.wing import Wing

KIND = {'pid_paper': 'pid', 'pid_tuned': 'pid'}     # the kinds of two gains; others name one
CONTROLLERS = ('open_loop', *KIND, *(kind for kind in LAWS if kind not in KIND.values()))


@dataclass(frozen=True)
class Plan:
    """What is compared: the nominal case, the controllers' settings and the times in s."""

    case: Case
    settings: ControllerSettings
    nominal: Identity
    duration: float
    skip: float


def build(case: Case, scenario: Scenario) -> Built:
    """Return the wing of ``scenario``, trimmed."""
    base = parameters.load(scenario.case) if scenario.case else case
    changed = parameters.replace(base, scenario.changes)
    built = build_wing(changed)
    if scenario.second is None:
        return built
    second = partial(wall_pressure, scenario.second)
    return dataclasses.replace(built, plant=Wing(changed, wall_pressure=second))


def controller(name: str, plan: Plan, scenario: Scenario, identity: Identity,
               ) -> Controller | None:
    """Return the supervised controller ``name`` for ``scenario``, None for the open loop."""
    if name == 'open_loop':
        return None
    changes = {
        'kind': KIND.get(name, name), 'reference.target': scenario.target,
        'reference.rate': scenario.rate, 'disturbance_model.frequency': scenario.told,
        'command.delay_steps': scenario.delay,
        'command.period_steps': max(1, round(
            plan.settings.command.period_steps * plan.nominal.dt / identity.dt))}
    if name == 'pid_paper':
        printed = printed_gains(plan.nominal)
        changes |= {f'pid.{gain}': value for gain, value in printed.items()}
        changes['pid.tracking_time'] = printed['kp'] / printed['ki']
    settings = plan.settings
    if scenario.settings:
        settings = dataclasses.replace(
            parameters.load(scenario.settings, ControllerSettings), model=settings.model)
    known = dataclasses.replace(identity, v_squared_slack=plan.nominal.v_squared_slack)
    made = closed_loop.controller(parameters.replace(settings, changes), known)
    return late(made, scenario.delay, scenario.jitter)


def run_scenario(plan: Plan, name: str, names: Sequence[str] = CONTROLLERS,
                 ) -> dict[str, tuple[dict[str, Any], trial.Trial]]:
    """Return figures and trial of each controller on the scenario ``name``."""
    scenario = SCENARIOS[name]
    built = build(plan.case, scenario)
    results: dict[str, Any] = {}
    for which in names:
        run = trial.run(built.plant, built.rest, controller(which, plan, scenario, built.identity),
                        round(plan.duration / built.plant.dt), scenario.noise,
                        passive=built.identity.passive('camber_mean'))
        figures = trial.figures(run, scenario.target, built.identity.v_squared_max, plan.skip)
        results[which] = figures, run
    for figures, _ in results.values():
        if 'open_loop' in results:
            figures['cl_gain'] = figures['cl_mean'] - results['open_loop'][0]['cl_mean']
    return results


def run_all(plan: Plan, scenarios: Sequence[str], names: Sequence[str],
            workers: Workers = HERE) -> Iterator[tuple[str, dict]]:
    """Yield scenario and results, in the order of ``scenarios``.

    A single process is this one, so that nothing disturbs the computing times.
    """
    if workers == HERE:
        for name in scenarios:
            yield name, run_scenario(plan, name, names)
        return
    there: dict[str, dict] = {}
    waiting = list(scenarios)
    jobs = {name: Job(partial(run_scenario, plan, name, names)) for name in scenarios}
    for finished, outcome in results_of(jobs, workers):
        if isinstance(outcome, Failed):
            raise outcome.error
        there[finished] = outcome
        while waiting and waiting[0] in there:
            yield waiting[0], there[waiting.pop(0)]

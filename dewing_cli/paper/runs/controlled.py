# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A wing under a controller, or under a disturbance alone: the loop in this process.

The loop in one process is, bit for bit, the one that simulator and controller close over ROS 2
as two processes; tests of both compare them.
"""

import dataclasses
import math
from dataclasses import dataclass
from typing import Mapping

from dewing_cli.paper.runs.designed import design_of, readings
from dewing_cli.paper.runs.flight import case_of, cost
from dewing_cli.paper.runs.result import Result, Tick
from dewing_cli.paper.runs.watched import TRIM_SHARE, Watched
from dewing_control.settings import ControllerSettings
from dewing_control.trial import trial
from dewing_control.trial.closed_loop import controller
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.identity import Identity
from dewing_sim.parameters import Case

KEPT = ('time', 'camber', 'v_squared', 'cl', 'cd', 'capacitance')


@dataclass(frozen=True)
class Controlled:
    """``duration`` s from the rest state under ``settings``, without them at the V^2 of rest.

    Averages are over the last ``averaged`` s. ``model`` names the run whose model a law is
    designed on, ``reading`` other gains, see `designed.readings`.
    """

    case: str                       # YAML
    settings: str                   # YAML, empty for the open loop
    duration: float
    averaged: float
    model: str = ''
    reading: str = ''

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the runs whose results it takes."""
        return (self.model,) if self.model else ()

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return cost(dataclasses.replace(case_of(self.case), numerics=dataclasses.replace(
            case_of(self.case).numerics, trim_time=0.0)), 1.2 * self.duration)

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Fly; return the series (n,) of a trial and its figures."""
        case = case_of(self.case)
        built = build_wing(case, lambda done, total: tick(TRIM_SHARE * done / total))
        identity = built.identity
        settings = self._settings(identity)
        model = design_of(inputs[self.model]) if self.model else None
        steps = round(self.duration / built.plant.dt)
        run = trial.run(Watched(built.plant, steps, tick), built.rest,
                        controller(settings, identity, model) if settings else None,
                        steps, passive=identity.passive('camber_mean'))
        target = settings.reference.target if settings else 1.0
        values = trial.figures(run, target, _limit(case, settings),
                               self.duration - self.averaged)
        values |= {'target': target, 'dt': run.dt, 'camber_reference': identity.camber_mean,
                   'v_slack': math.sqrt(identity.v_squared_slack), 'averaged': self.averaged}
        return Result(values, {name: getattr(run, name) for name in KEPT})

    def _settings(self, identity: Identity) -> ControllerSettings | None:
        if not self.settings:
            return None
        settings = parameters.from_yaml(self.settings, ControllerSettings)
        if self.reading:
            return parameters.replace(settings, readings(settings, identity)[self.reading])
        return settings


def _limit(case: Case, settings: ControllerSettings | None) -> float:
    limit = case.actuation.voltage_limit
    return min(limit, settings.command.voltage_limit)**2 if settings else limit**2

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A controller of your own: an integrator with its setting, taken by dewing as any other kind.

``dewing simulate --controller FILE`` flies it too, from this folder, with these lines in FILE:
``kind: own_controller:Integrator`` and ``integral: {gain: 10.0}``.
"""

from dataclasses import dataclass

from dewing_control.law.base import Law
from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.records.history import record

COARSE = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime'}


@dataclass(frozen=True)
class IntegralGain:
    """The settings of the law: a field with unit, meaning and range for each."""

    gain: float = parameters.real('1/s', 'V^2/V_L^2 per second and missing camber', 0.0, 1.0e4)


@dataclass(frozen=True)
class Integrator(Law):
    """V^2 grows at a rate proportional to the missing camber."""

    sections = {'integral': IntegralGain}

    step_gain: float            # V^2 per m of missing camber in a step
    target: float               # m
    largest: float              # V^2

    @classmethod
    def of(cls, settings, identity):
        """Return the law for the plant of ``identity``."""
        scale = identity.v_squared_slack / identity.camber_mean
        return cls(settings.integral.gain * identity.dt * scale,
                   settings.reference.target * identity.camber_mean, identity.v_squared_max)

    def start(self, v_squared=0.0):
        """Return the memory, the last V^2."""
        return v_squared

    def step(self, memory, measurement):
        """Return the next memory and V^2, never negative nor beyond the limit."""
        wanted = memory + self.step_gain * (self.target - measurement.camber_mean)
        v_squared = min(max(wanted, 0.0), self.largest)
        return v_squared, v_squared


if __name__ == '__main__':
    built = build_wing(parameters.load('paper', changes=COARSE))
    settings = parameters.load('controller', ControllerSettings, {
        'kind': 'own_controller:Integrator', 'integral.gain': 10.0, 'reference.target': 1.2})
    law = controller(settings, built.identity)
    loop = closed_loop(built.plant, built.rest, law, steps=4000)        # 0.4 s
    run = record(outputs for state, outputs in loop)
    passive, late = built.identity.camber_mean, run.since(0.3)
    print(f'camber {late.camber_mean.mean() / passive:.3f} of the passive one '
          f'at {late.voltage.mean():.0f} V')

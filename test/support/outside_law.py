# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A control law as a user writes it: the text of one file outside the package."""

KIND = 'my_integrator:Integrator'
INTEGRATOR = '''
from dataclasses import dataclass

import numpy as np

from dewing_control.law.base import Law
from dewing_sim.parameters import count, real
from dewing_sim.linear.state_space import Matrices


@dataclass(frozen=True)
class Gain:
    """What the integrator is told."""

    rate: float = real('1/s', 'V^2/V_L^2 per second and passive camber', 0.0, 1.0e6, default=9.0)
    delay: int = count('steps by which the error is old', 0, 9, default=0)


@dataclass(frozen=True)
class Integrator(Law):
    """V^2 grows at a rate proportional to the missing camber."""

    about = 'an integrator'
    sections = {'my_gain': Gain}
    memory = ('my_gain.delay',)
    ranges = {'my_gain.rate': (0.1, 100.0)}

    step_gain: float
    delay: int
    target: float
    camber: float
    v_squared_slack: float
    v_squared_max: float

    @classmethod
    def of(cls, settings, identity):
        own, reference = settings.my_gain, settings.reference
        period = settings.command.period_steps * identity.dt
        return cls(own.rate * period, own.delay, reference.target,
                   getattr(identity, reference.output), identity.v_squared_slack,
                   identity.v_squared_max)

    def start(self, v_squared=0.0):
        return v_squared, (0.0,) * self.delay

    def step(self, memory, measurement):
        v_squared, errors = memory
        errors = (self.target - measurement.camber_mean / self.camber, *errors)
        v_squared += self.step_gain * errors[-1] * self.v_squared_slack
        v_squared = min(max(v_squared, 0.0), self.v_squared_max)
        return (v_squared, errors[:-1]), v_squared

    def compensator(self):
        return Matrices.siso(np.eye(1), [self.step_gain], [1.0], self.step_gain)
'''

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""PID on the squared voltage (Buoso and Palacios, IFASD-2015-072, eq. 10).

With e = r - a/a_ref and u = V^2/V_L^2, for the sampling time T and filter time Tf,

    u_k = sat(s_k + d_k),                             0 <= u <= u_max
    s_k = s_{k-1} + kp (e_k - e_{k-1}) + T ki e_k     (backward Euler)
    d_k = (Tf d_{k-1} + kd (e_k - e_{k-1}))/(Tf + T)  (backward Euler)

after which back-calculation draws s towards the value at which u just saturates, with time
constant Tt: s_k += (1 - exp(-T/Tt)) (u_k - s_k - d_k). Proportional and integral part share s, so
that a change of gains makes no bump. The reference r leaves the first measured camber and
approaches the target at a limited rate.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from dewing_control.law.base import Law, Settings, ramp
from dewing_sim.identity import Identity
from dewing_sim.linear.state_space import Matrices
from dewing_sim.parameters import real
from dewing_sim.plant import Measurement


@dataclass(frozen=True)
class PidGains:
    """PID of a/a_ref to V^2/V_L^2 (paper eq. 10)."""

    kp: float = real('-', 'proportional gain', 0.0, 1.0e6)
    ki: float = real('1/s', 'integral gain', 0.0, 1.0e9)
    kd: float = real('s', 'derivative gain', 0.0, 1.0e6)
    derivative_filter: float = real(
        's', 'time constant of the derivative filter', 0.0, 1.0e3)
    tracking_time: float = real(
        's', 'time constant of the anti-windup back-calculation', 1.0e-9, 1.0e3)


class Memory(NamedTuple):
    """What the next step of a `Pid` depends on; normalised, None before the first step."""

    reference: float | None
    sum: float                      # s, proportional and integral part
    derivative: float
    error: float


@dataclass(frozen=True)
class Pid(Law):
    """PID from a camber in m to V^2 in V^2."""

    kind = 'pid'
    title = 'PID'
    about = ('paper eq. 10, backward Euler, filtered derivative, back-calculation at both bounds, '
             'bumpless change of gains')
    sections = {'pid': PidGains}
    ranges = {'pid.kp': (0.1, 30.0), 'pid.ki': (10.0, 1.0e5), 'pid.kd': (1.0e-3, 0.05),
              'pid.derivative_filter': (1.0e-5, 1.0e-3)}

    gains: PidGains
    output: str                     # name of the Measurement fed back
    target: float                   # of camber_reference
    rate: float                     # 1/s
    camber_reference: float         # a_ref in m
    v_squared_reference: float      # V_L^2
    v_squared_max: float
    dt: float                       # sampling time T in s

    @classmethod
    def of(cls, settings: Settings, identity: Identity) -> 'Pid':
        """Return the controller that ``settings`` describe for the plant of ``identity``."""
        reference, command = settings.reference, settings.command
        return cls(settings.pid, reference.output, reference.target, reference.rate,
                   identity.passive(reference.output), identity.v_squared_slack,
                   min(command.voltage_limit**2, identity.v_squared_max),
                   command.period_steps * identity.dt)

    @classmethod
    def dependent(cls, settings: Any) -> dict[str, float]:
        """Return the tracking time kp/ki, so that wind-up fades as fast as the integral acts."""
        gains = settings.pid
        return {'pid.tracking_time': max(gains.kp / gains.ki, 1.0e-9)} if gains.ki else {}

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory of a controller that takes over, without a bump, at ``v_squared``."""
        return Memory(None, v_squared / self.v_squared_reference, 0.0, 0.0)

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Return the next memory and V^2, which is never negative nor above the limit."""
        return self.step_with(memory, measurement, 0.0)

    def step_with(self, memory: Memory, measurement: Measurement, addition: float,
                  ) -> tuple[Memory, float]:
        """Return the same with ``addition`` (in V_L^2) added before the command saturates."""
        gains = self.gains
        camber = getattr(measurement, self.output) / self.camber_reference
        reference = ramp(memory.reference, camber, self.target, self.rate * self.dt)
        error = reference - camber
        change = error - memory.error
        derivative = (gains.derivative_filter * memory.derivative
                      + gains.kd * change) / (gains.derivative_filter + self.dt)
        total = memory.sum + gains.kp * change + self.dt * gains.ki * error
        wanted = (total + derivative + addition) * self.v_squared_reference
        v_squared = min(max(wanted, 0.0), self.v_squared_max)
        excess = (wanted - v_squared) / self.v_squared_reference
        total += math.expm1(-self.dt / gains.tracking_time) * excess
        return Memory(reference, total, derivative, error), v_squared

    def compensator(self) -> Matrices:
        """Return the law without saturation, from e to u, with the states s, d and e before."""
        gains = self.gains
        fading = gains.derivative_filter / (gains.derivative_filter + self.dt)
        slope = gains.kd / (gains.derivative_filter + self.dt)
        fresh = gains.kp + self.dt * gains.ki
        return Matrices.siso(
            np.array([[1.0, 0.0, -gains.kp], [0.0, fading, -slope], [0.0, 0.0, 0.0]]),
            np.array([fresh, slope, 1.0]), np.array([1.0, fading, -gains.kp - slope]),
            fresh + slope)

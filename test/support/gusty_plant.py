# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant from outside that meets gusts, motions and pressures, in one file and at no cost.

A spring-mounted plate: a'' + 2 d w a' + w^2 a = w^2 (a0 + g V^2 + p) + (upwash rate), Cl = 2 pi
times the incidence that it meets; semi-implicit Euler.
"""

import math
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.inflow import Inflow
from dewing_sim.plant import Outputs

REST, GAIN, STIFF, LOSS = 2.0e-5, 1.5e-11, 2.0 * math.pi * 72.0, 0.1    # m, m/V^2, 1/s, -
PRESSED = 1.0e-4                                                        # m per q


class State(NamedTuple):
    """Steps made, V^2 held, camber in m, its rate, and the incidence met in rad."""

    step: int
    v_squared: float
    camber: float
    rate: float
    incidence: float


class Plant:
    """Meets all that a wing can meet from outside."""

    v_squared_slack = 1300.0**2
    open_to = frozenset(['gust', 'motion', 'pressure_disturbance'])

    def __init__(self, case):
        self.dt, self.speed = case.numerics.time_step, case.flow.speed

    def rest(self):
        return State(0, 0.0, REST, 0.0, 0.0)

    def meets(self, time, gust, motion):
        upwash = (gust[:, 1] - motion[1:, 0]) / self.speed
        return Inflow(stream=complex(1.0 + gust[0, 0] / self.speed, upwash[0]),
                      stream_rate=1j * upwash[1], incidence=motion[0, 1])

    def step(self, state, inputs):
        inflow = inputs.inflow or Inflow.steady(0.0)
        target = REST + GAIN * inputs.v_squared + PRESSED * inputs.wall_pressure
        force = STIFF**2 * (target - state.camber) - 2.0 * LOSS * STIFF * state.rate
        rate = state.rate + self.dt * (force + 1.0e-3 * inflow.stream_rate.imag)
        incidence = inflow.incidence + float(np.angle(inflow.stream))
        return State(state.step + 1, inputs.v_squared, state.camber + self.dt * rate, rate,
                     incidence)

    def observe(self, state):
        return Outputs(time=state.step * self.dt, v_squared=state.v_squared,
                       camber_mean=state.camber, camber_max=1.5 * state.camber,
                       cl=2.0 * math.pi * state.incidence)

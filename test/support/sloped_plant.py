# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant from outside with outputs of its own, in one file, as a user would write it.

A parabolic membrane follows V^2 with a lag: a' = (a0 + g V^2 - a) / tau. Its own outputs are the
slope at the leading edge, which controllers see, the elastic energy, which is only recorded, and
the slope along the chord, a shape.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.plant import Outputs
from dewing_sim.quantities import output

REST, GAIN, LAG = 2.0e-5, 1.5e-11, 0.01     # m, m/V^2, s
NODES = np.linspace(0.0, 1.0, 9)            # x/c


@dataclass(frozen=True, kw_only=True)
class SlopedOutputs(Outputs):
    """The outputs of dewing and three more."""

    edge_slope: float | None = output('rad', 'slope at the leading edge', measured=True,
                                      topic='edge_slope')
    elastic_energy: float | None = output('J/m', 'elastic energy per unit span')
    slope: np.ndarray | None = output('rad', 'slope along the chord', kind=np.ndarray)


class State(NamedTuple):
    """Steps made, V^2 held and the largest camber in m."""

    step: int
    v_squared: float
    camber: float


class Plant:
    """Steps the lag exactly; it has no lift, drag, tension or flow."""

    v_squared_slack = 1300.0**2

    def __init__(self, case):
        self.dt, self.chord = case.numerics.time_step, case.membrane.chord

    def rest(self):
        return State(0, 0.0, REST)

    def step(self, state, inputs):
        target = REST + GAIN * inputs.v_squared
        camber = target + (state.camber - target) * np.exp(-self.dt / LAG)
        return State(state.step + 1, inputs.v_squared, float(camber))

    def observe(self, state):
        slope = 4.0 * state.camber / self.chord
        return SlopedOutputs(
            time=state.step * self.dt, v_squared=state.v_squared, camber_max=state.camber,
            camber_mean=2.0 / 3.0 * state.camber, edge_slope=slope,
            elastic_energy=1.0e-3 * slope**2, slope=slope * (1.0 - 2.0 * NODES),
            x=self.chord * NODES, y=4.0 * state.camber * NODES * (1.0 - NODES))

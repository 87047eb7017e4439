# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A wing-like linear plant with known poles: three membrane modes and two lags of circulation."""

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from dewing_sim import parameters
from dewing_sim.errors import Slack
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear.model import Model
from dewing_sim.plant import Outputs

FREQUENCIES = (72.0, 172.0, 272.0)      # Hz, the paper's wing in air
DAMPING = (0.08, 0.03, 0.02)
LAGS = (0.0455, 0.3)                    # of the Wagner function, in 2 U / c
SHARES = (0.165, 0.335)
CAMBER_GAIN = 1.56e-11                  # m / V^2
LIFT_GAIN = 5.4e-9                      # 1 / V^2


def matrices(dt: float, speed: float = 1.21725, chord: float = 0.030) -> tuple:
    """Return A, B, C of camber_mean, camber_max and cl, discretised with a zero-order hold."""
    a, b = np.zeros((8, 8)), np.zeros((8, 1))
    weights = np.array([1.0, 0.05, -0.1])
    for mode, (frequency, damping) in enumerate(zip(FREQUENCIES, DAMPING)):
        omega = 2.0 * np.pi * frequency
        a[2 * mode:2 * mode + 2, 2 * mode:2 * mode + 2] = \
            [[0.0, 1.0], [-omega**2, -2.0 * damping * omega]]
        b[2 * mode + 1] = omega**2 * weights[mode]
    camber = np.array([1.0, 0, 1.0, 0, 1.0, 0, 0, 0])
    for i, lag in enumerate(LAGS):
        rate = lag * 2.0 * speed / chord
        a[6 + i] = rate * camber
        a[6 + i, 6 + i] = -rate
    steps = linalg.expm(dt * np.block([[a, b], [np.zeros((1, 9))]]))
    lift = camber * (1.0 - sum(SHARES)) + np.array([0, 2e-4, 0, 1e-4, 0, 1e-4, *SHARES])
    crest = np.array([1.5, 0, -0.8, 0, 0.9, 0, 0, 0])
    c = np.vstack([CAMBER_GAIN * camber, CAMBER_GAIN * crest, LIFT_GAIN * lift])
    return steps[:8, :8], steps[:8, 8:], c


@dataclass(frozen=True)
class SyntheticPlant:
    """Deviations of the linear system added to a rest state; optionally slack or non-linear."""

    dt: float = 1.0e-4
    v_squared_slack: float = 1300.0**2      # V^2
    hardening: float = 0.0              # relative change of gain per V^2
    speed: float = 1.21725
    chord: float = 0.030

    def __post_init__(self):
        """Discretise once."""
        object.__setattr__(self, 'matrices', matrices(self.dt, self.speed, self.chord))

    def rest(self) -> tuple:
        """Return (steps made, V^2, modal state)."""
        return 0, 0.0, np.zeros(8)

    def step(self, state: tuple, inputs: Inputs) -> tuple:
        """Advance one dt."""
        v_squared = inputs.v_squared
        if v_squared > self.v_squared_slack:
            raise Slack('tension -0.1 N/m', state)
        number, _, x = state
        a, b, _ = self.matrices
        drive = v_squared * (1.0 + self.hardening * v_squared)
        return number + 1, v_squared, a @ x + b[:, 0] * drive

    def observe(self, state: tuple) -> Outputs:
        """Return camber and lift about those of the paper's wing."""
        number, v_squared, x = state
        mean, crest, lift = self.matrices[2] @ x
        return Outputs(time=number * self.dt, v_squared=v_squared, cl=0.395 + lift, cd=0.064,
                       cm=-0.1, camber_mean=1.8e-5 + mean, camber_max=2.7e-5 + crest,
                       camber_max_position=0.394, tension=1.2)


def save_model(path) -> None:
    """Write the plant as a linear model, for the reduced plant of a simulator node."""
    plant = SyntheticPlant()
    outputs = plant.observe(plant.rest())
    names = ('camber_mean', 'camber_max', 'cl')
    Model(*plant.matrices, np.zeros((3, 1)), plant.dt, names,
          np.array([getattr(outputs, name) for name in names]), plant.v_squared_slack,
          v_squared_max=1250.0**2, case_yaml=parameters.to_yaml(parameters.load('paper')),
          ).save(path)

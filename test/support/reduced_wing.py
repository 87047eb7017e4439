# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plausible linear wing for the tests of control and nodes: the paper's first mode in air."""

import numpy as np
from scipy import signal

from dewing_sim.linear.model import Model
from dewing_sim.linear.reduced import Reduced

SLACK = 1300.0**2           # V_L^2 of the case `paper`
CAMBER = 26.0e-6            # m, its passive mean camber


def first_mode(dt=1.0e-4, frequency=72.0, damping=0.08, disturbance=0.0) -> Reduced:
    """Return a damped mode with the static gain of physics.md section 5.

    ``disturbance`` is the amplitude of 1 - cos at 10 Hz, in passive cambers.
    """
    omega = 2.0 * np.pi * frequency
    gain = 1.56e-11 / CAMBER
    A = np.array([[0.0, 1.0], [-omega**2, -2.0 * damping * omega]])
    B = np.array([[0.0], [gain * omega**2]])
    C = np.array([[CAMBER, 0.0], [1.55 * CAMBER, 0.0], [5.4e-9 / gain, 0.0]])
    A, B, C, D, _ = signal.cont2discrete((A, B, C, np.zeros((3, 1))), dt)
    model = Model(A, B, C, D, dt, ('camber_mean', 'camber_max', 'cl'),
                  np.array([CAMBER, 1.55 * CAMBER, 0.3948]), SLACK, v_squared_max=1250.0**2)
    return Reduced(model,
                   disturbance=-disturbance * np.array([CAMBER, 1.55 * CAMBER, 0.0]),
                   disturbance_frequency=10.0)

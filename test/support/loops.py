# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A PID and a model with one mode, to check loops by hand."""

import numpy as np

from dewing_control.law.pid import Pid, PidGains
from dewing_control.model.design import Design


def pid(kp, ki, kd=0.0, derivative_filter=0.0, dt=1.0e-4):
    gains = PidGains(kp, ki, kd, derivative_filter, 1.0e-3)
    return Pid(gains, 'camber_mean', 1.1, 2.0, 1.0, 1.0, 1.0, dt)


def mode(frequency=72.0, damping=0.02, gain=1.0, dt=2.0e-6) -> Design:
    """Return one mode sampled so fast that it acts as in continuous time."""
    from scipy import linalg
    omega = 2.0 * np.pi * frequency
    step = linalg.expm(dt * np.array([[0.0, 1.0, 0.0], [-omega**2, -2.0 * damping * omega,
                                                        omega**2], [0.0, 0.0, 0.0]]))
    return Design.normalised(step[:2, :2], step[:2, 2], np.array([gain, 0.0]), dt, 0.0)

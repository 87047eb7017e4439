# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear wing like the one identified at 4 degrees, for the tests of control design.

Mean camber and the load of V^2 are collocated, so every mode adds with the same sign.
"""

import numpy as np
from scipy import linalg

from dewing_control.model.design import Design
from dewing_sim import parameters
from dewing_sim.identity import Identity
from dewing_sim.linear.model import Model
from dewing_sim.linear.reduced import Reduced

CAMBER = 1.8e-5                         # m, passive mean camber
SLACK = 1300.0**2                       # V_L^2
FREQUENCIES = (73.4, 171.3, 269.9)      # Hz
DAMPING = (0.027, 0.005, 0.0045)
COARSE = (0.024, 0.021, 0.085)          # the damping in steps of 5e-4 s, most of it numerical
SHARES = (0.985, 0.005, 0.01)           # of the static gain a/a_ref per V^2/V_L^2, which is one


def reduced_model(dt=1.0e-4, disturbance=0.0, frequency=10.0, stretch=1.0, damping=DAMPING,
                  ) -> Reduced:
    """Return the wing as a plant; ``disturbance`` in passive cambers, modes times ``stretch``."""
    a = np.zeros((7, 7))
    for mode, (hertz, ratio, share) in enumerate(zip(FREQUENCIES, damping, SHARES)):
        omega = 2.0 * np.pi * hertz * stretch
        a[2 * mode:2 * mode + 2, 2 * mode:2 * mode + 2] = [
            [0.0, 1.0], [-omega**2, -2.0 * ratio * omega]]
        a[2 * mode + 1, 6] = omega**2 * share
    steps = linalg.expm(dt * a)
    a, b = steps[:6, :6], steps[:6, 6]
    camber = np.array([1.0, 0.0, 1.0, 0.0, 1.0, 0.0])
    c = np.vstack([CAMBER * camber, 1.5 * CAMBER * camber, 0.3 * camber])
    model = Model(a, b[:, None] / SLACK, c, np.zeros((3, 1)), dt,
                  ('camber_mean', 'camber_max', 'cl'),
                  np.array([CAMBER, 1.5 * CAMBER, 0.395]), SLACK, v_squared_max=1250.0**2)
    return Reduced(model,
                   disturbance=-disturbance * np.array([CAMBER, 1.5 * CAMBER, 0.0]),
                   disturbance_frequency=frequency)


def design_model(steps=1) -> Design:
    """Return the normalised model of mean camber."""
    return Design.of(reduced_model().model, 'camber_mean', steps)


def identity() -> Identity:
    """Return who the wing says it is."""
    return Identity('reduced', 1.0e-4, CAMBER, 1.5 * CAMBER, SLACK, 1250.0**2,
                    parameters.to_mapping(parameters.load('paper')), 'test')

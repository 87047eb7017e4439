# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The gains printed in the paper, and how far those of a PI controller may go."""

import numpy as np

from dewing_control.model.design import Design
from dewing_sim.identity import Identity


def printed_gains(identity: Identity) -> dict[str, float]:
    """Return the paper's gains on eq. 10, read as V^2 per metre of camber, normalised.

    They act on the magnitude of the camber, so that the mirror image of a wing has the same.
    Ki = 2.3e15 V^2/s, Kp = 4.0e11 V^2 and Kd = 7.5e5 V^2 s; the paper prints no filter.
    """
    scale = abs(identity.passive('camber_mean')) / identity.v_squared_slack
    return {'kp': 4.0e11 * scale, 'ki': 2.3e15 * scale, 'kd': 7.5e5 * scale,
            'derivative_filter': 0.0}


def pi_limit(model: Design, kp: float) -> float:
    """Return the ki above which PI control of the main mode is unstable.

    ki G0 = 2 zeta w (1 + kp G0), from Routh's criterion; a derivative gain adds kd G0 w^2 to
    2 zeta w.
    """
    main = model.fundamental()
    rate = np.log(np.linalg.eigvals(main.a).astype(complex)[0]) / main.dt
    return float(-2.0 * rate.real * (1.0 + kp * main.static_gain) / main.static_gain)

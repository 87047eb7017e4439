# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The disturbance that control must reject."""

import math

from dewing_sim.parameters import Disturbance

# Fig. 5 of the paper agrees with reading its "3 % q" as the peak of P (1 - cos), P = 1.5 % q;
# taken as P itself, as printed, the response is twice as large.
DISTURBANCES = {
    'none': {'disturbance.pressure': 0.0},
    'fig5': {'disturbance.pressure': 0.015, 'disturbance.frequency': 10.0},
    'printed': {'disturbance.pressure': 0.03, 'disturbance.frequency': 10.0},
}


def wall_pressure(disturbance: Disturbance, time: float) -> float:
    """Return the uniform pressure jump on the membrane, as a fraction of q.

    -P (1 - cos 2 pi f t), paper eq. 11, for ``time`` in s: it presses the camber down and starts
    without a kick.  It acts on the structure only and is not counted as lift.
    """
    if time <= 0.0:
        return 0.0
    return -disturbance.pressure * (1.0 - math.cos(2.0 * math.pi * disturbance.frequency * time))

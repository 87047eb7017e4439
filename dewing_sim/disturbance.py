# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The disturbance that control must reject."""

import math

from dewing_sim.parameters import Disturbance


def wall_pressure(disturbance: Disturbance, time: float) -> float:
    """Return the uniform pressure jump on the membrane, as a fraction of q.

    -P (1 - cos 2 pi f t), paper eq. 11, for ``time`` in s: it presses the camber down and starts
    without a kick.  It acts on the structure only and is not counted as lift.
    """
    if time <= 0.0:
        return 0.0
    return -disturbance.pressure * (1.0 - math.cos(2.0 * math.pi * disturbance.frequency * time))

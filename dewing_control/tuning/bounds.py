# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a tuned loop has to respect."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Bounds:
    """What a loop has to respect, at the tension of rest and at a share ``tension`` of it."""

    sensitivity: float = 2.0        # Ms
    saturation: float = 0.01        # share of the time
    noise_gain: float = 100.0
    tension: float = 0.82           # 1 - V^2/V_L^2 at the peaks of Fig. 5

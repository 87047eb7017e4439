# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The answers of one controller to stamped measurements, one for each stamp.

A measurement without an answer is sent again after a while, under the same stamp; after a reset,
or in another run, stamps begin at an earlier one.
"""

from dataclasses import dataclass
from typing import Any

from dewing_control.law.supervisor import Controller
from dewing_sim.plant import Measurement


@dataclass
class Answers:
    """Steps ``controller`` once for each stamp, and begins anew with an earlier one."""

    controller: Controller
    memory: Any = None
    stamp: int = -1                     # ns, of the last measurement answered
    v_squared: float = 0.0              # the last answer
    begun: int = 0                      # times that the controller started
    made: int = 0                       # answers, repetitions not counted

    def to(self, stamp: int, measurement: Measurement) -> float:
        """Return V^2 for the ``measurement`` stamped ``stamp`` (ns).

        Whatever the controller raises leaves stamp and memory as they were, so that the
        measurement, sent again, is answered as if for the first time.
        """
        if stamp == self.stamp:
            return self.v_squared
        memory, begun = self.memory, self.begun
        if self.stamp < 0 or stamp < self.stamp:
            memory, begun = self.controller.start(measurement.v_squared), begun + 1
        self.memory, self.v_squared = self.controller.step(memory, measurement)
        self.stamp, self.begun, self.made = stamp, begun, self.made + 1
        return self.v_squared

    @property
    def figures(self) -> dict[str, float]:
        """Return V^2 and counters for the diagnostics."""
        return dict(v_squared=self.v_squared, answers=self.made, begun=self.begun)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The high-voltage amplifier between command and electrodes: limit, slew rate, first-order lag."""

import math
from dataclasses import dataclass

from dewing_sim.parameters import Actuation


@dataclass(frozen=True)
class Amplifier:
    """An amplifier that follows dV/dt = (V_command - V) / lag, no faster than ``slew_rate``.

    Without lag and slew rate it is ideal: it passes every command on as it is. Otherwise its
    output stays at or below ``limit`` (V).
    """

    limit: float
    slew_rate: float = 0.0          # V/s, 0: no limit
    lag: float = 0.0                # s

    @classmethod
    def of(cls, section: Actuation) -> 'Amplifier':
        """Return the amplifier of a parameter section."""
        return cls(section.voltage_limit, section.amplifier_slew_rate, section.amplifier_lag)

    def drive(self, v_squared: float, command: float, dt: float) -> float:
        """Return V^2 after ``dt`` from ``v_squared`` on, with V^2 = ``command`` demanded.

        The lag is solved exactly for a command held over ``dt``.
        """
        if not (self.slew_rate or self.lag):
            return command
        voltage = math.sqrt(v_squared)
        change = min(math.sqrt(command), self.limit) - voltage
        if self.lag:
            change *= -math.expm1(-dt / self.lag)
        if self.slew_rate:
            change = max(-self.slew_rate * dt, min(change, self.slew_rate * dt))
        return (voltage + change) ** 2

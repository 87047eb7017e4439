# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A held value made smooth: what a flow meets of a gust that arrives in messages.

A value that jumps would have an infinite rate, and a rate of the inflow acts on the wing as added
mass does. The value x therefore follows its target r through three equal lags T,

    (1 + T d/dt)^3 (x - r) = 0,     r(t) = r0 + r1 t,

so that value, rate and acceleration are continuous whatever the target does; x reaches 80 % of a
jump after 4.3 T and 99 % after 8.4 T, without overshoot. Between targets the solution is exact,

    x - r = (c0 + c1 t + c2 t^2) exp(-t/T).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

SETTLED = 40.0                      # lags after which a jump leaves nothing that a double shows
STEEPEST = 2.0 * math.exp(-2.0)     # largest rate after a jump from rest, in jumps over T


@dataclass(frozen=True, eq=False)
class Following:
    """Value, rate and acceleration (3, n) on the way to a target and its rate (2, n)."""

    lag: float                      # T in s
    now: np.ndarray
    target: np.ndarray
    age: float = 0.0                # s since the target was set

    @classmethod
    def at_rest(cls, lag: float, size: int) -> 'Following':
        """Return zero that stays zero."""
        return cls(lag, np.zeros((3, size)), np.zeros((2, size)))

    def towards(self, value: np.ndarray, rate: np.ndarray) -> 'Following':
        """Return the same with another target (n,) and its rate (n,)."""
        return Following(self.lag, self.now, np.stack([value, rate]))

    def after(self, time: float) -> 'Following':
        """Return value, rates and target ``time`` s later."""
        lag, age, (value, rate) = self.lag, self.age + time, self.target
        if age > SETTLED * lag:
            value = value + rate * time
            return replace(self, now=np.stack([value, rate, np.zeros_like(rate)]),
                           target=np.stack([value, rate]), age=age)
        error, slope, curve = self.now - np.stack([value, rate, np.zeros_like(rate)])
        first = slope + error / lag
        second = 0.5 * (curve + (2.0 * slope + error / lag) / lag)
        decay = math.exp(-time / lag)
        error = (error + (first + second * time) * time) * decay
        slope = (first + 2.0 * second * time) * decay - error / lag
        curve = 2.0 * second * decay - (2.0 * slope + error / lag) / lag
        value = value + rate * time
        return replace(self, now=np.stack([value + error, rate + slope, curve]),
                       target=np.stack([value, rate]), age=age)

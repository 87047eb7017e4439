# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of a structure as the BDF2 scheme remembers it."""

from dataclasses import dataclass, field

import numba
import numpy as np


@numba.njit(cache=True)
def _velocity(position, now, before, dt):
    """Return the BDF2 derivative (3 x - 4 x_n + x_n-1) / (2 dt)."""
    return (3.0 * position - 4.0 * now + before) / (2.0 * dt)


@dataclass(frozen=True, eq=False)
class Motion:
    """Positions and velocities (nodes, 2) of the present and the previous time level.

    ``memory`` is what a viscous structure remembers, empty at first.
    """

    position: np.ndarray
    velocity: np.ndarray
    position_before: np.ndarray
    velocity_before: np.ndarray
    memory: np.ndarray = field(default_factory=lambda: np.empty(0))

    @classmethod
    def at_rest(cls, position: np.ndarray) -> 'Motion':
        """Return a structure that has been resting at ``position``."""
        velocity = np.zeros_like(position)
        return cls(position, velocity, position, velocity)

    def predict(self, dt: float) -> np.ndarray:
        """Return the position one step ahead, extrapolated with an error of order dt^3."""
        return self.position + dt * (1.5 * self.velocity - 0.5 * self.velocity_before)

    def rate(self, position: np.ndarray, dt: float) -> np.ndarray:
        """Return the BDF2 velocity if ``position`` is reached one step ahead."""
        return _velocity(position, self.position, self.position_before, dt)

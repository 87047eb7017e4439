# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of a structure as the BDF2 scheme remembers it."""

from dataclasses import dataclass, field

import numpy as np

from dewing_sim.machine.kernels import checked_kernel


@checked_kernel
def combined(x, y, z, a, b, c, scale):
    """Return (a x + b y + c z) scale for arrays (nodes, 2)."""
    result = np.empty(x.shape)
    for i in range(x.shape[0]):
        for k in range(2):
            result[i, k] = (a * x[i, k] + b * y[i, k] + c * z[i, k]) * scale
    return result


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

    @property
    def history(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Positions now and before, velocities now and before, as kernels take them."""
        return (self.position, self.position_before, self.velocity, self.velocity_before)

    def predict(self, dt: float) -> np.ndarray:
        """Return the position one step ahead, extrapolated with an error of order dt^3."""
        return combined(self.position, self.velocity, self.velocity_before,
                        1.0, 1.5 * dt, -0.5 * dt, 1.0)

    def rate(self, position: np.ndarray, dt: float) -> np.ndarray:
        """Return the BDF2 velocity if ``position`` is reached one step ahead.

        (3 x - 4 x_n + x_n-1) / (2 dt).
        """
        return combined(position, self.position, self.position_before,
                        3.0, -4.0, 1.0, 0.5 / dt)

    def acceleration(self, velocity: np.ndarray, dt: float, damping: float = 0.0) -> np.ndarray:
        """Return a + ``damping`` w if ``velocity`` w is reached one step ahead.

        a = (3 w - 4 w_n + w_n-1) / (2 dt).
        """
        return combined(velocity, self.velocity, self.velocity_before,
                        3.0 + 2.0 * dt * damping, -4.0, 1.0, 0.5 / dt)

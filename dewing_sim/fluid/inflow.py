# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the wing meets at one instant: the free stream and its own rigid motion.

The flow is computed in axes fixed to the chord, x from the leading to the trailing edge.  They
move with the pivot, a point of the chord, and turn about it.  In a frame in translation the
equations stay those of a frame at rest, with the velocities relative to the pivot: a heave is the
opposite of a vertical gust.  What differs is a pressure gradient that accelerates the air or the
frame; on a membrane of no thickness it is the same on both sides.  Vorticity and velocities stay
absolute in rotation, so that no Coriolis term appears in the flow.  Vectors are complex, x + i y,
in those axes; angles are positive nose up; c = U = rho = 1.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Inflow:
    """The stream relative to the pivot and the motion of the axes."""

    stream: complex                         # velocity far away, relative to the pivot
    stream_rate: complex = 0.0              # its rate in axes that do not turn
    incidence: float = 0.0                  # of the chord to the undisturbed stream, rad
    pitch_rate: float = 0.0
    pitch_acceleration: float = 0.0
    pivot: float = 0.0                      # x/c
    pivot_acceleration: complex = 0.0

    @classmethod
    def steady(cls, alpha: float) -> 'Inflow':
        """Return the undisturbed stream at the angle of attack ``alpha`` (rad)."""
        return cls(stream=complex(np.exp(1j * alpha)), incidence=alpha)

    @property
    def is_turning(self) -> bool:
        """Whether rotation has any effect at this instant."""
        return self.pitch_rate != 0.0 or self.pitch_acceleration != 0.0

    @property
    def is_accelerated(self) -> bool:
        """Whether the axes are no inertial frame."""
        return self.is_turning or self.pivot_acceleration != 0.0

    def frame_acceleration(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the acceleration (nodes, 2) that the axes add to the motion within them.

        That of the pivot, Euler's, the centripetal and Coriolis's, with the angular velocity
        -``pitch_rate``.
        """
        arm = position[:, 0] - self.pivot + 1j * position[:, 1]
        within = velocity[:, 0] + 1j * velocity[:, 1]
        turn = -self.pitch_rate
        total = (self.pivot_acceleration - 1j * self.pitch_acceleration * arm - turn**2 * arm
                 + 2j * turn * within)
        return np.stack((total.real, total.imag), axis=1)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gusts, heave and pitch on the strip.

A uniform stream W = W_x + i W_y has the stream function 2 a sinh(eta) (W_x sin xi - W_y cos xi).
Turning with the angular velocity r about z_p moves the axes at i r (z - z_p), a flux with the
stream function -r |z - z_p|^2 / 2 through the grid, taken at the cell corners and so free of
divergence.  What the wall pressure needs is the normal part of the acceleration of the air that
stays at a point in space on the membrane: that of the wall relative to the accelerated stream;
no slip makes the centrifugal terms cancel, and Coriolis's leave -r (y y_t)_xi.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft

from dewing_sim.fluid.conformal.geometry import Surroundings
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.mapping import Map, Mapping
from dewing_sim.fluid.onset import Onset


@dataclass(frozen=True)
class Frame:
    """The axes of the chord at one instant, on one grid."""

    onset: Onset
    corner: np.ndarray              # (n,) stream function over 2 a sinh(eta) half a step on
    node: np.ndarray                # (n,) the same at the nodes
    grid: Grid
    mapping: Mapping

    @classmethod
    def of(cls, onset: Onset, grid: Grid, mapping: Mapping) -> 'Frame':
        """Return the frame of an onset flow."""
        speed, angle = abs(onset.stream), np.angle(onset.stream)
        return cls(onset, speed * np.sin(grid.xi + 0.5 * grid.step - angle),
                   speed * np.sin(grid.xi - angle), grid, mapping)

    @property
    def turn(self) -> float:
        """Angular velocity r, positive anticlockwise: nose down."""
        return -self.onset.pitch_rate

    def grid_stream(self, m: Map) -> np.ndarray:
        """Return the stream function (rows, n) of turning at the corners."""
        k = self.grid.wavenumbers[:-1]
        modes = m.shape * np.exp(-np.outer(self.grid.face, k) - 1j * k * self.grid.step)
        corner = self.grid.face[:, None] + 1j * (self.grid.xi + 0.5 * self.grid.step)
        arm = (2.0 * m.scale * np.cosh(corner) + fft.fft(modes, len(self.grid.xi), axis=1)
               - self.onset.pivot)
        return -0.5 * self.turn * np.abs(arm)**2

    def wall_fluxes(self, around: Surroundings, velocity: np.ndarray,
                    ) -> tuple[np.ndarray, np.ndarray]:
        """Return U and V (n,) of the membrane with column velocities within these axes."""
        u, v = around.wall_fluxes(velocity)
        if not self.turn:
            return u, v
        flux = 1j * self.turn * self._arm(around.map) * np.conj(around.slope)
        return u + flux.imag, v + flux.real

    def acceleration(self, around: Surroundings, velocity: np.ndarray) -> np.ndarray | float:
        """Return the normal acceleration (n,) that the axes and the stream add, times |z_zeta|.

        ``velocity`` (columns,) is that of the membrane within the axes.
        """
        onset = self.onset
        if onset.stream_rate == 0.0 and not onset.is_turning:
            return 0.0
        arm = self._arm(around.map)
        relative = -1j * onset.pitch_acceleration * arm - onset.stream_rate
        product = arm.imag * around.on_nodes(velocity)
        along = fft.irfft(1j * self.grid.wavenumbers * fft.rfft(product), len(product))
        return (relative * np.conj(around.slope)).real - self.turn * along

    def wall_speed(self, around: Surroundings, velocity: np.ndarray) -> np.ndarray:
        """Return the speed (n,) of the membrane relative to the pivot."""
        within = around.on_nodes(velocity)
        return np.abs(within + self.turn * self._arm(around.map)) if self.turn else within

    def _arm(self, m: Map) -> np.ndarray:
        """Return z - z_p (n,) on the membrane."""
        return self.mapping.wall(m)[0] - self.onset.pivot

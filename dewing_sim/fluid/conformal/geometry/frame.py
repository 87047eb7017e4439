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
from typing import NamedTuple

import numpy as np
from numpy import fft

from dewing_sim.fluid.conformal.geometry.mapping import Map
from dewing_sim.fluid.conformal.geometry.wall import WallGeometry, WallMotion
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.inflow import Inflow

STILL = np.empty((0, 0))


class Stream(NamedTuple):
    """The stream far away, over 2 a sinh(eta), and that of turning axes."""

    corner: np.ndarray              # (n,) half a step beyond the nodes
    node: np.ndarray                # (n,)
    turning: np.ndarray             # (n, rows) stream function at the corners, empty without


@dataclass(frozen=True)
class Frame:
    """The axes of the chord at one instant, on one grid."""

    inflow: Inflow
    corner: np.ndarray              # (n,) stream function over 2 a sinh(eta) half a step on
    node: np.ndarray                # (n,) the same at the nodes
    is_steady: bool                 # whether axes and stream keep their velocities
    grid: Grid

    @classmethod
    def of(cls, inflow: Inflow, grid: Grid) -> 'Frame':
        """Return the frame of an inflow."""
        speed, angle = abs(inflow.stream), np.angle(inflow.stream)
        return cls(inflow, speed * np.sin(grid.xi + 0.5 * grid.step - angle),
                   speed * np.sin(grid.xi - angle),
                   inflow.stream_rate == 0.0 and not inflow.is_turning, grid)

    @property
    def turn(self) -> float:
        """Angular velocity r, positive anticlockwise: nose down."""
        return -self.inflow.pitch_rate

    def stream(self, m: Map) -> Stream:
        """Return what advances the flow on a map."""
        return Stream(self.corner, self.node, self._turning(m) if self.turn else STILL)

    def _turning(self, m: Map) -> np.ndarray:
        corners = self.grid.xi + 0.5 * self.grid.step
        arm = m.places(self.grid.face, corners) - self.inflow.pivot
        return -0.5 * self.turn * np.abs(arm)**2

    def wall_motion(self, around: WallGeometry, velocity: np.ndarray, now: np.ndarray,
                    before: np.ndarray, dt: float) -> WallMotion:
        """Return the motion of the membrane that has these velocities (columns,) in the axes.

        ``now`` and ``before`` are those of the last two steps.
        """
        within = around.wall_motion(velocity, now, before, dt)
        if self.is_steady:
            return within
        inflow, turn = self.inflow, self.turn
        arm = around.line.place - inflow.pivot
        flux = 1j * turn * arm * np.conj(around.line.slope)
        product = arm.imag * within.speed
        coriolis = fft.irfft(1j * self.grid.wavenumbers * fft.rfft(product), len(product))
        relative = -1j * inflow.pitch_acceleration * arm - inflow.stream_rate
        return WallMotion(within.u + flux.imag, within.v + flux.real,
                          within.acceleration + (relative * np.conj(around.line.slope)).real
                          - turn * coriolis,
                          np.abs(within.speed + turn * arm))

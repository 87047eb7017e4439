# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Potential flow about a flat plate: the starting field and the far-field values.

An impulsive start approaches the steady lift as slowly as its starting vortex leaves.  Starting
with the bound circulation Gamma ~ Cl / 2 leaves almost nothing to shed.  By Kelvin's theorem the
circulation of wing and wake together never changes, so the same field is the right velocity on an
outer boundary that the wake has not reached: the far field errs by O(1/r^2) instead of O(1/r).
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.finite_volume.grid import Grid


@dataclass(frozen=True)
class Potential:
    """Fluxes per unit length of stream and of unit circulation on the faces of a grid."""

    stream_x: np.ndarray            # (nx + 1, ny) d psi / d eta of the unit stream
    stream_y: np.ndarray            # (nx, ny + 1) -d psi / d xi
    vortex_x: np.ndarray            # the same for unit (clockwise, lifting) circulation
    vortex_y: np.ndarray

    @classmethod
    def of(cls, grid: Grid, alpha: float) -> 'Potential':
        """Evaluate the complex potential on the corners of ``grid``; ``alpha`` in rad.

        With z - 1/2 = zeta + a^2 / zeta, a = 1/4 (Joukowski):
        F = exp(-i alpha) zeta + exp(i alpha) a^2 / zeta + (i Gamma / 2 pi) log(zeta / a).
        Differences of the stream function Im F are divergence-free to round-off and psi = 0 on
        the plate.
        """
        z = grid.x[:, None] - 0.5 + 1j * grid.y
        zeta = 0.5 * (z + np.sqrt(z - 0.5) * np.sqrt(z + 0.5))
        on_plate = np.zeros(z.shape, dtype=bool)
        on_plate[grid.leading:grid.trailing + 1, grid.middle] = True
        turn = np.exp(-1j * alpha)
        stream = np.where(on_plate, 0.0, np.imag(turn * zeta + np.conj(turn) / (16.0 * zeta)))
        vortex = np.where(on_plate, 0.0, np.log(4.0 * np.abs(zeta)) / (2.0 * np.pi))
        return cls(*_fluxes(grid, stream), *_fluxes(grid, vortex))

    def fluxes(self, circulation: float) -> tuple[np.ndarray, np.ndarray]:
        """Return Fx and Fy for a bound circulation (in U c)."""
        return (self.stream_x + circulation * self.vortex_x,
                self.stream_y + circulation * self.vortex_y)

    def outlet_pressure(self, circulation: float) -> np.ndarray:
        """Return Bernoulli's p (ny,) on the outlet, in rho U^2 and zero at infinity."""
        u = self.stream_x[-1] + circulation * self.vortex_x[-1]
        v = self.stream_y[-1] + circulation * self.vortex_y[-1]
        return 0.5 * (1.0 - u**2 - (0.5 * (v[1:] + v[:-1]))**2)


def _fluxes(grid: Grid, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.diff(psi, axis=1) / grid.dy, -np.diff(psi, axis=0) / grid.dx[:, None]

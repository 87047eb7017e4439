# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear loop of a compensator and the design model: stability, sensitivity and margins."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import trapezoid

from dewing_control.model.design import Design
from dewing_sim.state_space import Matrices, frequency_response


@dataclass(frozen=True, eq=False)
class Loop:
    """The loop L = G C at frequencies up to the Nyquist frequency."""

    frequency: np.ndarray           # Hz, (m,)
    plant: np.ndarray               # G, complex (m,)
    control: np.ndarray             # C, complex (m,)
    poles: np.ndarray               # of the closed loop

    @classmethod
    def of(cls, design: Design, compensator: Matrices) -> 'Loop':
        """Return the loop of ``compensator``, from the error r - a to w, around ``design``."""
        frequency, plant = design.spectrum
        return cls(frequency, plant, frequency_response(compensator, frequency, design.dt)[0],
                   np.linalg.eigvals(closed_matrix(design, compensator)))

    @property
    def stable(self) -> bool:
        """Return whether every pole of the closed loop lies inside the unit circle."""
        return bool(np.abs(self.poles).max() < 1.0)

    @property
    def gain(self) -> np.ndarray:
        """L, complex (m,)."""
        return self.plant * self.control

    @property
    def sensitivity(self) -> np.ndarray:
        """S = 1/(1 + L), complex (m,)."""
        return 1.0 / (1.0 + self.gain)

    @property
    def peak(self) -> float:
        """Ms = max |S|, whose inverse is the distance of L from -1."""
        return float(np.abs(self.sensitivity).max())

    @property
    def noise_gain(self) -> float:
        """Root mean square of C S: of V^2/V_L^2 for a unit white noise of the camber."""
        power = np.abs(self.control * self.sensitivity)**2
        return float(np.sqrt(trapezoid(power, self.frequency) / self.frequency[-1]))

    def gain_margin_db(self) -> float:
        """Return the least change of gain, up or down, that makes the loop unstable."""
        margins = np.abs(_crossings(self.gain, self.gain.imag, lambda point: point.real < 0.0))
        decibels = np.abs(20.0 * np.log10(margins[margins > 0.0]))
        return float(decibels.min()) if decibels.size else np.inf

    def phase_margin_deg(self) -> float:
        """Return the least phase shift, of either sign, that makes the loop unstable."""
        points = _crossings(self.gain, np.abs(self.gain) - 1.0, lambda point: True)
        margins = np.abs(np.degrees(np.angle(-points)))
        return float(margins.min()) if margins.size else 180.0


def sensitivity_at(design: Design, compensator: Matrices, frequency: float) -> complex:
    """Return S at one ``frequency`` (Hz), zero where the compensator resonates."""
    point = np.array([frequency * (1.0 + 1.0e-9)])      # beside its undamped poles
    gain = design.response(point) * frequency_response(compensator, point, design.dt)[0]
    return complex(1.0 / (1.0 + gain[0]))


def closed_matrix(design: Design, compensator: Matrices) -> np.ndarray:
    """Return the transition matrix of the loop's states (x, z) with r constant."""
    d, c = float(compensator.d[0, 0]), design.c
    return np.block([[design.a - d * np.outer(design.b, c), np.outer(design.b, compensator.c)],
                     [-np.outer(compensator.b, c), compensator.a]])


def _crossings(gain: np.ndarray, signal: np.ndarray, wanted) -> np.ndarray:
    """Return L, interpolated, where the real ``signal`` changes sign."""
    found = []
    for k in np.flatnonzero(signal[:-1] * signal[1:] < 0.0):
        share = signal[k] / (signal[k] - signal[k + 1])
        point = gain[k] + share * (gain[k + 1] - gain[k])
        if wanted(point):
            found.append(point)
    return np.array(found, dtype=complex)

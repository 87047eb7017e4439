# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear loop of a compensator and the design model: stability, sensitivity and margins.

Poles, responses and Ms are computed here, because a search judges thousands of loops and
`control.feedback` with the response of its result takes 8 ms for what takes 0.3 ms on bare
matrices (they agree to 1e-13). Margins of the loop that is reported come from python-control.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dewing_control.model.design import Design
from dewing_sim.linear.state_space import Matrices, frequency_response

if TYPE_CHECKING:
    from control import StateSpace


@dataclass(frozen=True, eq=False)
class Loop:
    """The loop L = G C of ``design`` and ``compensator`` at frequencies up to Nyquist's."""

    design: Design                  # G, from w to the camber
    compensator: Matrices           # C, from the error r - a to w

    @classmethod
    def of(cls, design: Design, compensator: 'Matrices | StateSpace') -> 'Loop':
        """Return the loop of ``compensator``, from the error r - a to w, around ``design``."""
        return cls(design, Matrices.of(compensator))

    @property
    def frequency(self) -> np.ndarray:
        """Frequencies in Hz, (m,), fine about the modes of the model."""
        return self.design.spectrum[0]

    @property
    def plant(self) -> np.ndarray:
        """G, complex (m,)."""
        return self.design.spectrum[1]

    @cached_property
    def control(self) -> np.ndarray:
        """C, complex (m,)."""
        return frequency_response(self.compensator, self.frequency, self.design.dt)[0]

    @cached_property
    def poles(self) -> np.ndarray:
        """Return the poles of the closed loop."""
        return np.linalg.eigvals(closed_matrix(self.design, self.compensator))

    @property
    def stable(self) -> bool:
        """Return whether every pole of the closed loop lies inside the unit circle."""
        return bool(np.abs(self.poles).max() < 1.0)

    @cached_property
    def gain(self) -> np.ndarray:
        """L, complex (m,)."""
        return self.plant * self.control

    @cached_property
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
        area = 0.5 * np.diff(self.frequency) * (power[1:] + power[:-1])
        return float(np.sqrt(area.sum() / self.frequency[-1]))

    def to_control(self) -> 'StateSpace':
        """Return L as a `control.StateSpace`, for Bode, Nyquist, feedback and step responses."""
        return self.design.to_control() * self.compensator.to_control(
            self.design.dt, inputs=['error'], outputs=['w'], name='compensator')

    @cached_property
    def margins(self) -> tuple[float, float]:
        """Gain margin in dB and phase margin in degrees of `control.stability_margins`.

        They are the least changes, up or down, that make the loop unstable; infinite and 180 where
        none does. They are read off the response: from the polynomials of a lightly damped model
        it finds 21 degrees for 45.
        """
        from control import FrequencyResponseData, stability_margins
        gain, phase = stability_margins(FrequencyResponseData(
            self.gain, 2.0 * np.pi * self.frequency, smooth=True))[:2]
        return (float(abs(20.0 * np.log10(gain))) if 0.0 < gain < np.inf else np.inf,
                float(min(abs(phase), 180.0)))

    @cached_property
    def delay_margin(self) -> float:
        """Delay in s, on top of that in the loop, that makes a stable loop unstable.

        The least phase over angular frequency of all points with |L| = 1; infinite without any.
        """
        size = np.log(np.abs(self.gain))
        at = np.flatnonzero(size[:-1] * size[1:] < 0.0)
        if not at.size:
            return np.inf
        share = size[at] / (size[at] - size[at + 1])
        turn = np.angle(self.gain[at + 1] / self.gain[at])
        phase = np.angle(self.gain[at]) + share * turn + np.pi      # to be lost until L = -1
        frequency = self.frequency[at] + share * np.diff(self.frequency)[at]
        return float(np.min(phase % (2.0 * np.pi) / (2.0 * np.pi * frequency)))

    @cached_property
    def disk_margins(self) -> tuple[float, float]:
        """Gain (dB) and phase (deg) that may change at once, of `control.disk_margins`."""
        from control import disk_margins
        below = np.pi / self.design.dt * (1.0 - 1.0e-12)       # a warning follows above Nyquist
        _, gain, phase = disk_margins(self.to_control(),
                                      np.minimum(2.0 * np.pi * self.frequency, below))
        return float(gain), float(phase)


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

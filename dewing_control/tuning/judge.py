# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How a law does on the identified model: robustness, rejection, saturation, noise.

All is of the linear loop, with the hold and the delay of the command that the settings state: the
error after a unit step of the camber (of its reference or by a disturbance), the sensitivity to
the disturbance of Fig. 5 and the share of the time in which that disturbance asks for a negative
V^2 at the target, and the noise gain, the root mean square of V^2/V_L^2 for a white noise of
a/a_ref of one. Ms = max |1/(1 + L)| is taken at the tension of rest and at a lower one, because
V^2 lowers the tension and with it every frequency.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dewing_control.law.registry import law, refusing
from dewing_control.model.design import Design
from dewing_control.model.loop import Loop, closed_matrix, sensitivity_at
from dewing_control.settings import ControllerSettings
from dewing_sim.identity import Identity
from dewing_sim.linear.state_space import Matrices

STEP_TIME = 0.05            # s
FREQUENCY = 10.0            # Hz, of the disturbance
LOAD = 0.05                 # a_ref, its amplitude
LARGEST_MARGIN = 100.0      # dB, stated for a loop that no gain makes unstable
LARGEST_DELAY = 1.0         # s, stated for a loop that no delay makes unstable
NEGLIGIBLE = 1.0e-4         # a_ref: smaller amplitudes are not worth having


@dataclass(frozen=True, eq=False)
class Judged:
    """A law on the model; an unstable one has infinite cost."""

    settings: ControllerSettings
    compensator: Matrices           # from the error to w
    loop: Loop                      # at rest
    strained: Loop                  # at the lower tension
    sensitivity: complex            # S at 10 Hz
    absolute_error: float           # IAE of the unit step in s
    saturation: float               # share of the time

    @property
    def stable(self) -> bool:
        """Return whether the loop is stable at both tensions."""
        return self.loop.stable and self.strained.stable

    @property
    def peak(self) -> float:
        """Ms, the larger of both tensions."""
        return max(self.loop.peak, self.strained.peak)

    @property
    def cost(self) -> float:
        """Return what tuning minimises."""
        return math.log(self.absolute_error) + math.log(
            LOAD * abs(self.sensitivity) + NEGLIGIBLE)

    def report(self) -> dict[str, Any]:
        """Return finite figures for a table or JSON."""
        if not self.stable:
            return {'stable': False, 'stable_at_rest': self.loop.stable,
                    'spectral_radius': float(np.abs(self.loop.poles).max())}

        def worst(margins: str, which: int) -> float:
            return min(*(getattr(loop, margins)[which] for loop in (self.loop, self.strained)),
                       LARGEST_MARGIN if which == 0 else 180.0)

        return {
            'stable': True, 'ms_peak': self.peak, 'ms_at_rest': self.loop.peak,
            'gain_margin_db': worst('margins', 0), 'phase_margin_deg': worst('margins', 1),
            'delay_margin_s': min(self.loop.delay_margin, self.strained.delay_margin,
                                  LARGEST_DELAY),
            'disk_gain_margin_db': worst('disk_margins', 0),
            'disk_phase_margin_deg': worst('disk_margins', 1),
            'disturbance_rejection_10hz': abs(self.sensitivity),
            'noise_gain': self.loop.noise_gain, 'step_iae_s': self.absolute_error,
            'saturation_share': self.saturation}


def judge(settings: ControllerSettings, identity: Identity, model: Design, strained: Design,
          ) -> Judged:
    """Return how the law of ``settings`` does on ``model`` and on it at a lower tension.

    Raises `BadInput` if it cannot be designed, or has no usable compensator.
    """
    with refusing(settings.kind):
        compensator = Matrices.of(law(settings, identity, model).compensator()).delayed(
            settings.command.delay_periods)
        sensitivity = sensitivity_at(model, compensator, FREQUENCY)
        loops = [Loop.of(plant, compensator) for plant in (model, strained)]
        error = step_error(model, compensator) if loops[0].stable else np.array([math.inf])
    return Judged(settings, compensator, *loops, sensitivity,
                  float(np.abs(error).sum() * model.dt),
                  _saturation(model, sensitivity, settings.reference.target - 1.0))


def step_error(model: Design, compensator: Matrices) -> np.ndarray:
    """Return the error after a unit step of the camber or of its reference.

    `control.step_response` of the same loop agrees to 1e-14 and takes 2.5 times as long.
    """
    transition = closed_matrix(model, compensator)
    inlet = np.concatenate([model.b * compensator.d[0, 0], compensator.b[:, 0]])
    state, error = np.zeros(inlet.size), np.empty(round(STEP_TIME / model.dt))
    for k in range(error.size):
        error[k] = 1.0 - model.c @ state[:model.order]
        state = transition @ state + inlet
    return error


def _saturation(model: Design, sensitivity: complex, rise: float) -> float:
    """Return the share of the period in which w would be negative under the disturbance.

    The command w = u0 + (rise + LOAD)/G0 + amplitude cos(2 pi f t).
    """
    mean = model.operating_input + (rise + LOAD) / model.static_gain
    amplitude = LOAD * abs((1.0 - sensitivity) / model.response(np.array([FREQUENCY]))[0])
    return math.acos(min(max(mean / amplitude, -1.0), 1.0)) / math.pi

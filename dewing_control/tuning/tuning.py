# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Tune a control law on the identified model, within bounds of robustness and saturation.

Minimised is  log IAE + log amplitude, where IAE integrates the error after a unit step of the
camber (of its reference or by a disturbance) and the amplitude is that of the error under the
disturbance of Fig. 5, both in the linear loop, whose only delay is the one sampling time of the
hold. The bounds are Ms = max |1/(1 + L)|, the share of the time in which that disturbance asks
for a negative V^2 at the target, and the noise gain, the root mean square of V^2/V_L^2 for a
white noise of a/a_ref of one. Ms holds at the tension of rest and at a lower one, because V^2
lowers the tension and with it every frequency.
"""

import functools
import itertools
import math
from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np

from dewing_control.law.registry import law
from dewing_control.model.design import Design
from dewing_control.model.loop import Compensator, Loop, closed_matrix, sensitivity_at
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.identity import Identity

STEP_TIME = 0.05            # s
FREQUENCY = 10.0            # Hz, of the disturbance
LOAD = 0.05                 # a_ref, its amplitude
LARGEST_MARGIN = 100.0      # dB, stated for a loop that no gain makes unstable
NEGLIGIBLE = 1.0e-4         # a_ref: smaller amplitudes are not worth having
RANGES = {
    'pid': {'pid.kp': (0.1, 30.0), 'pid.ki': (10.0, 1.0e5), 'pid.kd': (1.0e-3, 0.05),
            'pid.derivative_filter': (1.0e-5, 1.0e-3)},
    'periodic': {'periodic.learning_rate': (1.0, 200.0)},
    'lqg': {'lqg.control_weight': (3.0e-3, 3.0), 'estimator.load_noise': (1.0e-2, 1.0),
            'estimator.drift': (1.0e-4, 0.1)},
}
RANGES['mpc'] = RANGES['lqg']


@dataclass(frozen=True)
class Bounds:
    """What a loop has to respect, at the tension of rest and at a share ``tension`` of it."""

    sensitivity: float = 2.0        # Ms
    saturation: float = 0.01        # share of the time
    noise_gain: float = 100.0
    tension: float = 0.82           # 1 - V^2/V_L^2 at the peaks of Fig. 5


@dataclass(frozen=True, eq=False)
class Judged:
    """A law on the model; an unstable one has infinite cost."""

    settings: ControllerSettings
    compensator: Compensator
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
        return {
            'stable': True, 'ms_peak': self.peak, 'ms_at_rest': self.loop.peak,
            'gain_margin_db': min(self.loop.gain_margin_db(), self.strained.gain_margin_db(),
                                  LARGEST_MARGIN),
            'phase_margin_deg': min(self.loop.phase_margin_deg(),
                                    self.strained.phase_margin_deg()),
            'disturbance_rejection_10hz': abs(self.sensitivity),
            'noise_gain': self.loop.noise_gain, 'step_iae_s': self.absolute_error,
            'saturation_share': self.saturation}


def judge(settings: ControllerSettings, identity: Identity, model: Design, strained: Design,
          ) -> Judged:
    """Return how the law of ``settings`` does on ``model`` and on it at a lower tension."""
    compensator = law(settings, identity, model).compensator()
    sensitivity = sensitivity_at(model, compensator, FREQUENCY)
    loops = [Loop.of(plant, compensator) for plant in (model, strained)]
    error = step_error(model, compensator) if loops[0].stable else np.array([math.inf])
    return Judged(settings, compensator, *loops, sensitivity,
                  float(np.abs(error).sum() * model.dt),
                  _saturation(model, sensitivity, settings.reference.target - 1.0))


def step_error(model: Design, compensator: Compensator) -> np.ndarray:
    """Return the error after a unit step of the camber or of its reference."""
    transition = closed_matrix(model, compensator)
    inlet = np.concatenate([model.b * compensator.d, compensator.b])
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


def tune(settings: ControllerSettings, identity: Identity, model: Design, bounds: Bounds,
         seed: int = 1, generations: int = 25, progress=lambda done, total: None) -> Judged:
    """Return the best law of ``settings.kind`` within ``bounds``.

    Differential evolution (Storn and Price 1997, doi:10.1023/A:1008202821328) over the logarithms
    of `RANGES`, from a fixed seed. Raises `RunFailed` if no candidate meets the bounds.
    """
    from scipy.optimize import differential_evolution
    ranges, strained = RANGES[settings.kind], model.at_tension(bounds.tension)
    generation = itertools.count(1)

    def candidate(logarithms) -> Judged:
        changes = dict(zip(ranges, map(float, np.exp(logarithms))))
        return judge(with_gains(settings, changes), identity, model, strained)

    first = np.log([np.clip(value_of(settings, name), *limits)
                    for name, limits in ranges.items()])
    result = differential_evolution(
        lambda logarithms: _penalised(candidate(logarithms), bounds),
        [tuple(map(math.log, limits)) for limits in ranges.values()],
        x0=first, seed=seed, popsize=6, maxiter=generations, polish=False,
        callback=lambda *_: progress(next(generation), generations))
    best = candidate(result.x)
    if _excess(best, bounds) > 0.0:
        raise RunFailed(f'no {settings.kind} meets Ms <= {bounds.sensitivity:g}, saturation share '
                        f'<= {bounds.saturation:g} and noise gain <= {bounds.noise_gain:g} on '
                        'this model; allow more')
    return best


def printed_gains(identity: Identity) -> dict[str, float]:
    """Return the paper's gains on eq. 10, read as V^2 per metre of camber, normalised.

    Ki = 2.3e15 V^2/s, Kp = 4.0e11 V^2 and Kd = 7.5e5 V^2 s; the paper prints no filter.
    """
    scale = identity.camber_mean / identity.v_squared_slack
    return {'kp': 4.0e11 * scale, 'ki': 2.3e15 * scale, 'kd': 7.5e5 * scale,
            'derivative_filter': 0.0}


def pi_limit(model: Design, kp: float) -> float:
    """Return the ki above which PI control of the main mode is unstable.

    ki G0 = 2 zeta w (1 + kp G0), from Routh's criterion; a derivative gain adds kd G0 w^2 to
    2 zeta w.
    """
    main = model.fundamental()
    rate = np.log(np.linalg.eigvals(main.a).astype(complex)[0]) / main.dt
    return float(-2.0 * rate.real * (1.0 + kp * main.static_gain) / main.static_gain)


def with_gains(settings: ControllerSettings, changes: Mapping[str, float],
               ) -> ControllerSettings:
    """Return ``settings`` changed; the anti-windup of a PID follows its gains.

    The tracking time is kp/ki, the integral time, so that wind-up fades as fast as the integral
    would act.
    """
    changed = parameters.replace(settings, changes)
    if changed.pid.ki == 0.0 or not any(name.startswith('pid.') for name in changes):
        return changed
    tracking = max(changed.pid.kp / changed.pid.ki, 1.0e-9)
    return parameters.replace(changed, {'pid.tracking_time': tracking})


def _penalised(judged: Judged, bounds: Bounds) -> float:
    """Return the cost; outside the bounds a value above any cost that grows with the excess."""
    excess = _excess(judged, bounds)
    return judged.cost if excess <= 0.0 else 100.0 + 10.0 * min(excess, 10.0)


def _excess(judged: Judged, bounds: Bounds) -> float:
    if not judged.stable:
        return 5.0 + sum(float(np.abs(loop.poles).max())
                         for loop in (judged.loop, judged.strained))
    return (max(judged.peak / bounds.sensitivity - 1.0, 0.0)
            + max(judged.saturation - bounds.saturation, 0.0)
            + max(judged.loop.noise_gain / bounds.noise_gain - 1.0, 0.0))


def value_of(settings: ControllerSettings, name: str) -> float:
    """Return the parameter with the dotted ``name``."""
    return functools.reduce(getattr, name.split('.'), settings)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Tune a control law on the identified model, within bounds of robustness and saturation.

Minimised is  log IAE + log amplitude, where IAE integrates the error after a unit step and the
amplitude is that of the error under the disturbance of Fig. 5; see `judge`. Ms, the share of the
time at V^2 = 0 and the noise gain stay within `Bounds`.
"""

import itertools
import math
from collections.abc import Callable, Mapping

import numpy as np

from dewing_control.law.base import Law
from dewing_control.law.registry import of_kind, refusing
from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings, value_of
from dewing_control.tuning.bounds import Bounds
from dewing_control.tuning.judge import Judged, judge
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.identity import Identity

UNDESIGNABLE = 1.0e3        # above the cost of any law that can be judged


def ranges_of(kind: str) -> Mapping[str, tuple[float, float]]:
    """Return what tuning searches of the law ``kind``; raise `BadInput` if it cannot be tuned."""
    found = of_kind(kind)
    lacking = [what for what, there in (
        ('ranges', found.ranges), ('compensator', found.compensator is not Law.compensator),
    ) if not there]
    if lacking:
        raise BadInput(f'kind = {kind} cannot be tuned: it has no {" and no ".join(lacking)}')
    return found.ranges


def tune(settings: ControllerSettings, identity: Identity, model: Design, bounds: Bounds,
         seed: int = 1, generations: int = 25, progress=lambda done, total: None) -> Judged:
    """Return the best law of ``settings.kind`` within ``bounds``.

    Differential evolution (Storn and Price 1997, doi:10.1023/A:1008202821328) over the logarithms
    of the law's `ranges`, from a fixed seed. Raises `BadInput` if the law cannot be tuned or not
    be designed to begin with, `RunFailed` if no candidate meets the bounds.
    """
    from scipy.optimize import differential_evolution
    ranges = ranges_of(settings.kind)
    with refusing(settings.kind):
        strained = model.at_tension(bounds.tension)
    generation = itertools.count(1)

    def candidate(logarithms) -> Judged:
        changes = dict(zip(ranges, map(float, np.exp(logarithms))))
        with refusing(settings.kind):
            return judge(with_gains(settings, changes), identity, model, strained)

    first = np.log([np.clip(value_of(settings, name), *limits)
                    for name, limits in ranges.items()])
    candidate(first)                # a law that cannot be judged is no matter of its gains
    result = differential_evolution(
        lambda logarithms: _cost(candidate, logarithms, bounds),
        [tuple(map(math.log, limits)) for limits in ranges.values()],
        x0=first, seed=seed, popsize=6, maxiter=generations, polish=False,
        callback=lambda *_: progress(next(generation), generations))
    best = candidate(result.x)
    if _excess(best, bounds) > 0.0:
        raise RunFailed(f'no {settings.kind} meets Ms <= {bounds.sensitivity:g}, saturation share '
                        f'<= {bounds.saturation:g} and noise gain <= {bounds.noise_gain:g} on '
                        'this model; allow more')
    return best


def _cost(candidate: Callable[[np.ndarray], Judged], logarithms: np.ndarray, bounds: Bounds,
          ) -> float:
    """Return the cost of a candidate; one that cannot be designed costs more than any other."""
    try:
        return _penalised(candidate(logarithms), bounds)
    except BadInput:
        return UNDESIGNABLE


def with_gains(settings: ControllerSettings, changes: Mapping[str, float],
               ) -> ControllerSettings:
    """Return ``settings`` changed, with what the law says depends on them."""
    changed = parameters.replace(settings, changes)
    dependent = of_kind(settings.kind).dependent(changed)
    return parameters.replace(changed, dependent) if dependent else changed


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

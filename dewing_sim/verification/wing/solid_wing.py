# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupled wing with solid elements beside the same wing with membrane elements."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.identity import require_reference
from dewing_sim.inputs.base import Inputs
from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.state import State
from dewing_sim.structure.solid.pins import LOWER, MIDDLE
from dewing_sim.wing import Wing

PULSE = 1.0e5       # V^2, for one step
STEPS = 300


@dataclass(frozen=True)
class Difference:
    """Solid less membrane, as fractions of the membrane's values."""

    support: str
    voltage: float
    cl: float                   # at rest
    camber_mean: float
    camber_max: float
    pulse_peak: float           # largest response of the mean camber
    pulse_rms: float            # of the difference over that of the response, mean camber
    pulse_cl_rms: float         # the same of the lift

    def to_mapping(self) -> dict[str, str | float]:
        """Return the record that goes to JSON."""
        return dict(vars(self))


@dataclass(frozen=True)
class _Found:
    """Outputs at rest and what a pulse adds to mean camber and lift, (steps, 2)."""

    rest: Outputs
    pulse: np.ndarray


def compare(case: Case, voltages: list[float], progress: Callable | None = None,
            rest: Callable[[Wing], State] = Wing.rest, steps: int = STEPS,
            failures: dict[str, str] | None = None) -> Iterator[Difference]:
    """Yield the differences at the voltages with pins at the lower side and in the middle.

    Each wing rests under the voltage; then V^2 rises by `PULSE` for one step and what that adds is
    followed over ``steps``. ``progress(done, total)`` counts wings. A wing that fails is put into
    ``failures`` with its reason if there is such a mapping, and the others go on. Raises
    `BadInput` for a wing without camber, in which nothing could be measured.
    """
    kinds = {'membrane': {'membrane.element': 'membrane'}} | {
        support: {'membrane.element': 'solid', 'membrane.support': support}
        for support in (LOWER, MIDDLE)}
    done = 0
    for voltage in voltages:
        found = {}
        for kind, changes in kinds.items():
            try:
                wing = Wing(parameters.replace(case, changes | {'actuation.voltage': voltage}))
                found[kind] = _measure(wing, rest(wing), steps)
            except RunFailed as error:
                if failures is None:
                    raise
                failures[f'{kind} at {voltage:g} V'] = str(error)
            if kind == 'membrane' and kind in found:
                require_reference('camber of the membrane', found[kind].rest.camber_mean, case)
            done += 1
            if progress:
                progress(done, len(voltages) * len(kinds))
        for support in (LOWER, MIDDLE) if 'membrane' in found else ():
            if support not in found:
                continue
            yield _difference(support, voltage, found['membrane'], found[support])


def _measure(wing: Wing, rest: State, steps: int) -> _Found:
    resting = wing.case.actuation.voltage ** 2
    responses = []
    for height in (PULSE, 0.0):
        state, response = rest, []
        for k in range(steps):
            state = wing.step(state, Inputs(resting + (height if k == 0 else 0.0)))
            outputs = wing.observe(state)
            response.append((outputs.camber_mean, outputs.cl))
        responses.append(response)
    return _Found(wing.observe(rest), np.subtract(*responses))


def _difference(support: str, voltage: float, thin: _Found, thick: _Found) -> Difference:
    rests = (getattr(thick.rest, name) / getattr(thin.rest, name) - 1.0
             for name in ('cl', 'camber_mean', 'camber_max'))
    peak = np.abs(thick.pulse[:, 0]).max() / np.abs(thin.pulse[:, 0]).max() - 1.0
    rms = (np.linalg.norm(thick.pulse - thin.pulse, axis=0)
           / np.linalg.norm(thin.pulse, axis=0))
    return Difference(support, voltage, *rests, float(peak), *map(float, rms))

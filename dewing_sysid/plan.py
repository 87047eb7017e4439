# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which runs an identification needs: V^2 of each, all from the rest state of one case."""

from dataclasses import dataclass
from typing import Any, Mapping, Sequence

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.parameters import Case, from_mapping
from dewing_sim.scales import Scales
from dewing_sim.schema.numerals import apart
from dewing_sysid import excitation
from dewing_sysid.experiment import MODAL, STANDARD, Record, unit
from dewing_sysid.settings import Settings

BASELINE, EXPERIMENT, HALF, FRESH, SWEEP = 'baseline', 'experiment', 'half', 'prbs', 'chirp'


@dataclass(frozen=True)
class Plan:
    """V^2 (N,) of every run by name; deviations are taken from the run `BASELINE`."""

    dt: float                           # s
    operating_v_squared: float          # V^2
    names: tuple[str, ...]
    inputs: dict[str, np.ndarray]

    def records(self, outputs: Mapping[str, np.ndarray]) -> dict[str, Record]:
        """Return the record of every excited run; ``outputs`` maps run to (outputs, N)."""
        rest = outputs[BASELINE]
        return {name: Record(self.dt, v_squared, outputs[name], rest[:, :len(v_squared)],
                             self.operating_v_squared, self.names)
                for name, v_squared in self.inputs.items() if name != BASELINE}


def case_of(identity: Identity) -> Case:
    """Return the case of a plant; raise `BadInput` if it does not know it."""
    if not identity.case:
        raise BadInput(f'the plant ({identity.plant}) does not say which case it is: c/U and the '
                       'operating voltage are unknown')
    return from_mapping(Case, identity.case)


def time_scale(identity: Identity) -> float:
    """Return c/U in s."""
    case = case_of(identity)
    return Scales.of(case.flow, case.membrane.chord).time


def samples(convective_times: float, scale: float, dt: float) -> int:
    """Return the number of samples from 0 up to and including ``convective_times`` c/U."""
    return int(round(convective_times * scale / dt)) + 1


def make(settings: Settings, identity: Identity, names: Sequence[str] | None = None) -> Plan:
    """Return the runs that ``settings`` ask of a plant, about the rest voltage of its case.

    Raises `BadInput` if a run would exceed the admissible voltage or slacken the membrane, if an
    output is unknown, if the record is shorter than the window or if the membrane lies flat.
    """
    identity.require_response()
    dt, chosen = identity.dt, settings.experiment
    rest = case_of(identity).actuation.voltage**2
    length, window, fresh_length = (
        samples(duration, time_scale(identity), dt) for duration in
        (chosen.record, settings.realisation.window, settings.fresh.record))
    if window > length:
        raise BadInput(f'experiment.record = {chosen.record:g} c/U is too short for '
                       f'realisation.window = {settings.realisation.window:g} c/U')
    form, fresh = _shape(settings, length, dt), settings.fresh
    shapes = {
        EXPERIMENT: (form, chosen.amplitude**2),
        HALF: (form, 0.5 * chosen.amplitude**2),
        FRESH: (_levels('fresh', 'prbs', fresh, fresh_length), fresh.amplitude**2),
        SWEEP: (_sweep(settings, fresh_length, dt), fresh.amplitude**2)}
    inputs = {name: excitation.about(shape, amplitude, rest)
              for name, (shape, amplitude) in shapes.items()}
    inputs[BASELINE] = np.full(max(length, fresh_length), rest)
    for name, v_squared in inputs.items():
        _check_voltage(name, v_squared, identity)
    names = names or named(settings.realisation.outputs)
    for name in names:
        unit(name, identity)
    return Plan(dt, rest, tuple(names), inputs)


def named(outputs: str) -> tuple[str, ...]:
    """Return the names of `realisation.outputs`."""
    known = {'standard': STANDARD, 'modal': MODAL}
    return known.get(outputs) or tuple(name.strip() for name in outputs.split(','))


def _shape(settings: Settings, length: int, dt: float) -> np.ndarray:
    chosen = settings.experiment
    if chosen.kind == 'step':
        return excitation.step(length)
    if chosen.kind == 'chirp':
        return _sweep(settings, length, dt)
    return _levels('experiment', chosen.kind, chosen, length)


LEVELS = {'pulse': 1, 'doublet': 2, 'prbs': 1}      # that a record has to hold, and a sample more


def _levels(section: str, kind: str, chosen: Any, length: int) -> np.ndarray:
    """Return a signal of held levels; raise `BadInput` if the record ends before they change."""
    most = (length - 1) // LEVELS[kind]
    if chosen.hold > most:
        raise BadInput(f'{section}.hold = {chosen.hold} samples is out of range: a {kind} lets it '
                       f'be at most {most} with {section}.record = {chosen.record:g} c/U, which '
                       f'is {length} samples')
    if kind == 'prbs':
        return excitation.prbs(length, chosen.hold, chosen.seed)
    return getattr(excitation, kind)(length, chosen.hold)


def _sweep(settings: Settings, length: int, dt: float) -> np.ndarray:
    return excitation.chirp(length, dt, settings.experiment.sweep_low,
                            settings.experiment.sweep_high)


def _check_voltage(name: str, v_squared: np.ndarray, identity: Identity) -> None:
    peak, limit, slack = np.sqrt([v_squared.max(), identity.v_squared_max,
                                  identity.v_squared_slack])
    if peak > min(limit, slack):
        shown, most = apart(peak, min(limit, slack), 4)
        limit = most if limit < slack else f'{limit:.0f}'
        raise BadInput(f'run {name!r} peaks at {shown} V, above the admissible {limit} V '
                       f'(the membrane is slack from {slack:.0f} V): take a smaller amplitude')

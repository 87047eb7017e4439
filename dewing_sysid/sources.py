# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded experiments: the npz of an identification, or a bag of measurements and commands."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.lockstep import nanoseconds
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema
from dewing_sim.records import bag
from dewing_sim.records.mcap_file import Losses
from dewing_sim.records.runs import JOINTS, Splitter, choose
from dewing_sim.records.runs import Run as Samples
from dewing_sysid.disturbed import INPUTS, Disturbances, require_cancelled
from dewing_sysid.experiment import STANDARD, Record, load_records
from dewing_sysid.plan import BASELINE, EXPERIMENT, FRESH, HALF, SWEEP, case_of

CASE, MEASUREMENT, COMMAND = '/dewing/case', '/dewing/measurement', '/dewing/command'
COMMANDED = ('v_squared',)
Run = tuple[np.ndarray, np.ndarray]     # V^2 (N,) and outputs (outputs, N)


def load(path: str | Path, run: int | None = None) -> tuple[dict[str, Record], Identity]:
    """Return records by run and the identity of the plant from an npz file or an MCAP bag.

    ``run`` picks one of a bag, as `from_bag` has it.
    """
    if Path(path).suffix == '.mcap':
        return from_bag(path, run)
    if run is not None:
        raise BadInput(f'{path}: a run can be picked from a bag, MCAP, only')
    return load_records(path)


def from_bag(path: str | Path, run: int | None = None) -> tuple[dict[str, Record], Identity]:
    """Return the records of a bag; a run begins wherever the stamps start again.

    Runs are told by their V^2: constant is the baseline (the first sample where there is none),
    the first other one the experiment, half its deviation the linearity check, one of two levels
    the fresh binary sequence, any other the sweep.  With ``run``, counted from 1, that one is the
    experiment, and of the others only the baseline is taken.  The outputs are those of `STANDARD`
    that were measured, and any that are not dewing's own.  What else acted has to be the same in
    the baseline.  Raises `BadInput` if it is not, if messages are missing, if two runs could be
    the same one, or if there is no run ``run``.
    """
    return from_runs(path, *_contents(path), run)


def from_runs(path: str | Path, identity: Identity, measured: list[Samples],
              commanded: list[Samples], disturbances: Disturbances, run: int | None = None,
              ) -> tuple[dict[str, Record], Identity]:
    """Return the records of runs of measurements and commands, as `from_bag` does.

    ``path`` is the word for their origin in the sentences of errors.
    """
    names = _names(measured[0])
    if len(measured) != len(commanded):
        raise BadInput(f'{path}: {len(measured)} runs of measurements do not fit '
                       f'{len(commanded)} runs of commands')
    rest = case_of(identity).actuation.voltage**2
    pairs = [(_rows(path, seen, names), _rows(path, said, COMMANDED))
             for seen, said in zip(measured, commanded)]
    if run is None:
        runs, numbers = _named(path, [_aligned(path, identity.dt, *pair) for pair in pairs], rest)
    else:
        choose(measured, run, path, MEASUREMENT)
        runs, numbers = _single(path, pairs, run - 1, identity.dt, rest)
    if EXPERIMENT not in runs:
        raise BadInput(f'{path}: V^2 never changes' + (f' in run {run}' if run else '')
                       + ', there is no experiment in it')
    acting = disturbances.by_run(measured)
    for number in numbers.values():
        require_cancelled(path, disturbances, acting, number, numbers.get(BASELINE),
                          measured[number - 1].stamps[-1])
    return {name: _record(v_squared, outputs, runs.get(BASELINE), identity.dt, rest, names)
            for name, (v_squared, outputs) in runs.items() if name != BASELINE}, identity


def _contents(path: str | Path,
              ) -> tuple[Identity, list[Samples], list[Samples], Disturbances]:
    """Return the plant, the measured and the commanded runs of a bag, and what disturbed them."""
    losses, identities, disturbances = Losses(), [], Disturbances()
    splitters = {topic: Splitter(topic, losses) for topic in (MEASUREMENT, COMMAND)}
    for topic, received, message in bag.read(path, CASE, INPUTS, *splitters, losses=losses):
        if topic == INPUTS and message.__msgtype__ == JOINTS:
            disturbances.acted(received, message)
        elif topic in splitters:
            splitters[topic].add(message)
            if topic == MEASUREMENT:
                disturbances.measured(received, message)
        elif topic == CASE and (identity := _identity(path, message)) not in identities:
            identities.append(identity)
    for sentence in losses.sentences():
        warnings.warn(f'{path}: {sentence}', RuntimeWarning, stacklevel=4)
    if not identities:
        raise BadInput(f'{path}: no message on {CASE} says which plant it is')
    if len(identities) > 1:
        raise BadInput(f'{path}: {len(identities)} different plants were recorded')
    measured, commanded = (splitter.runs for splitter in splitters.values())
    if not measured:
        raise BadInput(f'{path}: no messages on {MEASUREMENT}')
    return identities[0], measured, commanded, disturbances


def _identity(path: str | Path, message: Any) -> Identity:
    try:
        return Identity.from_yaml(str(getattr(message, 'data', '')))
    except BadInput as error:
        raise BadInput(f'{path}: {CASE}: {error}') from None


def _names(run: Samples) -> tuple[str, ...]:
    own = schema(Outputs).names
    return (*(name for name in STANDARD if name in run.names),
            *(name for name in run.names if name not in own))


def _rows(path: str | Path, run: Samples, names: tuple[str, ...]) -> dict[int, list[float]]:
    """Return the values of ``names`` by stamp (ns)."""
    if not names or not set(names) <= set(run.names):
        raise BadInput(f'{path}: a message has {", ".join(run.names)}, '
                       f'wanted are {", ".join(names or STANDARD)}')
    places = [run.names.index(name) for name in names]
    return {stamp: [row[place] for place in places]
            for stamp, row in zip(run.stamps, run.rows)}


def _aligned(path: str | Path, dt: float, measured: dict, commanded: dict) -> Run:
    """Return V^2 and outputs by sample; the last V^2, which acts on nothing, may be missing."""
    stamps = [nanoseconds(k * dt) for k in range(len(measured))]
    for stamp in stamps:
        missing = 'measurement' if stamp not in measured else (
            'command' if stamp not in commanded and stamp != stamps[-1] else '')
        if missing:
            raise BadInput(f'{path}: no {missing} at {stamp * 1.0e-9:.6f} s; dt = {dt:g} s')
    levels = [commanded[stamp][0] for stamp in stamps[:-1]]
    levels += commanded.get(stamps[-1], levels[-1:] or [0.0])
    return np.array(levels), np.array([measured[stamp] for stamp in stamps]).T


def _named(path: str | Path, runs: list[Run], rest: float,
           ) -> tuple[dict[str, Run], dict[str, int]]:
    """Return the runs, and their numbers, by what they are for."""
    named: dict[str, Run] = {}
    numbers: dict[str, int] = {}
    for number, (v_squared, outputs) in enumerate(runs, start=1):
        name = _purpose(v_squared, named[EXPERIMENT][0] if EXPERIMENT in named else None, rest)
        if name == BASELINE and name in named:
            if len(named[name][0]) >= len(v_squared):
                continue
        elif name in named:
            raise BadInput(f'{path}: runs {numbers[name]} and {number} both look like the run '
                           f'{name}; identify from one, which is to be chosen')
        named[name], numbers[name] = (v_squared, outputs), number
    return named, numbers


def _purpose(v_squared: np.ndarray, experiment: np.ndarray | None, rest: float) -> str:
    u = v_squared[:-1] - rest
    first = None if experiment is None else experiment[:-1] - rest
    if not u.any():
        return BASELINE
    if first is None or np.array_equal(u, first):
        return EXPERIMENT
    if len(u) == len(first) and np.allclose(u, 0.5 * first, rtol=1e-12):
        return HALF
    return FRESH if len(np.unique(u)) == 2 else SWEEP


def _single(path: str | Path, pairs: list[tuple[dict, dict]], chosen: int, dt: float,
            rest: float) -> tuple[dict[str, Run], dict[str, int]]:
    """Return the chosen run as the experiment, and a baseline that is as long if there is one.

    The second are their numbers, counted from 1.
    """
    run = _aligned(path, dt, *pairs[chosen])
    found = {EXPERIMENT: run} if _purpose(run[0], None, rest) == EXPERIMENT else {}
    numbers = dict.fromkeys(found, chosen + 1)
    for number, (measured, commanded) in enumerate(pairs, start=1):
        if len(measured) >= len(run[0]) and {value - rest for value, in commanded.values()} == {0}:
            return (found | {BASELINE: _aligned(path, dt, measured, commanded)},
                    numbers | {BASELINE: number})
    return found, numbers


def _record(v_squared: np.ndarray, outputs: np.ndarray, baseline: Run | None, dt: float,
            rest: float, names: tuple[str, ...]) -> Record:
    still = np.repeat(outputs[:, :1], outputs.shape[1], axis=1) if baseline is None else (
        baseline[1][:, :outputs.shape[1]])
    return Record(dt, v_squared, outputs, still, rest, names)

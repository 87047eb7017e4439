# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded experiments: the npz of an identification, or a bag of measurements and commands."""

from pathlib import Path
from typing import Any

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.lockstep import nanoseconds
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema
from dewing_sim.records import bag
from dewing_sysid.experiment import STANDARD, Record, load_records
from dewing_sysid.plan import BASELINE, EXPERIMENT, FRESH, HALF, SWEEP, case_of

NAMESPACE = '/dewing'
Run = tuple[np.ndarray, np.ndarray]     # V^2 (N,) and outputs (outputs, N)


def load(path: str | Path) -> tuple[dict[str, Record], Identity]:
    """Return records by run and the identity of the plant from an npz file or an MCAP bag."""
    return from_bag(path) if Path(path).suffix == '.mcap' else load_records(path)


def from_bag(path: str | Path) -> tuple[dict[str, Record], Identity]:
    """Return the records of a bag; a run begins wherever the stamps start again.

    Runs are told by their V^2: constant is the baseline (the first sample where there is none),
    the first other one the experiment, half its deviation the linearity check, one of two levels
    the fresh binary sequence, any other the sweep.  The outputs are those of `STANDARD` that were
    measured, and any that are not dewing's own.  Raises `BadInput` if messages are missing.
    """
    identity, names = _identity(path), _names(path)
    measured = _runs(path, 'measurement', lambda message: _row(path, message, names))
    commanded = _runs(path, 'command', lambda message: message.effort[0])
    if len(measured) != len(commanded):
        raise BadInput(f'{path}: {len(measured)} runs of measurements do not fit '
                       f'{len(commanded)} runs of commands')
    rest = case_of(identity).actuation.voltage**2
    runs = _named([_aligned(path, identity.dt, *pair) for pair in zip(measured, commanded)], rest)
    if EXPERIMENT not in runs:
        raise BadInput(f'{path}: V^2 never changes, there is no experiment in it')
    return {name: _record(v_squared, outputs, runs.get(BASELINE), identity.dt, rest, names)
            for name, (v_squared, outputs) in runs.items() if name != BASELINE}, identity


def _identity(path: str | Path) -> Identity:
    for _, _, message in bag.read(path, f'{NAMESPACE}/case'):
        return Identity.from_yaml(message.data)
    raise BadInput(f'{path}: no message on {NAMESPACE}/case says which plant it is')


def _names(path: str | Path) -> tuple[str, ...]:
    for _, _, message in bag.read(path, f'{NAMESPACE}/measurement'):
        own = schema(Outputs).names
        return (*(name for name in STANDARD if name in message.name),
                *(name for name in message.name if name not in own))
    raise BadInput(f'{path}: no messages on {NAMESPACE}/measurement')


def _row(path: str | Path, message: Any, names: tuple[str, ...]) -> list[float]:
    values = dict(zip(message.name, message.position))
    if not names or not values.keys() >= set(names):
        raise BadInput(f'{path}: a measurement has {", ".join(values)}, '
                       f'wanted are {", ".join(names or STANDARD)}')
    return [values[name] for name in names]


def _runs(path: str | Path, topic: str, value) -> list[dict[int, Any]]:
    """Return values by stamp (ns) of every run; of repeated stamps the first counts."""
    runs: list[dict[int, Any]] = []
    last = None
    for _, _, message in bag.read(path, f'{NAMESPACE}/{topic}'):
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        if last is None or stamp < last:
            runs.append({})
        runs[-1].setdefault(stamp, value(message))
        last = stamp
    return runs


def _aligned(path: str | Path, dt: float, measured: dict, commanded: dict) -> Run:
    """Return V^2 and outputs by sample; the last V^2, which acts on nothing, may be missing."""
    stamps = [nanoseconds(k * dt) for k in range(len(measured))]
    for stamp in stamps:
        missing = 'measurement' if stamp not in measured else (
            'command' if stamp not in commanded and stamp != stamps[-1] else '')
        if missing:
            raise BadInput(f'{path}: no {missing} at {stamp * 1.0e-9:.6f} s; dt = {dt:g} s')
    levels = [commanded[stamp] for stamp in stamps[:-1]]
    levels.append(commanded.get(stamps[-1], levels[-1] if levels else 0.0))
    return np.array(levels), np.array([measured[stamp] for stamp in stamps]).T


def _named(runs: list[Run], rest: float) -> dict[str, Run]:
    named: dict[str, Run] = {}
    for v_squared, outputs in runs:
        u = v_squared[:-1] - rest
        first = named[EXPERIMENT][0][:-1] - rest if EXPERIMENT in named else None
        if not u.any():
            name = BASELINE
        elif first is None:
            name = EXPERIMENT
        elif len(u) == len(first) and np.allclose(u, 0.5 * first, rtol=1e-12):
            name = HALF
        else:
            name = FRESH if len(np.unique(u)) == 2 else SWEEP
        named.setdefault(name, (v_squared, outputs))
    return named


def _record(v_squared: np.ndarray, outputs: np.ndarray, baseline: Run | None, dt: float,
            rest: float, names: tuple[str, ...]) -> Record:
    still = np.repeat(outputs[:, :1], outputs.shape[1], axis=1) if baseline is None else (
        baseline[1][:, :outputs.shape[1]])
    return Record(dt, v_squared, outputs, still, rest, names)

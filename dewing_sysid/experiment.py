# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Run experiments on a plant: excited and undisturbed runs branch from one state."""

import pickle
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy as np

from dewing_sim.errors import BadInput, Slack
from dewing_sim.files import new_file, read_npz
from dewing_sim.identity import Identity
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine.job import Failed, Job
from dewing_sim.machine.jobs import HERE, Workers, results
from dewing_sim.plant import Outputs, Plant
from dewing_sim.quantities import Absent

WORTH_PROCESSES = 10_000    # steps; fewer are made before another process has begun
STANDARD = ('camber_mean', 'camber_max', 'cl')
MODAL = STANDARD + tuple(f'mode_{n}' for n in range(1, 6))


def unit(name: str, identity: Identity) -> str:
    """Return the SI unit of an output; raise `BadInput` if the plant has no such output."""
    if name.startswith('mode_') and name[5:].isdigit() and int(name[5:]) > 0:
        return 'm'
    units = identity.units
    if name not in units:
        raise BadInput(f"output {name!r} is unknown; known: {', '.join(units)} and mode_1, ...")
    return units[name]


def observe(outputs: Outputs, names: Sequence[str]) -> list[float]:
    """Return the named quantities; mode_n is 2/c int_0^c y sin(n pi x / c) dx in m.

    Raises `Absent`, a `BadInput`, for what the plant does not have.
    """
    return [_mode(outputs, int(name[5:])) if name.startswith('mode_')
            else _number(outputs, name) for name in names]


def _number(outputs: Outputs, name: str) -> float:
    value = getattr(outputs, name)
    if value is None:
        raise Absent(f'output {name!r} cannot be identified: the plant does not have it')
    return float(value)


def _mode(outputs: Outputs, number: int) -> float:
    if outputs.x is None or outputs.x.size < 2:
        raise BadInput(f'mode_{number} needs a membrane, this plant has none')
    span = outputs.x[-1] - outputs.x[0]
    shape = np.sin(number * np.pi * (outputs.x - outputs.x[0]) / span)
    product = outputs.y * shape
    return float(2.0 / span * (0.5 * np.diff(outputs.x) * (product[1:] + product[:-1])).sum())


@dataclass(frozen=True)
class Record:
    """One experiment; sample k pairs the outputs at t_k = k dt with V^2 held from t_k to t_k+1.

    Hence y[0] is untouched by u and a one-sample pulse gives h[k] = y[k] / u[0], h[0] = D = 0.
    ``baseline`` is the run from the same state at the constant operating V0^2.
    Raises `BadInput` if the shapes do not fit, dt is not positive or a sample is not finite.
    """

    dt: float                           # s
    v_squared: np.ndarray               # (N,), V^2
    outputs: np.ndarray                 # (outputs, N)
    baseline: np.ndarray                # (outputs, N)
    operating_v_squared: float          # V^2
    names: tuple[str, ...]

    def __post_init__(self):
        """Check once, where every record is made, and lay out by rows: BLAS rounds by layout."""
        for name in ('v_squared', 'outputs', 'baseline'):
            object.__setattr__(self, name, np.ascontiguousarray(getattr(self, name), float))
        expected = (len(self.names), len(self.v_squared))
        if not (np.isfinite(self.dt) and self.dt > 0.0):
            raise BadInput(f'dt = {self.dt} s must be positive')
        if self.outputs.shape != expected or self.baseline.shape != expected:
            raise BadInput(f'outputs {self.outputs.shape} and baseline {self.baseline.shape} '
                           f'do not fit {expected[0]} names and {expected[1]} samples')
        rows = np.vstack([self.v_squared, self.outputs, self.baseline])
        bad = np.argwhere(~np.isfinite(rows))
        if bad.size:
            row, sample = bad[0]
            raise BadInput(f"{('v_squared', *self.names, *self.names)[row]} is not finite at "
                           f'sample {sample} (t = {sample * self.dt:g} s)')

    @property
    def u(self) -> np.ndarray:
        """Return V^2 - V0^2, (N,)."""
        return self.v_squared - self.operating_v_squared

    @property
    def y(self) -> np.ndarray:
        """Return outputs minus baseline, (outputs, N)."""
        return self.outputs - self.baseline

    def head(self, samples: int) -> 'Record':
        """Return the first ``samples`` samples; `BadInput` if the record is shorter."""
        if samples > len(self.v_squared):
            raise BadInput(f'the record holds {len(self.v_squared)} samples '
                           f'({len(self.v_squared) * self.dt:g} s), {samples} are needed')
        return replace(self, v_squared=self.v_squared[:samples],
                       outputs=self.outputs[:, :samples], baseline=self.baseline[:, :samples])


def save_records(path: str | Path, records: dict[str, Record], identity: Identity,
                 overwrite: bool = False) -> None:
    """Write the records of one identification, by run, to an npz that `load_records` reads."""
    arrays = {f'{run}/{key}': getattr(record, key) for run, record in records.items()
              for key in ('dt', 'v_squared', 'outputs', 'baseline', 'operating_v_squared',
                          'names')}
    with new_file(path, overwrite) as file:
        np.savez(file, identity=identity.to_yaml(), **arrays)


def load_records(path: str | Path) -> tuple[dict[str, Record], Identity]:
    """Return records by run and the plant's identity; `BadInput` if that is not in the file."""
    with read_npz(path, 'a record of an experiment') as arrays:
        runs = [key[:-len('/v_squared')] for key in arrays if key.endswith('/v_squared')]
        identity = Identity.from_yaml(str(arrays['identity']))
        return {run: _record(arrays, run) for run in runs}, identity


def _record(file: Any, run: str) -> Record:
    return Record(float(file[f'{run}/dt']), file[f'{run}/v_squared'], file[f'{run}/outputs'],
                  file[f'{run}/baseline'], float(file[f'{run}/operating_v_squared']),
                  tuple(file[f'{run}/names'].tolist()))


def run(plant: Plant, start: Any, names: Sequence[str], v_squared: np.ndarray) -> np.ndarray:
    """Return the outputs (outputs, N) while V^2 follows ``v_squared`` (N,) from ``start``.

    Raises `BadInput` if the membrane slackens, and what the plant raises otherwise.
    """
    samples = np.empty((len(names), len(v_squared)))
    state = start
    samples[:, 0] = observe(plant.observe(start), names)
    for k in range(1, len(v_squared)):
        state = _step(plant, state, float(v_squared[k - 1]), k)
        samples[:, k] = observe(plant.observe(state), names)
    return samples


def _step(plant: Plant, state: Any, v_squared: float, number: int) -> Any:
    try:
        return plant.step(state, Inputs(v_squared))
    except Slack as error:
        raise BadInput(f'V = {np.sqrt(v_squared):.0f} V slackens the membrane in step {number}: '
                       f'take a smaller amplitude or operating voltage ({error})') from None


def run_all(plant: Plant, start: Any, names: Sequence[str], inputs: Sequence[np.ndarray],
            workers: Workers = HERE,
            progress: Callable[[float], None] = lambda fraction: None) -> list[np.ndarray]:
    """Return the outputs of independent runs, in the order of ``inputs``.

    The longest start first. With one worker, for a plant that does not pickle, such as one with a
    user's lambda, or for fewer steps than are worth another process, they follow each other in
    this one. ``progress`` hears the finished share.
    """
    order = sorted(range(len(inputs)), key=lambda i: -len(inputs[i]))
    jobs = {i: Job(partial(run, plant, start, names, inputs[i]), cost=len(inputs[i]))
            for i in order}
    found: dict[int, np.ndarray] = {}
    total, done = sum(map(len, inputs)), 0
    short = workers.scheduler is None and total < WORTH_PROCESSES
    alone = workers == HERE or short or not _pickles((plant, start))
    for i, outcome in ((i, jobs[i].call()) for i in order) if alone else results(jobs, workers):
        if isinstance(outcome, Failed):
            raise outcome.error
        found[i] = outcome
        done += len(inputs[i])
        progress(done / total)
    return [found[i] for i in range(len(inputs))]


def _pickles(thing: Any) -> bool:
    try:
        pickle.dumps(thing)
    except (pickle.PicklingError, AttributeError, TypeError):
        return False
    return True

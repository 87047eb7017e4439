# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs stacked in time, and their file: an npz that carries the case it came from."""

from dataclasses import dataclass
from pathlib import Path
from typing import Iterable

import numpy as np
import yaml

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.files import new_file, read_npz
from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.quantities import Absent, Schema, schema


@dataclass(frozen=True, eq=False)
class History:
    """A run; SI units as in `Outputs`, whose fields say which columns there are.

    ``columns`` are the numbers of each step by name, each (steps,). ``shapes`` are kept every few
    steps, at ``shape_time`` (frames,), each (frames, nodes). Both are attributes too, ``run.cl``;
    what the plant did not have, or a file of an earlier version does not hold, raises `Absent`.
    ``units`` are by name, empty where a file does not say; ``case`` is the YAML of the case, or
    empty.
    """

    columns: dict[str, np.ndarray]
    shape_time: np.ndarray
    shapes: dict[str, np.ndarray]
    units: dict[str, str]
    case: str = ''

    def __len__(self) -> int:
        return len(self.columns['time'])

    def __contains__(self, name: str) -> bool:
        return name in self.columns or name in self.shapes

    def __getattr__(self, name: str) -> np.ndarray:
        held = {**self.__dict__.get('columns', {}), **self.__dict__.get('shapes', {})}
        if name not in held:
            raise Absent(f'the run does not hold {name}; it has {", ".join(held)}')
        return held[name]

    @property
    def voltage(self) -> np.ndarray:
        """V = sqrt(V^2) in volt, shape (steps,)."""
        return np.sqrt(self.v_squared)

    def since(self, time: float) -> 'History':
        """Return the part of the run later than ``time`` (s)."""
        late, frames = self.time > time, self.shape_time > time
        return History({name: array[late] for name, array in self.columns.items()},
                       self.shape_time[frames],
                       {name: array[frames] for name, array in self.shapes.items()},
                       self.units, self.case)

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write an npz; raise `BadInput` if ``path`` exists and may not be overwritten.

        Its key ``outputs`` tells numbers from shapes and has their units, as YAML.
        """
        said = yaml.safe_dump({kind: {name: self.units.get(name, '') for name in arrays}
                               for kind, arrays in (('columns', self.columns),
                                                    ('shapes', self.shapes))}, sort_keys=False)
        with new_file(path, overwrite) as file:
            np.savez_compressed(file, **self.columns, shape_time=self.shape_time, **self.shapes,
                                case=self.case, outputs=said)

    @classmethod
    def load(cls, path: str | Path) -> 'History':
        """Read what `save` wrote; raise `BadInput` for anything else and for NaN.

        A file of version 0.1 does not say what it holds: its columns are those that it has of
        the present outputs.
        """
        with read_npz(path, 'the history of a run') as arrays:
            said = _described(arrays)
            columns, shapes = ({name: arrays[name] for name in said[kind]}
                               for kind in ('columns', 'shapes'))
            history = cls(columns, arrays['shape_time'], shapes,
                          {**said['columns'], **said['shapes']}, str(arrays['case']))
            len(history)
        for name, array in {**columns, 'shape_time': history.shape_time, **shapes}.items():
            if not np.all(np.isfinite(array)):
                raise BadInput(f'{path}: {name} holds numbers that are not finite')
        return history


def _described(arrays: dict[str, np.ndarray]) -> dict[str, dict[str, str]]:
    """Return the units of the columns and shapes in a file, by kind and name."""
    if 'outputs' in arrays:
        return yaml.safe_load(str(arrays['outputs']))
    known = schema(Outputs)
    units = {each.name: each.unit for each in known.quantities if each.name in arrays}
    return {kind: {name: units[name] for name in names if name in units}
            for kind, names in (('columns', known.columns), ('shapes', known.shapes))}


class Recorder:
    """Collects outputs one by one, so that an interrupted run keeps what was computed."""

    def __init__(self, case: Case | None = None, every: int = 1):
        """Keep the scalars of each step and the shapes of each ``every``-th."""
        self._case = parameters.to_yaml(case) if case else ''
        self._every = every
        self._schema: Schema = schema(Outputs)
        self._names: tuple[tuple[str, ...], ...] = ()   # of the numbers and shapes there are
        self._scalars: list[tuple] = []
        self._shapes: list[tuple] = []

    def __len__(self) -> int:
        return len(self._scalars)

    def add(self, outputs: Outputs) -> None:
        """Append one instant; raise `Diverged`, keeping the past, if it is not finite.

        Raises `BadInput` if the plant has other outputs than at the first instant.
        """
        known = schema(type(outputs))
        columns, row = known.given(outputs, known.columns)
        shapes, shape = known.given(outputs, known.shapes)
        if not (np.isfinite(row).all() and all(np.isfinite(part).all() for part in shape)):
            raise Diverged(f'the outputs at t = {outputs.time:g} s are not finite; '
                           f'a smaller time step may help')
        self._settle(known, (columns, shapes), outputs.time)
        if len(self._scalars) % self._every == 0:
            self._shapes.append((outputs.time, *shape))
        self._scalars.append(row)

    def _settle(self, known: Schema, names: tuple[tuple[str, ...], ...], time: float) -> None:
        """Take the outputs of the first instant for those of the run."""
        if not self._scalars:
            self._schema, self._names = known, names
        elif names != self._names:
            odd = set(sum(names, ())) ^ set(sum(self._names, ()))
            raise BadInput(f'the plant does not have {", ".join(sorted(odd))} at every instant: '
                           f't = {time:g} s is the first that differs')

    def history(self) -> History:
        """Return everything added so far."""
        quantities = {each.name: each for each in self._schema.quantities}
        names, shapes = self._names or (self._schema.columns, self._schema.shapes)
        columns = zip(*self._scalars) if self._scalars else [()] * len(names)
        kept = {name: np.array(column, dtype=quantities[name].kind)
                for name, column in zip(names, columns)}
        frames = zip(*self._shapes) if self._shapes else [()] * (1 + len(shapes))
        time, *stacked = map(np.array, frames)
        return History(kept, time, dict(zip(shapes, stacked)),
                       {name: quantities[name].unit for name in (*names, *shapes)}, self._case)


def record(outputs: Iterable[Outputs], case: Case | None = None, every: int = 1) -> History:
    """Return the history of all ``outputs``."""
    recorder = Recorder(case, every)
    for instant in outputs:
        recorder.add(instant)
    return recorder.history()

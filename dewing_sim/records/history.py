# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs stacked in time, and their file: an npz that carries the case it came from."""

import dataclasses
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.files import new_file
from dewing_sim.parameters import Case
from dewing_sim.plant import SCALARS, Outputs

SHAPES = ('x', 'y', 'pressure_jump')


@dataclass(frozen=True)
class History:
    """A run; SI units as in `Outputs`.

    Scalars have shape (steps,). Shapes are kept every few steps, at ``shape_time`` (frames,), and
    have shape (frames, nodes). ``case`` is the YAML of the case, or empty.
    """

    time: np.ndarray
    v_squared: np.ndarray
    cl: np.ndarray
    cd: np.ndarray
    cm: np.ndarray
    camber_mean: np.ndarray
    camber_max: np.ndarray
    camber_max_position: np.ndarray
    tension: np.ndarray
    coupling_iterations: np.ndarray
    shape_time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    pressure_jump: np.ndarray
    case: str = ''

    def __len__(self) -> int:
        return len(self.time)

    @property
    def voltage(self) -> np.ndarray:
        """V = sqrt(V^2) in volt, shape (steps,)."""
        return np.sqrt(self.v_squared)

    def since(self, time: float) -> 'History':
        """Return the part of the run later than ``time`` (s)."""
        late, frames = self.time > time, self.shape_time > time
        kept = {name: getattr(self, name)[late] for name in SCALARS}
        kept |= {name: getattr(self, name)[frames] for name in ('shape_time', *SHAPES)}
        return History(**kept, case=self.case)

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write an npz; raise `BadInput` if ``path`` exists and may not be overwritten."""
        with new_file(path, overwrite) as file:
            np.savez_compressed(file, **vars(self))

    @classmethod
    def load(cls, path: str | Path) -> 'History':
        """Read what `save` wrote; raise `BadInput` for anything else and for NaN."""
        try:
            with np.load(path, allow_pickle=False) as archive:
                arrays = {field.name: archive[field.name] for field in dataclasses.fields(cls)}
        except FileNotFoundError:
            raise BadInput(f'{path}: no such file') from None
        except (OSError, KeyError, ValueError, TypeError, EOFError, AttributeError,
                zipfile.BadZipFile):
            raise BadInput(f'{path}: not the history of a run') from None
        case = str(arrays.pop('case'))
        for name, array in arrays.items():
            if not np.all(np.isfinite(array)):
                raise BadInput(f'{path}: {name} holds numbers that are not finite')
        return cls(**arrays, case=case)


class Recorder:
    """Collects outputs one by one, so that an interrupted run keeps what was computed."""

    def __init__(self, case: Case | None = None, every: int = 1):
        """Keep the scalars of each step and the shapes of each ``every``-th."""
        self._case = parameters.to_yaml(case) if case else ''
        self._every = every
        self._scalars: list[tuple] = []
        self._shapes: list[tuple] = []

    def __len__(self) -> int:
        return len(self._scalars)

    def add(self, outputs: Outputs) -> None:
        """Append one instant; raise `Diverged`, keeping the past, if it is not finite."""
        row = tuple(getattr(outputs, name) for name in SCALARS)
        shape = tuple(getattr(outputs, name) for name in SHAPES)
        if not (np.isfinite(row).all() and all(np.isfinite(part).all() for part in shape)):
            raise Diverged(f'the outputs at t = {outputs.time:g} s are not finite; '
                           f'a smaller time step may help')
        if len(self._scalars) % self._every == 0:
            self._shapes.append((outputs.time, *shape))
        self._scalars.append(row)

    def history(self) -> History:
        """Return everything added so far."""
        scalars = np.array(self._scalars, dtype=float).reshape(-1, len(SCALARS)).T
        kept = dict(zip(SCALARS, map(np.ascontiguousarray, scalars)))
        kept['coupling_iterations'] = kept['coupling_iterations'].astype(int)
        columns = zip(*self._shapes) if self._shapes else [()] * (1 + len(SHAPES))
        kept |= dict(zip(('shape_time', *SHAPES), map(np.array, columns)))
        return History(**kept, case=self._case)


def record(outputs: Iterable[Outputs], case: Case | None = None, every: int = 1) -> History:
    """Return the history of all ``outputs``."""
    recorder = Recorder(case, every)
    for instant in outputs:
        recorder.add(instant)
    return recorder.history()

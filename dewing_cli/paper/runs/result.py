# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a run leaves: numbers and series, kept until something that it depends on changes."""

import hashlib
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping, Protocol

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.files import new_file, read_npz
from dewing_sim.machine import fingerprint as machine
from dewing_sim.machine.job import Tick


@dataclass(frozen=True, eq=False)
class Result:
    """Values for JSON and arrays by name."""

    values: dict[str, Any]
    arrays: dict[str, np.ndarray] = field(default_factory=dict)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the array ``name``."""
        return self.arrays[name]


class Run(Protocol):
    """A computation for a process of its own; its ``repr`` says all that it depends on."""

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the runs whose results it takes."""

    @property
    def cost(self) -> float:
        """Expected time in arbitrary units."""

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Return the result; ``inputs`` holds those of `needs`."""


def fingerprint(name: str, runs: Mapping[str, Run]) -> str:
    """Return a hash of run ``name``, of the runs that it needs and of the code."""
    run = runs[name]
    inputs = ''.join(fingerprint(other, runs) for other in run.needs)
    code = machine.fingerprint(type(run).__module__)
    return hashlib.sha256(f'{run!r}{inputs}{code}'.encode()).hexdigest()[:24]


def keep(path: Path, result: Result, mark: str) -> None:
    """Write ``result`` and its fingerprint ``mark`` to an npz."""
    values = json.dumps(result.values, allow_nan=False)
    with new_file(path, overwrite=True) as file:
        np.savez_compressed(file, values=values, mark=mark, **{
            f'arrays/{name}': array for name, array in result.arrays.items()})


def recall(path: Path, mark: str) -> Result | None:
    """Return what was kept under the fingerprint ``mark``, None if there is no such file."""
    try:
        with read_npz(path, 'a kept run') as file:
            if str(file['mark']) != mark:
                return None
            arrays = {name.removeprefix('arrays/'): array for name, array in file.items()
                      if name.startswith('arrays/')}
            return Result(json.loads(str(file['values'])), arrays)
    except BadInput:
        return None

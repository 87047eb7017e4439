# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A wing's state on disk: every array bit for bit, in one npz with its case YAML inside."""

import dataclasses
from pathlib import Path

import numpy as np
import yaml

from dewing_sim.files import new_file, read_npz
from dewing_sim.fluid import engines
from dewing_sim.parameters import Case, from_mapping, to_mapping
from dewing_sim.state import State
from dewing_sim.structure.dynamics.step import Motion

FORMAT = 4
RENAMED = {'still_jumps': 'jump_history'}      # since format 3, which is read as well
LATER = ('clipped',)                           # which older files of this format do not hold
SECTIONS = ('flow', 'motion')


def save(path: str | Path, state: State, case: Case) -> None:
    """Write ``state`` and ``case`` to ``path``, which is replaced at once or not at all."""
    arrays = {'format': FORMAT, 'case': yaml.safe_dump(to_mapping(case), sort_keys=False)}
    for field in dataclasses.fields(State):
        value = getattr(state, field.name)
        if field.name in SECTIONS:
            for part in dataclasses.fields(value):
                arrays[f'{field.name}.{part.name}'] = getattr(value, part.name)
        else:
            arrays[field.name] = value
    with new_file(path, overwrite=True) as file:
        np.savez(file, **arrays)


def load(path: str | Path) -> State:
    """Return the state saved at ``path``; raise `BadInput` if there is none."""
    return _read(path)[0]


def load_case(path: str | Path) -> Case:
    """Return the case of the wing whose state is saved at ``path``."""
    return _read(path)[1]


def _read(path: str | Path) -> tuple[State, Case]:
    with read_npz(path, 'a saved wing state') as arrays:
        arrays = {RENAMED.get(name, name): array for name, array in arrays.items()}
        if arrays.get('format') not in (FORMAT - 1, FORMAT):
            raise ValueError(f"format {arrays.get('format')}, expected {FORMAT}")
        case = from_mapping(Case, yaml.safe_load(str(arrays['case'])))
        values = {'flow': _section(engines.find(case.numerics.engine).state, 'flow', arrays),
                  'motion': _section(Motion, 'motion', arrays)}
        for field in dataclasses.fields(State):
            if field.name not in SECTIONS and (field.name in arrays or field.name not in LATER):
                values[field.name] = _value(arrays[field.name])
        return State(**values), case


def _section(schema: type, name: str, arrays: dict):
    parts = {}
    for field in dataclasses.fields(schema):
        parts[field.name] = _value(arrays[f'{name}.{field.name}'])
    return schema(**parts)


def _value(array):
    return array if array.ndim else array.item()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Print the parameters of a case as the Markdown table of the README."""

from collections.abc import Mapping
from typing import Any

from dewing_sim import parameters
from dewing_sim.parameters import Case


def rows() -> list[str]:
    """Return the lines of the table: name, meaning, unit, range and the paper's value."""
    table = ['| parameter | meaning | unit | range | `paper` |', '|---|---|---|---|---|']
    for name, value, field in parameters.leaves(parameters.load('paper', Case)):
        meta = field.metadata
        table.append(f'| `{name}` | {meta["meaning"]} | {meta["unit"].replace("-", "")} | '
                     f'{_admissible(meta)} | {value} |')
    return table


def _admissible(meta: Mapping[str, Any]) -> str:
    if 'options' in meta:
        return ', '.join(f'`{option}`' for option in meta['options'])
    return f'{meta["low"]:g} to {meta["high"]:g}' if 'low' in meta else ''


if __name__ == '__main__':
    print('\n'.join(rows()))

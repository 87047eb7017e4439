# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Print the parameters of a case and of the nodes as the Markdown tables of the documents."""

from collections.abc import Mapping
from typing import Any

from dewing_sim import parameters
from dewing_sim.parameters import Case
from dewing_sim.settings import SimulatorSettings


def rows() -> list[str]:
    """Return the lines of the table: name, meaning, unit, range and the paper's value."""
    return _table('paper', parameters.load('paper', Case))


def node_rows(schema: type, configuration: str) -> list[str]:
    """Return the same for the parameters of a node with its shipped ``configuration``."""
    return _table('default', parameters.load(configuration, schema))


def _table(title: str, section: Any) -> list[str]:
    table = [f'| parameter | meaning | unit | range | `{title}` |', '|---|---|---|---|---|']
    for name, value, field in parameters.leaves(section):
        meta = field.metadata
        table.append(f'| `{name}` | {meta["meaning"]} | {meta["unit"].replace("-", "")} | '
                     f'{_admissible(meta)} | {value} |')
    return table


def _admissible(meta: Mapping[str, Any]) -> str:
    if 'options' in meta:
        return ', '.join(f'`{option}`' for option in meta['options'])
    return f'{meta["low"]:g} to {meta["high"]:g}' if 'low' in meta else ''


if __name__ == '__main__':
    print('\n'.join([*rows(), '', *node_rows(SimulatorSettings, 'simulator')]))

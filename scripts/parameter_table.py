# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Print the parameters of a case as the Markdown table of the README."""

from dewing_sim import parameters
from dewing_sim.parameters import Case


def rows() -> list[str]:
    """Return the lines of the table: name, meaning, unit, range and the paper's value."""
    paper = parameters.to_mapping(parameters.load('paper'))
    table = ['| parameter | meaning | unit | range | `paper` |', '|---|---|---|---|---|']
    for name, field in parameters.fields(Case):
        meta = field.metadata
        section, key = name.split('.')
        admissible = (', '.join(f'`{option}`' for option in meta['options'])
                      if 'options' in meta else f'{meta["low"]:g} to {meta["high"]:g}')
        value = paper[section][key]
        table.append(f'| `{name}` | {meta["meaning"]} | {meta["unit"].replace("-", "")} | '
                     f'{admissible} | {value} |')
    return table


if __name__ == '__main__':
    print('\n'.join(rows()))

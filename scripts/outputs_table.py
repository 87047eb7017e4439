# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Write docs/outputs.md from the fields of `Outputs`: ``python scripts/outputs_table.py``."""

from pathlib import Path

from dewing_sim.plant import Outputs
from dewing_sim.quantities import Quantity, schema

PAGE = Path(__file__).parents[1] / 'docs' / 'outputs.md'
HEAD = """# Outputs

Written by `python scripts/outputs_table.py` from the fields of `Outputs` in
[plant.py](../dewing_sim/plant.py); `test/project/test_outputs_page.py` compares it with them.
Loads and the capacitance are per unit span. Numbers are kept at each step, shapes every few steps.

* What is measured goes to controllers and into the message `measurement`, in this order.
* What is recorded is a column or a shape of a `History` and of its npz file.
* What has a topic is published there for people to watch, besides.
* What responds to V^2 may be identified, and be an output of a reduced plant.

A plant does not have every output: a reduced one has those of its model. What it does not have is
absent: None in `Outputs`, no name in a message, no column in a file. No number stands for it.
Files of version 0.1 have neither electric field nor capacitance.
[A plant of your own](howto/output.md) may have more.

| output | unit | meaning | kind | measured | recorded | responds | topic |
|---|---|---|---|---|---|---|---|
"""


def page() -> str:
    """Return the text of the page."""
    return HEAD + ''.join(map(row, schema(Outputs).quantities))


def row(each: Quantity) -> str:
    """Return the line of one output."""
    kind = 'shape' if each.is_shape else {float: 'number', int: 'count'}[each.kind]
    cells = [f'`{each.name}`', each.unit, each.meaning, kind,
             *('yes' if said else '' for said in (each.measured, each.recorded, each.responds)),
             f'`{each.topic}`' if each.topic else '']
    return f'| {" | ".join(cells)} |\n'


if __name__ == '__main__':
    PAGE.write_text(page(), encoding='utf-8')

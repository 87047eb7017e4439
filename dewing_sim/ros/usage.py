# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What ``dewing_simulator --help`` and its like print, and what they make of other words."""

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from dewing_sim import parameters

TYPES = {float: 'double', int: 'integer', str: 'string', bool: 'bool'}
EXAMPLES = {
    'simulator': (
        'ros2 run dewing simulator --ros-args -p case:=soft -p run.duration:=0.4',
        'dewing_simulator --ros-args -p run.mode:=free -p run.subscribers:=0 -p flow.speed:=2.5',
        'dewing_simulator --ros-args -r __ns:=/wing2 -p run.publish_clock:=false'),
    'controller': (
        'ros2 run dewing controller --ros-args -p reference.target:=1.05',
        'dewing_controller --ros-args --params-file controller.yaml -p command.subscribers:=2'),
    'sysid': (
        'ros2 run dewing sysid --ros-args -p output:=model.npz -p realisation.order:=12',
        'dewing_sysid --ros-args -p begin:=on_request'),
    'recorder': ('dewing_recorder --ros-args -p output:=run.mcap',),
}


def answer(make: Any, args: Sequence[str] | None, shipped: Callable[[], Iterable[Any]],
           ) -> int | None:
    """Print the page for ``make`` if ``args`` ask for it; return the exit status, or None.

    ``shipped()`` gives the sections of its parameters. Other words before ``--ros-args`` are
    refused with one sentence.
    """
    words = list(sys.argv[1:] if args is None else args)
    own = words[:words.index('--ros-args')] if '--ros-args' in words else words
    if {'-h', '--help'} & set(own):
        print('\n'.join(page(make, shipped())))
        return 0
    if own and args is None:
        print(f'dewing: {own[0]} is not understood; parameters are given as in '
              '--ros-args -p NAME:=VALUE, and --help lists them', file=sys.stderr)
        return 2
    return None


def page(make: Any, sections: Iterable[Any]) -> Iterator[str]:
    """Yield the lines that explain a node: how to start it, and every parameter."""
    name = make.__name__.removesuffix('Node').lower()
    yield f'usage: dewing_{name} [--help] [--ros-args [-p NAME:=VALUE] [--params-file FILE] ' \
          '[-r FROM:=TO]]'
    yield f'\n{make.__doc__.strip().splitlines()[0]}\n'
    yield 'examples:'
    yield from (f'  {example}' for example in EXAMPLES.get(name, ()))
    yield '\nparameters, with type and default, meaning, unit and range:'
    for section in sections:
        for leaf, value, field in parameters.leaves(section):
            kind = TYPES[field.metadata['type']]
            yield f'  {leaf}  ({kind}, {value!r})\n      {parameters.describe(field)}'

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Options that commands share, and what they mean."""

import argparse
import math
import warnings
from pathlib import Path
from typing import Any, Callable

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines
from dewing_sim.fluid.choice import AUTO
from dewing_sim.inputs.disturbance import DISTURBANCES
from dewing_sim.machine.jobs import Workers
from dewing_sim.parameters import Case, Numerics
from dewing_sim.schema.numerals import apart, not_above
from dewing_sim.schema.plugins import is_plugin

NUMERICS = {'engine': 'numerics.engine', 'grid': 'numerics.grid', 'dt': 'numerics.time_step'}
REAL_TIME = 'realtime'      # the shipped case that keeps up with the air
TIMES = 1.5                 # its time step over one that takes noticeably longer


def add_case(parser: argparse.ArgumentParser) -> None:
    """Declare --case, --set and --disturbance."""
    group = parser.add_argument_group('case')
    group.add_argument('--case', default='paper', metavar='NAME|FILE',
                       help='shipped case or YAML file (default: paper)')
    group.add_argument('--set', action='append', default=[], metavar='SECTION.KEY=VALUE',
                       help='change one parameter; may be repeated')
    group.add_argument('--disturbance', metavar='NAME',
                       help=f'{", ".join(DISTURBANCES)} (default: as in the case)')


def add_numerics(parser: argparse.ArgumentParser, time: str) -> None:
    """Declare --engine, --grid, --dt and --duration, in units of ``time``."""
    group = parser.add_argument_group('numerics')
    for name in ('engine', 'grid'):
        group.add_argument(f'--{name}', metavar='NAME',
                           help=parameters.describe(numerics_field(name)))
    group.add_argument('--dt', type=float, metavar=time.upper(), help=f'time step in {time}')
    group.add_argument('--duration', type=float, metavar=time.upper(),
                       help=f'simulated time in {time}')


def add_results(parser: argparse.ArgumentParser, out: str | None = None) -> None:
    """Declare --json, --force and --quiet, and --out with the help text ``out``."""
    group = parser.add_argument_group('results')
    if out:
        group.add_argument('--out', metavar='PATH', help=out)
    group.add_argument('--json', metavar='FILE', help='write the metrics as JSON')
    group.add_argument('--force', action='store_true', help='write over existing files')
    group.add_argument('--quiet', action='store_true', help='no progress and no table')


def add_workers(parser: argparse.ArgumentParser, default: str = '2') -> None:
    """Declare --jobs, with its ``default`` in words, and --scheduler."""
    where = parser.add_argument_group('workers').add_mutually_exclusive_group()
    where.add_argument('--jobs', type=int, metavar='N',
                       help=f'processes of this machine (default: {default})')
    where.add_argument('--scheduler', metavar='ADDRESS',
                       help='run on the dask cluster there, such as tcp://host:8786')


def workers(arguments: argparse.Namespace, default: Callable[[], int] = lambda: 2) -> Workers:
    """Return where to run what `add_workers` was told; raise `BadInput` if --jobs is no number."""
    if arguments.jobs is not None:
        within('--jobs', arguments.jobs, 1, 1024, 'processes')
    return Workers(arguments.jobs or default(), arguments.scheduler)


def numerics_field(option: str) -> Any:
    """Return the field of `Numerics` that an option of `add_numerics` sets."""
    name = NUMERICS[option].partition('.')[2]
    return Numerics.__dataclass_fields__[name]


def check_engine(name: str, *more: str) -> None:
    """Raise `BadInput` unless ``name`` is an engine, one from outside or one of ``more``."""
    if not is_plugin(name):
        one_of('--engine', name, dict.fromkeys((*engines.NAMES, *more)))


def load_case(arguments: argparse.Namespace) -> Case:
    """Return the case with every option applied; raise `BadInput` for anything unusable."""
    changes = dict(map(parameters.parse_assignment, arguments.set))
    for option, name in NUMERICS.items():
        value = getattr(arguments, option)
        if value is not None:
            changes[name] = value
    if arguments.disturbance is not None:
        changes |= one_of('--disturbance', arguments.disturbance, DISTURBANCES)
    case = parameters.load(arguments.case, Case, changes)
    if arguments.grid is not None and not arguments.quiet:
        _say_cost(case)
    return case


def _say_cost(case: Case) -> None:
    """Warn of a time step that is a small part of what the grid for real time bears."""
    real_time = parameters.load(REAL_TIME).numerics
    wanted, given = case.numerics, real_time.time_step / case.numerics.time_step
    meant = wanted.engine in (real_time.engine, AUTO) and wanted.grid == real_time.grid
    if meant and given > TIMES:
        warnings.warn(
            f'numerics.grid = {wanted.grid} is made for steps of {real_time.time_step:g} s: '
            f'{wanted.time_step:g} s takes {given:.3g} times as many, '
            f'{1.0 / wanted.time_step:.0f} for a second of flight; --case {REAL_TIME} has both',
            RuntimeWarning, stacklevel=3)


def read_files(*names: str | None) -> list[Path]:
    """Return the files behind the ``names`` of configurations, shipped or not; None is none."""
    return [parameters.config_file(name) for name in names if name is not None]


def one_of(option: str, name: str, table: dict) -> Any:
    """Return ``table[name]``; raise `BadInput` for a name that is not there."""
    if name not in table:
        raise BadInput(f'{option} {name} is not known; one of {", ".join(table)}')
    return table[name]


def within(option: str, value: float, low: float, high: float, unit: str) -> float:
    """Return ``value`` if it lies from ``low`` to ``high``; raise `BadInput` otherwise."""
    if not low <= value <= high:
        shown, nearest = apart(value, low if value < low else high)
        first, last = (nearest, f'{high:g}') if value < low else (f'{low:g}', nearest)
        raise BadInput(f'{option} {shown} is out of range: from {first} to {last} {unit}')
    return value


def check_skip(skip: float | None, steps: int, dt: float, unit: str) -> None:
    """Raise `BadInput` unless at least the last of ``steps`` is left to be averaged."""
    if skip is not None and not (0.0 <= skip < (steps - 0.5) * dt):
        most = not_above((steps - 1) * dt)
        raise BadInput(f'--skip {skip:.10g} is out of range: from 0 to {most} {unit}, a time step '
                       'before the end')


def steps_of(duration: float, dt: float, unit: str) -> int:
    """Return the number of steps in ``duration``; raise `BadInput` if it is less than one."""
    if not (math.isfinite(duration) and duration >= dt):
        shown, step = apart(duration, dt)
        raise BadInput(f'--duration {shown} {unit} is out of range: at least one time step of '
                       f'{step} {unit}')
    return round(duration / dt)

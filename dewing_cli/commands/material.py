# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Show what the dielectric elastomer of a case can do, without any flow.

Prints tension, limits and static camber under a uniform pressure; --out gets the figures of
docs/material.md: stress against stretch, tension against voltage, the voltage-stretch curve of a
free sheet with its pull-in, and static camber against voltage of both elements. A curve that
cannot be computed is named at the end, with exit status 1; the others are delivered.

--coupled compares both elements in the coupled wing instead, at rest and after a pulse of V^2, in
per cent of the membrane's: about three minutes on one core.
"""

import argparse
from collections.abc import Mapping

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim.errors import RunFailed
from dewing_sim.parameters import Case

VOLTAGES = [0.0, 400.0, 800.0]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    parser.add_argument('--lift', type=float, default=0.39, metavar='CL',
                        help='lift coefficient of the uniform pressure (default: 0.39)')
    parser.add_argument('--coupled', action='store_true',
                        help='compare solid and membrane elements in the coupled wing')
    parser.add_argument('--voltages', type=float, nargs='+', metavar='V',
                        help=f'of --coupled (default: {" ".join(f"{v:g}" for v in VOLTAGES)})')
    options.add_results(parser, 'folder of the figures')
    parser.set_defaults(engine=None, grid=None, dt=None)


def run(arguments: argparse.Namespace) -> None:
    """Compute the curves or the comparison, print the metrics and write what was asked for."""
    options.within('--lift', arguments.lift, 0.0, 5.0, '(lift coefficient)')
    case = options.load_case(arguments)
    if arguments.coupled:
        compare(arguments, case)
    else:
        show(arguments, case)


def show(arguments: argparse.Namespace, case: Case) -> None:
    """Compute, draw and deliver the curves; raise `RunFailed` after that if some failed."""
    from dewing_cli.figures import material as material_figures
    figures = outputs.within(arguments.out, [f'{name}.png' for name in material_figures.DRAWINGS])
    outputs.claim(figures | {'--json': arguments.json}, arguments.force)

    from dewing_sim.structure.material import curves
    pressure = arguments.lift * case.flow.dynamic_pressure
    found = curves.of_section(case.membrane, pressure, case.actuation.voltage_limit)
    if arguments.out:
        material_figures.save(found, arguments.out, arguments.force)
    results.deliver(arguments, found.metrics())
    _report(found.failures)


def _report(failures: Mapping[str, str]) -> None:
    """Raise `RunFailed` that names what failed, with the reasons."""
    if failures:
        raise RunFailed('not computed: ' + '; '.join(
            f'{name} ({reason})' for name, reason in failures.items()))


def compare(arguments: argparse.Namespace, case: Case) -> None:
    """Compare the elements in the coupled wing and deliver one row a support and voltage.

    Raises `RunFailed` after that if some failed.
    """
    outputs.claim({'--json': arguments.json}, arguments.force)
    voltages = arguments.voltages or VOLTAGES
    for voltage in voltages:
        options.within('--voltages', voltage, 0.0, case.actuation.voltage_limit, 'V')
    from dewing_sim.verification.wing import solid_wing
    rows, failures = [], {}
    with bar('comparing', quiet=arguments.quiet) as progress:
        for row in solid_wing.compare(case, voltages, progress, failures=failures):
            rows.append(row.to_mapping())
    if arguments.json:
        results.write_json(arguments.json, {'coupled': rows}, arguments.force)
    for row in () if arguments.quiet else rows:
        print(f'pinned {row.pop("support")}, {row.pop("voltage"):g} V')
        results.print_table({f'  {name} [%]': 100.0 * value for name, value in row.items()})
    _report(failures)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Show what the dielectric elastomer of a case can do, without any flow.

Prints tension, limits and static camber under a uniform pressure; --out gets the figures of
docs/material.md: stress against stretch, tension against voltage, the voltage-stretch curve of a
free sheet with its pull-in, and static camber against voltage of both elements.
"""

import argparse

from dewing_control import options, results
from dewing_sim.files import check_free


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    parser.add_argument('--lift', type=float, default=0.39, metavar='CL',
                        help='lift coefficient of the uniform pressure (default: 0.39)')
    options.add_results(parser, 'folder of the figures')
    parser.set_defaults(engine=None, grid=None, dt=None)


def run(arguments: argparse.Namespace) -> None:
    """Compute the curves, print the metrics and write what was asked for."""
    options.within('--lift', arguments.lift, 0.0, 5.0, '(lift coefficient)')
    case = options.load_case(arguments)
    from dewing_control import material_figures
    if arguments.json:
        check_free(arguments.json, arguments.force)
    if arguments.out:
        for name in material_figures.DRAWINGS:
            check_free(f'{arguments.out}/{name}.png', arguments.force)

    from dewing_sim.structure import curves
    pressure = arguments.lift * case.flow.dynamic_pressure
    found = curves.of_section(case.membrane, pressure, case.actuation.voltage_limit)
    if arguments.out:
        material_figures.save(found, arguments.out, arguments.force)
    results.deliver(arguments, found.metrics())

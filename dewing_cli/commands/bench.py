# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time a coupled step on every grid preset, and its parts; with --graph the loop through ROS 2.

Each figure is the best of many runs of 20 consecutive steps in one process, in milliseconds, on
as many BLAS and Numba threads as the table says. The parts are timed alone, from one state. rtf is
simulated over wall time. bandwidth_ratio is the time of a step over the time this machine takes
to copy the arrays of one step, nine read and five written.

--graph flies the closed loop of --case (default: realtime) offline, with both nodes in one process
and in two over DDS, at 4 and 8 degrees, and says what a lap takes beyond the wing itself. These
are medians inside the running loop; beside them stand a datagram and raw bytes over DDS to another
process and back, which no lap can beat.
"""

import argparse
import importlib.util
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.bench.timing import BLOCK, WARM_UP
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('--case', help='case (default: paper, with --graph realtime)')
    parser.add_argument('--set', action='append', default=[], metavar='SECTION.KEY=VALUE',
                        help='change one parameter; may be repeated')
    parser.add_argument('--engine', metavar='NAME',
                        help=f'flow solver: {", ".join(engines.NAMES)} or package.module:Class '
                             '(default: finite_volume, with --graph as in the case)')
    parser.add_argument('--presets', nargs='+', metavar='NAME',
                        help='grid presets (default: all of the engine)')
    parser.add_argument('--steps', type=int, default=400, help='coupled steps (default: 400)')
    parser.add_argument('--graph', action='store_true',
                        help='time the closed loop offline and through ROS 2 instead')
    parser.add_argument('--controller', default='controller', metavar='NAME|FILE',
                        help='what closes the loop of --graph (default: controller)')
    options.add_results(parser)


def run(arguments: argparse.Namespace) -> None:
    """Time the presets, print and write what was found."""
    least = 2 * WARM_UP + 1 if arguments.graph else BLOCK
    options.within('--steps', arguments.steps, least, 10**6, 'steps')
    outputs.claim({'--json': arguments.json}, arguments.force)
    found = {'machine': machine()} | (
        graph(arguments) if arguments.graph else presets(arguments))
    if arguments.json:
        results.write_json(arguments.json, found, arguments.force)


def presets(arguments: argparse.Namespace) -> dict[str, Any]:
    """Time the grid presets and print each when it is done."""
    from dewing_cli.bench.presets import time_preset
    engine = arguments.engine or 'finite_volume'
    changes = dict(map(parameters.parse_assignment, arguments.set))
    found = {}
    for preset in chosen_presets(engine, arguments.presets):
        found[preset] = time_preset(
            arguments.case or 'paper', engine, preset, arguments.steps, changes)
        if not arguments.quiet:
            print(preset)
            flat = found[preset] | found[preset]['parts']
            results.print_table({f'  {key}': flat[key] for key in flat if key != 'parts'})
    return {'engine': engine, 'presets': found}


def graph(arguments: argparse.Namespace) -> dict[str, Any]:
    """Time the closed loop of a case, and print a table."""
    from dewing_cli.bench.report import measure, print_report
    from dewing_control.settings import ControllerSettings
    if importlib.util.find_spec('rclpy') is None:
        raise BadInput('--graph needs ROS 2, which this environment does not have')
    if arguments.presets:
        raise BadInput('--graph takes no --presets: set numerics.grid')
    changes = dict(map(parameters.parse_assignment, arguments.set))
    if arguments.engine:
        changes['numerics.engine'] = arguments.engine
    case = parameters.load(arguments.case or 'realtime', parameters.Case, changes)
    settings = parameters.load(arguments.controller, ControllerSettings)
    found = measure(case, settings, arguments.steps, arguments.quiet)
    if not arguments.quiet:
        print_report(found)
    return found


def chosen_presets(engine: str, names: list[str] | None) -> list[str]:
    """Return the presets to time; raise `BadInput` for an unknown engine or preset."""
    options.check_engine(engine)
    known = engines.find(engine).grids
    for preset in names or []:
        options.one_of('--presets', preset, dict.fromkeys(known))
    return names or list(known)


def machine() -> dict[str, Any]:
    """Return what the figures depend on beside the code."""
    import os
    import platform

    import numba
    return {'processor': platform.processor() or platform.machine(), 'cores': os.cpu_count(),
            'threads': numba.get_num_threads(), 'python': platform.python_version(),
            'numba': numba.__version__}

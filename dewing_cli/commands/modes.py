# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Find the least damped modes of the coupled wing: flow, wake and membrane together.

The wing is held at its voltage until it is steady; differences of short runs about it give the
exact modes, without any identification. A wing that sheds or flutters has a steady state too,
which --base steady solves for, followed up from 4 degrees. Frequencies up to 1/(2 dt) are told
apart. residual and check say how well a mode satisfies its equation, in the Krylov space and by
one step. membrane is its share of the kinetic energy of membrane and air, in plane the share of
the membrane's that is along the chord; modes that are mostly that are listed apart.
--out gets modes.npz and a figure of each mode.
"""

import argparse
from time import perf_counter
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim import parameters
from dewing_sim.parameters import Case

COLUMNS = {'frequency_hz': ('f [Hz]', '.3f'), 'growth_per_s': ('growth [1/s]', '.3f'),
           'damping': ('damping', '.4f'), 'residual': ('residual', '.1e'),
           'check': ('check', '.1e'), 'membrane_share': ('membrane', '.3f'),
           'in_plane_share': ('in plane', '.3f')}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    parser.add_argument('--voltage', type=float, metavar='V',
                        help='held voltage (default: that of the case)')
    options.add_numerics(parser, 's')
    group = parser.add_argument_group('modes')
    group.add_argument('--count', type=int, default=6, help='modes (default: 6)')
    group.add_argument('--vectors', type=int, default=130,
                       help='size of the Krylov space (default: 130)')
    group.add_argument('--period', type=float, default=1.0e-3, metavar='S',
                       help='time over which perturbations are compared, short for modes of the '
                            'membrane, long for those of the wake (default: 0.001)')
    group.add_argument('--base', choices=('settled', 'steady'), default='settled',
                       help='march until the wing is steady, or solve for it (default: settled)')
    group.add_argument('--settle', type=float, default=100.0, metavar='C/U',
                       help='longest march after the trim, convective times (default: 100)')
    options.add_results(parser, 'folder of modes.npz and the figures')


def run(arguments: argparse.Namespace) -> None:
    """Find the modes, then write and print what was found."""
    case = _check(arguments)
    from dewing_sim.modes import modes
    began = perf_counter()
    wing, base = _base(case, arguments)
    with bar('modes', 'vectors', arguments.quiet) as show:
        found = modes.find(wing, base, arguments.period, arguments.vectors, arguments.count, show)
    metrics = {'modes': [mode.metrics() for mode in found.modes],
               'in_plane_modes': [mode.metrics() for mode in found.in_plane],
               'base': _describe(wing, base, found), 'unsettled': found.unsettled,
               'vectors': found.vectors, 'seconds': perf_counter() - began}
    if arguments.out:
        _write(arguments, wing, found)
    if arguments.json:
        results.write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        print_table(metrics)


def _check(arguments: argparse.Namespace) -> Case:
    """Return the case; raise `BadInput` for anything unusable before any work."""
    if arguments.duration is not None:
        from dewing_sim.errors import BadInput
        raise BadInput('--duration has no meaning here; --settle and --period are times')
    from dewing_sim.modes.base_flow import undisturbed
    case = options.load_case(arguments)
    options.within('--count', arguments.count, 1, 100, 'modes')
    options.within('--vectors', arguments.vectors, max(10, arguments.count), 2000, 'vectors')
    options.within('--period', arguments.period, case.numerics.time_step, 1.0, 's')
    options.within('--settle', arguments.settle, 0.0, 1.0e4, 'c/U')
    if arguments.voltage is not None:
        options.within('--voltage', arguments.voltage, 0.0, case.actuation.voltage_limit, 'V')
        case = parameters.replace(case, {'actuation.voltage': arguments.voltage})
    outputs.claim(outputs.within(arguments.out, ['modes.npz', *_figures(arguments.count)])
                  | {'--json': arguments.json}, arguments.force,
                  options.read_files(arguments.case))
    return undisturbed(case)


def _figures(count: int) -> list[str]:
    return [f'mode_{k + 1}.png' for k in range(count)]


def _base(case: Case, arguments: argparse.Namespace) -> tuple[Any, Any]:
    """Return the wing and its steady state."""
    from dewing_sim.modes import base_flow
    if arguments.base == 'steady':
        with bar('steady states', 'angles', arguments.quiet) as show:
            return base_flow.continued(case, show)
    from dewing_sim.wing import Wing
    wing = Wing(case)
    with bar('settling', 'c/U', arguments.quiet) as show:
        return wing, base_flow.settled(wing, arguments.period, arguments.settle, show)


def _describe(wing: Any, base: Any, found: Any) -> dict[str, Any]:
    """Return the steady wing in numbers; residual is its drift within a period."""
    seen = wing.observe(base)
    return {'cl': seen.cl, 'y_star': seen.camber_max / wing.reference_deflection,
            'x_c': seen.camber_max_position, 'voltage': wing.case.actuation.voltage,
            'engine': wing.case.numerics.engine, 'grid': wing.case.numerics.grid,
            'time_step': wing.dt, 'residual': found.propagator.drift()}


def _write(arguments: argparse.Namespace, wing: Any, found: Any) -> None:
    """Write the vectors, and a figure of each mode."""
    from pathlib import Path

    import numpy as np

    from dewing_cli.figures import modes as figures
    from dewing_sim.files import new_file
    folder = Path(arguments.out)
    folder.mkdir(parents=True, exist_ok=True)
    with new_file(folder / 'modes.npz', arguments.force) as file:
        np.savez_compressed(file, case_yaml=parameters.to_yaml(wing.case),
                            weight_of_motion=found.propagator.weight,
                            vectors=np.array([mode.vector for mode in found.modes]),
                            **{name: np.array([mode.metrics()[name] for mode in found.modes])
                               for name in (found.modes[0].metrics() if found.modes else ())})
    for name, mode in zip(_figures(len(found.modes)), found.modes):
        with new_file(folder / name, arguments.force) as file:
            figures.figure(wing, found.propagator, mode).savefig(file, format='png')


def print_table(metrics: dict[str, Any]) -> None:
    """Print the steady wing and a row for each mode."""
    base = metrics['base']
    print(f"steady wing: Cl {base['cl']:.4f}, y* {base['y_star']:.4f} at x/c {base['x_c']:.3f}, "
          f"{base['voltage']:g} V ({base['engine']} {base['grid']}, {base['time_step']:g} s)")
    print(''.join(f'{title:>14}' for title, _form in COLUMNS.values()))
    for name, rows in (('', metrics['modes']), ('in the plane', metrics['in_plane_modes'])):
        if name and rows:
            print(name)
        for row in rows:
            print(''.join(f'{row[key]:14{form}}' for key, (_title, form) in COLUMNS.items()))
    if metrics['unsettled']:
        print(f"{metrics['unsettled']} values that are not damped more did not settle within "
              f"{metrics['vectors']} vectors: slow modes of the wake want a longer --period")

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Solve the flow past a rigid flat or cambered plate.

Times are in chords over free-stream speed, t* = t U / c. The flow starts with the expected
circulation; averages and spectra leave out the first --skip of t*.
"""

import argparse
import math
from pathlib import Path
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import Laps, bar, until_interrupted
from dewing_sim.files import new_file
from dewing_sim.fluid import engines
from dewing_sim.schema.plugins import is_plugin


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    group = parser.add_argument_group('plate')
    group.add_argument('--alpha', type=float, required=True, metavar='DEG',
                       help='angle of attack')
    group.add_argument('--camber', type=float, default=0.0, metavar='F',
                       help='camber of the parabola y = 4 F x (1 - x) (default: 0)')
    group.add_argument('--re', type=float, default=2500.0, metavar='RE',
                       help='Reynolds number (default: 2500)')
    options.add_numerics(parser, 't*')
    parser.add_argument('--skip', type=float, metavar='T*',
                        help='leave out the first part of the run (default: half)')
    options.add_results(parser)
    parser.add_argument('--dcp', metavar='FILE', help='write the mean pressure jump as CSV')
    parser.set_defaults(engine='finite_volume', grid='standard', dt=0.004, duration=60.0)


def run(arguments: argparse.Namespace) -> None:
    """March the flow, then write and print the metrics, also of an interrupted run."""
    steps = _check(arguments)

    from dewing_sim.fluid.plate import Plate
    plate = Plate(math.radians(arguments.alpha), arguments.camber, arguments.re, arguments.grid,
                  arguments.dt, arguments.engine)
    loads, laps = [], Laps()
    try:
        with bar('marching', 't*', arguments.quiet) as show:
            for instant in until_interrupted(_march(plate, steps)):
                loads.append(instant)
                laps.add()
                show(len(loads), steps, len(loads) * plate.dt)
    finally:
        if loads:
            _deliver(arguments, plate, loads, laps)


def _check(arguments: argparse.Namespace) -> int:
    """Return the number of steps, with every option checked before any work."""
    options.within('--alpha', arguments.alpha, -15.0, 15.0, 'deg')
    options.within('--camber', arguments.camber, -0.1, 0.1, 'chords')
    options.within('--re', arguments.re, 10.0, 20000.0, '(Reynolds number)')
    options.within('--dt', arguments.dt, 1.0e-6, 0.1, 't*')
    options.check_engine(arguments.engine, 'auto')
    if not is_plugin(arguments.engine):
        options.one_of('--grid', arguments.grid, dict.fromkeys(engines.GRIDS))
    steps = options.steps_of(arguments.duration, arguments.dt, 't*')
    options.check_skip(arguments.skip, steps, arguments.dt, 't*')
    outputs.claim({'--json': arguments.json, '--dcp': arguments.dcp}, arguments.force)
    return steps


def _march(plate: Any, steps: int):
    """Yield the loads after each step; raise `Diverged` if they are not finite."""
    from dewing_sim.errors import Diverged
    state = plate.rest()
    for step in range(steps):
        state = plate.step(state)
        loads = plate.observe(state)
        if not math.isfinite(loads.cl + loads.cd + loads.cm):
            raise Diverged(f'the loads at t* = {(step + 1) * plate.dt:g} are not finite; '
                           f'a smaller --dt may help')
        yield loads


def _deliver(arguments: argparse.Namespace, plate: Any, loads: list, laps: Laps) -> None:
    end = len(loads) * plate.dt
    start = 0.5 * end if arguments.skip is None or arguments.skip >= end else arguments.skip
    late = loads[min(round(start / plate.dt), len(loads) - 1):]
    if arguments.dcp:
        _write_pressure_jump(arguments.dcp, plate, late, arguments.force)
    results.deliver(arguments, _metrics(arguments, plate, late, laps) | {
        'steps': len(loads), 'duration': end, 'averaged_from': start})


def _metrics(arguments: argparse.Namespace, plate: Any, late: list, laps: Laps) -> dict:
    import numba
    import numpy as np

    from dewing_sim.records.spectrum import shedding_lines
    cl, cd, cm = (np.array([getattr(instant, name) for instant in late])
                  for name in ('cl', 'cd', 'cm'))
    lines = shedding_lines(cl, plate.dt)
    return {
        'alpha': arguments.alpha, 'camber': arguments.camber, 're': arguments.re,
        'cl_mean': float(cl.mean()), 'cl_rms': float(cl.std()),
        'cd_mean': float(cd.mean()), 'cd_rms': float(cd.std()),
        'cm_mean': float(cm.mean()),
        'strouhal': lines[0] if lines else None, 'lines': lines,
        'ms_per_step': 1.0e3 * laps.best(), 'threads': numba.get_num_threads(),
        'cells': plate.fluid.cells, 'dt': plate.dt,
        'engine': plate.engine, 'grid': arguments.grid,
    }


def _write_pressure_jump(path: str | Path, plate: Any, late: list, overwrite: bool) -> None:
    """Write x/c and the mean jump of the pressure coefficient, below minus above."""
    import numpy as np
    x = 0.5 * (plate.fluid.columns[1:] + plate.fluid.columns[:-1])
    jump = 2.0 * np.mean([instant.jump for instant in late], axis=0)     # q is rho U^2 / 2
    with new_file(path, overwrite) as file:
        np.savetxt(file, np.column_stack([x, jump]), fmt='%.9g', delimiter=',',
                   header='x,dcp', comments='')

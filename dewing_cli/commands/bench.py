# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time a coupled step on every grid preset, and its parts.

Each figure is the best of many runs of 20 consecutive steps in one process, in milliseconds, on
as many BLAS and Numba threads as the table says. The parts are timed alone, from one state. rtf is
simulated over wall time. bandwidth_ratio is the time of a step over the time this machine takes
to copy the arrays of one step, nine read and five written.
"""

import argparse
from typing import Any, Callable

from dewing_cli import options, outputs, results
from dewing_cli.progress import Laps
from dewing_sim import parameters
from dewing_sim.fluid import engines

BLOCK = 20
ARRAYS_READ, ARRAYS_WRITTEN = 9, 5


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('--case', default='paper', help='case (default: paper)')
    parser.add_argument('--set', action='append', default=[], metavar='SECTION.KEY=VALUE',
                        help='change one parameter; may be repeated')
    parser.add_argument('--engine', default='finite_volume', metavar='NAME',
                        help=f'flow solver: {", ".join(engines.NAMES)} or package.module:Class '
                             '(default: finite_volume)')
    parser.add_argument('--presets', nargs='+', metavar='NAME',
                        help='grid presets (default: all of the engine)')
    parser.add_argument('--steps', type=int, default=400, help='coupled steps (default: 400)')
    options.add_results(parser)


def run(arguments: argparse.Namespace) -> None:
    """Time the presets, print and write what was found."""
    options.within('--steps', arguments.steps, BLOCK, 10**6, 'steps')
    outputs.claim({'--json': arguments.json}, arguments.force)
    changes = dict(map(parameters.parse_assignment, arguments.set))
    presets = {}
    for preset in chosen_presets(arguments):
        presets[preset] = time_preset(
            arguments.case, arguments.engine, preset, arguments.steps, changes)
        if not arguments.quiet:
            print(preset)
            flat = presets[preset] | presets[preset]['parts']
            results.print_table({f'  {key}': flat[key] for key in flat if key != 'parts'})
    if arguments.json:
        results.write_json(arguments.json, {
            'machine': machine(), 'engine': arguments.engine, 'presets': presets},
            arguments.force)


def chosen_presets(arguments: argparse.Namespace) -> list[str]:
    """Return the presets to time; raise `BadInput` for an unknown engine or preset."""
    options.check_engine(arguments.engine)
    known = engines.find(arguments.engine).grids
    for preset in arguments.presets or []:
        options.one_of('--presets', preset, dict.fromkeys(known))
    return arguments.presets or list(known)


def machine() -> dict[str, Any]:
    """Return what the figures depend on beside the code."""
    import os
    import platform

    import numba
    return {'processor': platform.processor() or platform.machine(), 'cores': os.cpu_count(),
            'threads': numba.get_num_threads(), 'python': platform.python_version(),
            'numba': numba.__version__}


def time_preset(case: str, engine: str, preset: str, steps: int,
                changes: dict[str, Any]) -> dict[str, Any]:
    """Return cells, times and their parts of ``case`` on one grid preset of an engine."""
    from dewing_sim.inputs.base import Inputs
    from dewing_sim.wing import Wing
    wing = Wing(parameters.load(case, changes={'numerics.trim_time': 2.0} | changes | {
        'numerics.engine': engine, 'numerics.grid': preset}))
    state = wing.rest()
    v_squared = wing.case.actuation.voltage**2
    laps, passes = Laps(), 0
    for _ in range(steps):
        state = wing.step(state, Inputs(v_squared))
        laps.add()
        passes += state.iterations
    seconds = laps.best(BLOCK)
    cells = wing.fluid.cells
    return {'cells': cells, 'ms_per_step': 1.0e3 * seconds, 'ns_per_cell': 1.0e9 * seconds / cells,
            'rtf': wing.dt / seconds, 'coupling_iterations_mean': passes / steps,
            'bandwidth_ratio': 1.0e3 * seconds / copy_time(cells, steps),
            'parts': time_parts(wing, state, steps)}


def time_parts(wing: Any, state: Any, steps: int) -> dict[str, float]:
    """Return the times (ms) of the parts of a step that can run alone."""
    from dewing_sim.coupling.transfer import wall_of
    fluid, membrane, motion = wing.fluid, wing.membrane, state.motion
    wall = wall_of(fluid, membrane, motion.position, motion.velocity)
    prediction = fluid.predict(state.flow, wall)
    parts = {
        'predict_ms': lambda: fluid.predict(state.flow, wall),
        'correct_ms': lambda: fluid.correct(prediction, wall.velocity),
        'observe_ms': lambda: wing.observe(state),
    }
    parts |= {f'{name}_ms': work for name, work in fluid.parts(state.flow, wall).items()}
    return {name: best(work, steps) for name, work in parts.items()}


def copy_time(cells: int, repetitions: int) -> float:
    """Return milliseconds to read and write the arrays of one step once."""
    import numpy as np
    source = np.ones((ARRAYS_READ, cells))
    target = np.empty((ARRAYS_WRITTEN, cells))

    def stream():
        source.sum()
        target.fill(1.0)
    return best(stream, repetitions)


def best(work: Callable[[], Any], repetitions: int) -> float:
    """Return milliseconds a call of ``work``, best of all runs of `BLOCK` calls."""
    laps = Laps()
    for _ in range(repetitions):
        work()
        laps.add()
    return 1.0e3 * laps.best(BLOCK)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time of a coupled step on every grid preset, and of its parts.

Each figure is the best of many runs of 20 consecutive steps in one process, in milliseconds. The
parts are timed alone, from the same state: one prediction and one completion of the flow step,
and one observation. ``rtf`` is simulated time over wall time.
"""

import argparse
import os
import platform
import time
from typing import Any, Callable

import numba

from dewing_control import results
from dewing_control.progress import Laps
from dewing_sim import interface, parameters
from dewing_sim.files import check_free
from dewing_sim.parameters import Numerics
from dewing_sim.wing import Wing

PRESETS = Numerics.__dataclass_fields__['grid'].metadata['options']
BLOCK = 20


def main() -> None:
    """Time the presets named on the command line; print and write what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--case', default='paper', help='case (default: paper)')
    parser.add_argument('--presets', nargs='+', default=PRESETS, choices=PRESETS)
    parser.add_argument('--steps', type=int, default=400, help='coupled steps (default: 400)')
    parser.add_argument('--json', metavar='FILE', help='write the figures as JSON')
    parser.add_argument('--force', action='store_true', help='write over an existing file')
    arguments = parser.parse_args()
    if arguments.json:
        check_free(arguments.json, arguments.force)
    presets = {}
    for preset in arguments.presets:
        presets[preset] = time_preset(arguments.case, preset, arguments.steps)
        print(preset)
        results.print_table({key: value for key, value in presets[preset].items()
                             if key != 'parts'} | presets[preset]['parts'])
    if arguments.json:
        results.write_json(arguments.json, {'machine': machine(), 'presets': presets},
                           arguments.force)


def machine() -> dict[str, Any]:
    """Return what the figures depend on beside the code."""
    return {'processor': platform.processor() or platform.machine(), 'cores': os.cpu_count(),
            'threads': numba.get_num_threads(), 'python': platform.python_version(),
            'numba': numba.__version__}


def time_preset(case: str, preset: str, steps: int) -> dict[str, Any]:
    """Return cells, times and their parts of ``case`` on one grid preset."""
    wing = Wing(parameters.load(case, changes={
        'numerics.grid': preset, 'numerics.trim_time': 2.0}))
    state = wing.rest()
    v_squared = wing.case.actuation.voltage**2
    laps, passes = Laps(), 0
    for _ in range(steps):
        state = wing.step(state, v_squared)
        laps.add()
        passes += state.iterations
    seconds = laps.best(BLOCK)
    cells = wing.fluid.grid.cells
    return {'cells': cells, 'ms_per_step': 1.0e3 * seconds, 'ns_per_cell': 1.0e9 * seconds / cells,
            'rtf': wing.dt / seconds, 'coupling_iterations_mean': passes / steps,
            'parts': time_parts(wing, state, steps)}


def time_parts(wing: Wing, state: Any, steps: int) -> dict[str, float]:
    """Return the times (ms) of the parts of a step that can run alone."""
    wall = interface.wall_of(wing.fluid.columns, state.motion.position, state.motion.velocity)
    prediction = wing.fluid.predict(state.flow, wall)
    return {
        'predict_ms': best(lambda: wing.fluid.predict(state.flow, wall), steps),
        'correct_ms': best(lambda: wing.fluid.correct(prediction, wall.velocity), steps),
        'observe_ms': best(lambda: wing.observe(state), steps),
    }


def best(work: Callable[[], Any], repetitions: int) -> float:
    """Return milliseconds a call of ``work``, best of all runs of `BLOCK` calls."""
    laps = Laps()
    for _ in range(repetitions):
        work()
        laps.add()
    return 1.0e3 * laps.best(BLOCK)


if __name__ == '__main__':
    began = time.perf_counter()
    main()
    print(f'{time.perf_counter() - began:.0f} s')

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time of a convective unit c/U on one core: this package beside NGSolve and OpenFOAM.

Every solver marches the rigid and the bending plate of `plate` with the first of its time steps,
the largest first, with which Cl is within 1 % of the finest run of the conformal engine (root mean
square over its own, from t* = 0.1).  The last rows are the coupled membrane, which only this
package has: the peers' bending plate, without a membrane and without its coupling passes, is a
lower bound of what it would cost them.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import ngsolve_plate
import numpy as np
import openfoam
import plate

from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.files import check_free
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.inputs.base import Inputs
from dewing_sim.verification.fluid.rigid_flow import march, parabola
from dewing_sim.wing import Wing

DURATION = 0.36             # c/U, half a period of the bending plate
STARTED = 0.1               # c/U after which Cl is compared
TOLERANCE = 0.01
WARM_UP = 3                 # steps, of another order or with a set-up
PEER_STEPS = (0.03, 0.016, 0.008, 0.004, 0.0018)
OWN_STEPS = (('realtime', 0.0203), ('realtime', 0.01015), ('fast', 0.01015), ('standard', 0.00406))
REFERENCE = ('reference', 0.0018)
COUPLED_STEPS = 400
REPEATS = 5

THREADS = ('OPENBLAS_NUM_THREADS', 'OMP_NUM_THREADS', 'NUMBA_NUM_THREADS')

Run = dict[str, Any]


def own(grid: str, dt: float, moving: bool) -> Run:
    """March the conformal engine; the times are the best of `REPEATS` marches."""
    fluid = engines.make('conformal', grid, plate.REYNOLDS, plate.ALPHA, dt)

    def wall(time: float) -> Wall:
        if not moving:
            return Wall.flat(fluid.columns)
        return parabola(fluid.columns, plate.camber(time), plate.camber_rate(time))

    best: Run = {}
    for _ in range(REPEATS):
        rows = [(0.0, np.nan, perf_counter(), process_time())]
        for time, flow in march(fluid, wall, DURATION, 0.0, adapt=False):
            rows.append((time, fluid.loads(flow).cl, perf_counter(), process_time()))
        run = dict(zip(('time', 'cl', 'wall', 'cpu'), np.array(rows[1:]).T))
        if not best or per_unit(run)['wall_s'] < per_unit(best)['wall_s']:
            best = run
    return best | {'grid': grid}


def run_ngsolve(dt: float, moving: bool) -> Run:
    """March NGSolve in a process of its own."""
    done = subprocess.run(
        [sys.executable, ngsolve_plate.__file__, 'moving' if moving else 'fixed', str(dt),
         str(round(DURATION / dt))], check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def run_openfoam(dt: float, moving: bool) -> Run:
    """March OpenFOAM in a folder that is removed again."""
    with tempfile.TemporaryDirectory(prefix='dewing-peers-') as folder:
        return openfoam.run(Path(folder), moving, dt, round(DURATION / dt))


PEERS: dict[str, tuple[Callable[[], bool], Callable[[float, bool], Run], str]] = {
    'ngsolve': (lambda: find_spec('ngsolve') is not None, run_ngsolve, ngsolve_plate.HINT),
    'openfoam': (openfoam.available, run_openfoam, openfoam.HINT),
}


def per_unit(run: Run) -> dict[str, float]:
    """Return wall and CPU seconds of a time c/U."""
    span = run['time'][-1] - run['time'][WARM_UP - 1]
    return {f'{clock}_s': float(run[clock][-1] - run[clock][WARM_UP - 1]) / span
            for clock in ('wall', 'cpu')}


def error(run: Run, reference: Run) -> float:
    """Return the root mean square difference of Cl over that of the reference."""
    time, cl = np.array(run['time']), np.array(run['cl'])
    late = time > STARTED
    exact = np.interp(time[late], reference['time'], reference['cl'])
    with np.errstate(over='ignore', invalid='ignore'):      # a run that has diverged
        return float(np.sqrt(np.mean((cl[late] - exact)**2) / np.mean(exact**2)))


def first_accurate(attempts: list[tuple[float, Callable[[], Run]]], reference: Run,
                   ) -> dict[str, Any]:
    """Return figures of the first of the attempts (dt, run) that is accurate, and of all tried."""
    tried = []
    for dt, attempt in attempts:
        try:
            run = attempt()
        except (subprocess.CalledProcessError, openfoam.Failed, RunFailed) as reason:
            tried.append({'dt': dt, 'failed': str(reason).splitlines()[0]})
            continue
        found = {'dt': dt, 'cl_error': error(run, reference), **per_unit(run)}
        if not np.isfinite(found['cl_error']):
            tried.append({'dt': dt, 'failed': 'diverged'})
            continue
        found |= {'grid': run['grid']} if 'grid' in run else {}
        tried.append(found)
        if found['cl_error'] <= TOLERANCE:
            return found | {'tried': tried}
    return {'tried': tried}


def coupled(case: str, grid: str, dt: float) -> dict[str, Any]:
    """Return the time of the coupled membrane wing, best of runs of 20 steps."""
    wing = Wing(parameters.load(case, changes={
        'numerics.engine': 'conformal', 'numerics.grid': grid, 'numerics.trim_time': 2.0}))
    wing = Wing(parameters.replace(wing.case, {'numerics.time_step': dt * wing.scales.time}))
    state = wing.rest()
    clocks = [(perf_counter(), process_time())]
    for _ in range(COUPLED_STEPS):
        state = wing.step(state, Inputs(wing.case.actuation.voltage**2))
        clocks.append((perf_counter(), process_time()))
    blocks = np.array(clocks)[20:] - np.array(clocks)[:-20]
    wall, cpu = blocks.min(axis=0) / (20 * dt)
    return {'case': case, 'grid': grid, 'dt': dt, 'wall_s': float(wall), 'cpu_s': float(cpu)}


def measure(names: list[str], case: str) -> dict[str, Any]:
    """Return all figures; a peer that is not there is skipped with a message."""
    found: dict[str, Any] = {}
    for moving, kind in ((False, 'rigid'), (True, 'bending')):
        reference = own(*REFERENCE, moving)
        found[kind] = {'dewing': first_accurate(
            [(dt, partial(own, grid, dt, moving)) for grid, dt in OWN_STEPS], reference)}
        for name in names:
            present, run, _ = PEERS[name]
            if present():
                found[kind][name] = first_accurate(
                    [(dt, partial(run, dt, moving)) for dt in PEER_STEPS], reference)
    chosen = found['bending']['dewing']
    found['coupled'] = {'dewing': coupled(case, chosen['grid'], chosen['dt'])}
    return found


def machine() -> dict[str, Any]:
    """Return what the figures depend on beside the code."""
    threads = {name: os.environ.get(name, '') for name in THREADS}
    return {'cores': os.cpu_count(), 'load': os.getloadavg()[0], **threads}


def rows(found: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the table: one row for each solver and problem, with ratios of CPU time."""
    table, wing = [], found['coupled']['dewing']
    for kind in ('rigid', 'bending'):
        for name, figures in found[kind].items():
            row = {'plate': kind, 'solver': name}
            if 'dt' in figures:
                row |= {key: figures[key] for key in ('dt', 'cl_error', 'wall_s', 'cpu_s')}
                row['ratio'] = figures['cpu_s'] / found[kind]['dewing']['cpu_s']
                if kind == 'bending':
                    row['ratio_to_coupled'] = figures['cpu_s'] / wing['cpu_s']
            table.append(row)
    table.append({'plate': 'membrane', 'solver': 'dewing', 'dt': wing['dt'],
                  'wall_s': wing['wall_s'], 'cpu_s': wing['cpu_s']})
    return table


def markdown(table: list[dict[str, Any]]) -> str:
    """Return the table for the documentation."""
    heads = ('plate', 'solver', 'dt', 'cl_error', 'wall_s', 'cpu_s', 'ratio', 'ratio_to_coupled')
    lines = ['| ' + ' | '.join(heads) + ' |', '|' + '---|' * len(heads)]
    for row in table:
        cells = [row.get(head, '-') for head in heads]
        lines.append('| ' + ' | '.join(
            f'{cell:.3g}' if isinstance(cell, float) else cell for cell in cells) + ' |')
    return '\n'.join(lines)


def main() -> None:
    """Measure, print and write what was found."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--peers', nargs='*', choices=list(PEERS), default=list(PEERS))
    parser.add_argument('--case', default='paper', help='coupled case (default: paper)')
    parser.add_argument('--json', metavar='FILE', help='write the figures')
    parser.add_argument('--force', action='store_true', help='replace an existing file')
    arguments = parser.parse_args()
    if arguments.json:
        check_free(arguments.json, arguments.force)
    for name in arguments.peers:
        if not PEERS[name][0]():
            print(f'{name} is skipped. {PEERS[name][2]}')
    found = {'machine': machine(), **measure(arguments.peers, arguments.case)}
    print(markdown(rows(found)))
    if arguments.json:
        Path(arguments.json).parent.mkdir(parents=True, exist_ok=True)
        Path(arguments.json).write_text(json.dumps(found, indent=2), encoding='utf-8')


if __name__ == '__main__':
    main()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compile beforehand what runs need: ``python -m dewing_sim.prepare``.

A few steps of small wings, each kind in a process of its own, call every kernel that the shipped
cases call. What is compiled stays in the cache of this installation; with ``--into FOLDER`` it is
compiled for all processors of the kind `prepared.BASELINE`, and FOLDER is for others to use.
"""

import argparse
import os
import shutil
import sys
import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from dewing_sim import parameters
from dewing_sim.errors import BadInput, DewingError, RunFailed
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine import jobs, kernel_cache, prepared
from dewing_sim.machine.job import SINGLE_THREAD, Failed, Job

STEPS = 3                   # the first have no past; the flow adapts within them


class Kind(NamedTuple):
    """Wings that call the same kernels: changes of a shipped case, and the time to compile."""

    case: str
    changes: dict
    cost: float             # s of a processor, about


CONFORMAL = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
             'numerics.time_step': 5.0e-4}
VOLUMES = {'numerics.engine': 'finite_volume', 'numerics.grid': 'fast'}
KINDS = {
    'conformal': Kind('paper', CONFORMAL, 20.0),
    'finite volumes': Kind('paper', VOLUMES, 11.0),
}


def walk(name: str, into: str | None = None) -> None:
    """Make the steps of a kind."""
    if into:
        os.environ[prepared.VARIABLE] = into
        kernel_cache.write_prepared()
    from dewing_sim.fluid.plate import Plate
    from dewing_sim.rest import trim
    from dewing_sim.wing import Wing
    kind = KINDS[name]
    case = parameters.load(kind.case, changes={**kind.changes})
    wing = Wing(case)
    dt = wing.dt / wing.scales.time
    state = trim.march(Wing(parameters.replace(case, {'numerics.trim_time': STEPS * dt})))
    for _ in range(STEPS):
        state = wing.step(state, Inputs(0.5 * wing.v_squared_slack))
    wing.observe(state)
    wing.measure(state)
    wing.monitor(state)
    wing.caution(replace(state, step=10 ** 6))
    plate = Plate(case.flow.angle_of_attack, grid=case.numerics.grid, dt=dt,
                  engine=case.numerics.engine)
    plate.observe(plate.step(plate.step(plate.rest())))


def prepare(count: int, into: Path | None = None, show=print) -> None:
    """Make all walks, ``count`` at a time; ``show(text)`` hears of each that is done.

    Raises `RunFailed` if one fails.
    """
    began = time.monotonic()
    work = {name: Job(partial(walk, name, into and str(into)), cost=kind.cost)
            for name, kind in KINDS.items()}
    for done, (name, outcome) in enumerate(jobs.results(work, jobs.Workers(count)), 1):
        if isinstance(outcome, Failed):
            raise RunFailed(f'{name}: {outcome}')
        show(f'  compiled {done} of {len(work)}, {name}, after {time.monotonic() - began:.0f} s')


def prepare_baseline(count: int, into: Path, show=print) -> None:
    """Fill ``into`` anew with kernels for the `prepared.BASELINE`; see `prepare`."""
    if into.exists():
        if not (into / prepared.TARGET).is_file() and any(into.iterdir()):
            raise BadInput(f'{into} is in the way: it does not hold prepared kernels')
        shutil.rmtree(into)
    into.mkdir(parents=True)
    os.environ.update(prepared.baseline())          # of the processes that follow
    prepare(count, into, show)
    from llvmlite.binding import get_process_triple
    prepared.write_target(into, (get_process_triple(), prepared.BASELINE, prepared.FEATURES))


def main() -> None:
    """Compile what the command line says."""
    parser = argparse.ArgumentParser(prog='python -m dewing_sim.prepare', description=__doc__)
    parser.add_argument('--jobs', type=int, default=jobs.cores(), metavar='N',
                        help='processes at a time (default: one on each core)')
    parser.add_argument('--into', type=Path, metavar='FOLDER',
                        help='compile for every processor that has AVX2, into FOLDER')
    arguments = parser.parse_args()
    for name in SINGLE_THREAD:
        os.environ.setdefault(name, '1')
    try:
        if arguments.into:
            prepare_baseline(arguments.jobs, arguments.into.resolve())
        else:
            prepare(arguments.jobs)
    except DewingError as error:
        sys.exit(f'dewing_sim.prepare: {error}')


if __name__ == '__main__':
    main()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Runs in processes of their own: what is needed first, then the longest chain."""

import multiprocessing
import os
import signal
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any, Callable, Mapping

from dewing_cli.paper.result import Result, Run
from dewing_sim.errors import DewingError, RunFailed
from dewing_sim.verification.suite import SINGLE_THREAD

GLANCE = 0.3                # s between two looks at the progress


@dataclass(frozen=True)
class Failure:
    """Why there is no result."""

    reason: str


class Stopped(Exception):
    """The command was interrupted; nobody waits for the run any more."""


_stop: Any = None
_done: Any = None


def _begin(stop: Any, done: Any) -> None:
    global _stop, _done
    signal.signal(signal.SIGINT, signal.SIG_IGN)        # the command stops us in order
    _stop, _done = stop, done


def _call(run: Run, inputs: Mapping[str, Result]) -> Result | Failure:
    reported = 0.0

    def tick(share: float) -> None:
        nonlocal reported
        if _stop.is_set():
            raise Stopped
        with _done.get_lock():
            _done.value += (share - reported) * run.cost
        reported = share

    try:
        result = run(tick, inputs)
    except DewingError as error:
        result = Failure(str(error))
    tick(1.0)
    return result


def execute(runs: Mapping[str, Run], known: Mapping[str, Result], jobs: int,
            keep: Callable[[str, Result], None],
            progress: Callable[[float, float], None] = lambda done, total: None,
            ) -> dict[str, Result | Failure]:
    """Return the result or failure of every run; those in ``known`` are not computed again.

    ``keep(name, result)`` is called as soon as a run has finished, so an interrupt, which goes on
    up, loses the unfinished ones only. ``progress(done, total)`` is in units of cost.
    """
    results: dict[str, Result | Failure] = dict(known)
    waiting = {name: run for name, run in runs.items() if name not in known}
    order = sorted(waiting, key=lambda name: -_urgency(name, waiting))
    before = sum(runs[name].cost for name in known)
    total = sum(run.cost for run in runs.values())
    for name in SINGLE_THREAD:          # read when a new process loads its libraries
        os.environ.setdefault(name, '1')
    context = multiprocessing.get_context('spawn')
    stop, done = context.Event(), context.Value('d', 0.0)
    with ProcessPoolExecutor(jobs, context, _begin, (stop, done)) as pool:
        running: dict[Future, str] = {}
        try:
            while order or running:
                _submit(pool, runs, order, running, results, jobs)
                finished, _ = wait(running, GLANCE, FIRST_COMPLETED)
                for future in finished:
                    _collect(running.pop(future), future, results, keep)
                progress(before + done.value, total)
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results


def _urgency(name: str, runs: Mapping[str, Run]) -> float:
    """Return the cost of a run and of the longest chain of runs that wait for it."""
    after = [_urgency(other, runs) for other, run in runs.items() if name in run.needs]
    return runs[name].cost + max(after, default=0.0)


def _submit(pool, runs, order: list[str], running: dict, results: dict, jobs: int) -> None:
    """Start what can be started, most urgent first."""
    for name in list(order):
        needs = runs[name].needs
        broken = [other for other in needs if isinstance(results.get(other), Failure)]
        if broken:
            order.remove(name)
            results[name] = Failure(f'it needs {broken[0]}, which failed')
        elif len(running) < jobs and all(other in results for other in needs):
            order.remove(name)
            inputs = {other: results[other] for other in needs}
            running[pool.submit(_call, runs[name], inputs)] = name


def _collect(name: str, future: Future, results: dict, keep: Callable) -> None:
    try:
        results[name] = future.result()
    except BrokenProcessPool:
        raise RunFailed('a process of the plan was killed; what had finished is kept') from None
    if isinstance(results[name], Result):
        keep(name, results[name])

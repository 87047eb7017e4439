# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs in processes of this machine, one thread each.

A process that is killed takes the pool of `concurrent.futures` with it. The jobs that were running
then run again, one at a time, so that the one whose process is killed every time is told from the
others.
"""

import multiprocessing
import os
import pickle
import signal
import threading
from collections import Counter
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.sharedctypes import RawArray
from typing import Any, Mapping

from dewing_sim.errors import RunFailed
from dewing_sim.machine.job import SINGLE_THREAD, Failed, Job, execute
from dewing_sim.machine.signals import ENDS

CHANCES = 2                 # alone
KILLED = 'its process was killed again and again; perhaps there is too little memory'

_shares: Any = None


def _begin(shares: Any, parent: Any) -> None:
    """Prepare a process: shares are reported to ``shares``, and it ends when ``parent`` closes."""
    global _shares
    _shares = shares
    for number in ENDS:
        signal.signal(number, signal.SIG_IGN)       # the parent ends us in order
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: Any) -> None:
    parent.poll(None)                   # nothing is ever sent: this is the end of the other side
    os._exit(1)


def _call(number: int, pickled: bytes) -> Any:
    """Carry out a job; unpickled here, what has no module in this process is an error of it."""
    def tick(share: float) -> None:
        _shares[number] = share
    job, inputs = pickle.loads(pickled)
    return execute(job, inputs, tick)


class Processes:
    """A `job.Backend`: a pool that is begun anew when one of its processes is killed."""

    def __init__(self, processes: int, jobs: int):
        """Take up to ``processes`` of ``jobs`` jobs at a time."""
        self._processes = processes
        self._context = multiprocessing.get_context('spawn')
        self._shares = RawArray('d', jobs)      # a slot each: no lock that a killed one could hold
        self._running: dict[Future, tuple[int, bytes]] = {}
        self._suspects: list[tuple[int, bytes]] = []
        self._refused: list[tuple[int, Failed]] = []
        self._alone = False
        self._kills: Counter[int] = Counter()      # of jobs that were alone
        for name in SINGLE_THREAD:      # read when a new process loads its libraries
            os.environ.setdefault(name, '1')
        self._open()

    def _open(self) -> None:
        self._mouth, ear = self._context.Pipe(duplex=False)[::-1]
        self._pool = ProcessPoolExecutor(self._processes, self._context, _begin,
                                         (self._shares, ear))

    def room(self) -> int:
        """Return the number of idle processes, none while suspects are tried."""
        if self._suspects or self._alone:
            return 0
        return self._processes - len(self._running)

    def submit(self, number: int, job: Job, inputs: Mapping) -> None:
        """Start a job."""
        try:
            self._start((number, pickle.dumps((job, inputs))))
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            self._refused.append((number, Failed(error, lost=True)))

    def _start(self, work: tuple[int, bytes]) -> None:
        with _without_interrupts():
            self._running[self._pool.submit(_call, *work)] = work

    def finished(self, timeout: float) -> list[tuple[int, Any]]:
        """Return numbers and outcomes of what has finished."""
        outcomes, killed = self._refused, []
        self._refused = []
        done, _ = wait(self._running, 0.0 if outcomes else timeout, FIRST_COMPLETED)
        for future in done:
            work = self._running.pop(future)
            error = future.exception()
            if isinstance(error, BrokenProcessPool):
                killed.append(work)
            else:
                outcomes.append((work[0], Failed(error, lost=True) if error else future.result()))
        if killed:
            outcomes += self._recover(killed)
        elif outcomes:
            self._alone = False
        if self._suspects and not self._running:
            self._alone = True
            self._start(self._suspects.pop(0))
        return outcomes

    def _recover(self, killed: list) -> list[tuple[int, Any]]:
        """Begin a new pool; return the failure of a job that was killed alone too often."""
        killed += self._running.values()
        self._running.clear()
        self.close(False)
        self._open()
        if self._alone:
            self._alone = False
            number = killed[0][0]
            self._kills[number] += 1
            if self._kills[number] == CHANCES:
                return [(number, Failed(RunFailed(KILLED), lost=True))]
        self._suspects += killed
        return []

    def share(self, number: int) -> float:
        """Return the finished share of a job."""
        return self._shares[number]

    def close(self, finished: bool) -> None:
        """End all processes, at once unless they have ``finished``."""
        if not finished:
            self._mouth.close()
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._mouth.close()


@contextmanager
def _without_interrupts():
    """Let processes that are started here inherit that the parent alone hears Ctrl-C."""
    if not hasattr(signal, 'pthread_sigmask'):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)

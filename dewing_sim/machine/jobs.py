# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Many computations at a time, in processes of this machine or on a dask cluster.

A job starts when all that it needs is there, the one that begins the most expensive chain first.
An error on purpose is an outcome like any other; a job whose process is killed, or that raises
what no solver raises on purpose, is lost and named. When the reader of the outcomes stops, also by
Ctrl-C, jobs that have not started are cancelled and those that run are ended.
"""

import os
from dataclasses import dataclass, field
from typing import Any, Callable, Hashable, Iterator, Mapping, TypeVar

from dewing_sim.errors import RunFailed
from dewing_sim.machine.job import Backend, Failed, Job

GLANCE = 0.3                # s between two looks at the progress
Name = TypeVar('Name', bound=Hashable)


@dataclass(frozen=True)
class Workers:
    """``jobs`` processes of this machine, or the dask cluster at the address ``scheduler``."""

    jobs: int = 2
    scheduler: str | None = None

    def open(self, jobs: int) -> Backend:
        """Return a backend for ``jobs`` jobs; raise `BadInput` if the cluster does not answer."""
        if self.scheduler is None:
            from dewing_sim.machine.processes import Processes
            return Processes(min(self.jobs, jobs), jobs)
        from dewing_sim.machine.cluster import Cluster
        return Cluster(self.scheduler)


HERE = Workers(1)


@dataclass
class _Schedule:
    """What waits, what runs and what is there."""

    jobs: Mapping
    outcomes: dict
    order: list = field(default_factory=list)
    running: dict = field(default_factory=dict)         # names by number

    def __post_init__(self):
        waiting = {name: job for name, job in self.jobs.items() if name not in self.outcomes}
        after: dict = {name: [] for name in waiting}
        for name, job in waiting.items():
            for other in job.needs:
                after.get(other, []).append(name)
        urgencies: dict = {}

        def urgency(name: Any) -> float:
            if name not in urgencies:
                urgencies[name] = waiting[name].cost + max(map(urgency, after[name]), default=0.0)
            return urgencies[name]

        self.order = sorted(waiting, key=lambda name: -urgency(name))
        self.numbers = {name: number for number, name in enumerate(self.order)}

    def hopeless(self) -> list[tuple]:
        """Take out what needs something that failed, and return it with its failure."""
        found = []
        for name in list(self.order):
            broken = [other for other in self.jobs[name].needs
                      if isinstance(self.outcomes.get(other), Failed)]
            if broken:
                self.order.remove(name)
                self.outcomes[name] = Failed(RunFailed(f'it needs {broken[0]}, which failed'))
                found.append((name, self.outcomes[name]))
        return found

    def start(self, backend: Backend) -> None:
        """Start what can be started, most urgent first."""
        room, left = backend.room(), []
        for position, name in enumerate(self.order):
            if room <= 0:
                left += self.order[position:]
                break
            needs = self.jobs[name].needs
            if all(other in self.outcomes for other in needs):
                self.running[self.numbers[name]] = name
                backend.submit(self.numbers[name], self.jobs[name],
                               {other: self.outcomes[other] for other in needs})
                room -= 1
            else:
                left.append(name)
        self.order = left

    def collect(self, backend: Backend) -> list[tuple]:
        """Wait a moment, and return what has finished by name."""
        batch = [(self.running.pop(number), outcome)
                 for number, outcome in backend.finished(GLANCE)]
        self.outcomes.update(batch)
        return batch

    def cost(self, backend: Backend) -> float:
        """Return the cost of what has finished, shares of what runs included."""
        done = sum(self.jobs[name].cost for name in self.outcomes if name in self.jobs)
        return done + sum(backend.share(number) * self.jobs[name].cost
                          for number, name in self.running.items())


def run(jobs: Mapping[Name, Job], workers: Workers, known: Mapping[Name, Any] | None = None,
        progress: Callable[[float, float], None] | None = None,
        ) -> Iterator[list[tuple[Name, Any]]]:
    """Yield the outcomes of ``jobs`` by name as they come, all that are there at a time.

    An outcome is a result or `Failed`. What is in ``known`` is not computed again.
    ``progress(done, total)`` is in units of cost. Raises `BadInput` if no scheduler answers.
    """
    schedule = _Schedule(jobs, dict(known or {}))
    total = sum(job.cost for job in jobs.values())
    if not schedule.order:
        return
    backend = workers.open(len(schedule.order))
    complete = False
    try:
        while schedule.order or schedule.running:
            batch = schedule.hopeless()
            schedule.start(backend)
            batch += schedule.collect(backend) if schedule.running else []
            if progress:
                progress(schedule.cost(backend), total)
            if batch:
                yield batch
        complete = True
    finally:
        backend.close(complete)


def results(jobs: Mapping[Name, Job], workers: Workers,
            progress: Callable[[float, float], None] | None = None) -> Iterator[tuple[Name, Any]]:
    """Yield name and outcome as `run` does, one by one; raise the error of what is lost."""
    for batch in run(jobs, workers, progress=progress):
        for name, outcome in batch:
            yield name, found(name, outcome)


def found(name: Any, outcome: Any) -> Any:
    """Return ``outcome``; raise the error of one that is lost."""
    if isinstance(outcome, Failed) and outcome.lost:
        if isinstance(outcome.error, RunFailed):
            raise RunFailed(f'{name}: {outcome}')
        raise outcome.error
    return outcome


def cores() -> int:
    """Return the number of cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:      # not on this system
        return os.cpu_count() or 1


def idle_cores() -> int:
    """Return the number of cores that have nothing to do at present, at least one."""
    count = os.cpu_count() or 1
    return max(1, min(count, round(count + 0.5 - os.getloadavg()[0])))

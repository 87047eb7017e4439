# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The runs of a plan as jobs: results and failures, kept as they come."""

from dataclasses import dataclass
from typing import Callable, Mapping

from dewing_cli.paper.runs.result import Result, Run
from dewing_sim.machine import jobs
from dewing_sim.machine.job import Failed, Job


@dataclass(frozen=True)
class Failure:
    """Why there is no result."""

    reason: str


def execute(runs: Mapping[str, Run], known: Mapping[str, Result], workers: jobs.Workers,
            keep: Callable[[str, Result], None],
            progress: Callable[[float, float], None] | None = None,
            ) -> dict[str, Result | Failure]:
    """Return the result or failure of every run; those in ``known`` are not computed again.

    ``keep(name, result)`` is called as soon as a run has finished, so an interrupt, which goes on
    up, loses the unfinished ones only. ``progress(done, total)`` is in units of cost. Raises
    `RunFailed` if the process of a run is killed again and again.
    """
    results: dict[str, Result | Failure] = dict(known)
    planned = {name: Job(run, run.needs, run.cost, linked=True) for name, run in runs.items()}
    for batch in jobs.run(planned, workers, known, progress):
        for name, outcome in batch:
            if isinstance(jobs.found(name, outcome), Failed):
                results[name] = Failure(str(outcome.error))
            else:
                results[name] = outcome
                keep(name, outcome)
    return results

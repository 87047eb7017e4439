# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""All studies, and how they are run: every computation once, spread over processes."""

import time
from dataclasses import dataclass
from typing import Any, Callable, Sequence

from dewing_sim.errors import DewingError
from dewing_sim.machine.job import Failed, Job
from dewing_sim.machine.jobs import Workers, idle_cores, results
from dewing_sim.verification.fluid import (
    added_mass,
    camber,
    impulsive,
    moving_camber,
    resolution,
    rigid_plate,
    unsteady,
    vortex,
)
from dewing_sim.verification.study import Check, Run, Study
from dewing_sim.verification.wing import coupled, divergence, still_air

STUDIES = tuple(module.STUDY for module in (
    rigid_plate, resolution, vortex, impulsive, added_mass, unsteady, moving_camber, camber,
    still_air, divergence, coupled))


@dataclass(frozen=True)
class Verification:
    """Checks and, by engine and name, the results behind them, study by study."""

    studies: tuple[Study, ...]
    checks: dict[str, list[Check]]              # by name of the study
    results: dict[str, dict[str, dict[str, Any]]]   # by study, engine, run
    quick: bool
    seconds: float

    @property
    def all_checks(self) -> list[Check]:
        """Every check in order."""
        return [check for study in self.studies for check in self.checks[study.name]]

    @property
    def missed(self) -> list[Check]:
        """Checks outside their gates."""
        return [check for check in self.all_checks if not check.passed]


def verify(engines: Sequence[str], quick: bool = False, workers: Workers | None = None,
           progress: Callable | None = None) -> Verification:
    """Run every study on every engine; ``progress(done, total)`` is in units of cost.

    ``workers`` are by default as many processes as there are idle cores. A study of which
    a run fails is a missed gate of its own.
    """
    started = time.perf_counter()
    plan = {(study.name, engine): study.runs(engine, quick)
            for study in STUDIES for engine in engines}
    done = execute({run for runs in plan.values() for run in runs.values()}, workers, progress)
    checks: dict[str, list[Check]] = {}
    results: dict[str, dict[str, dict[str, Any]]] = {}
    for study in STUDIES:
        found, results[study.name] = [], {}
        for engine in engines:
            if runs := plan[study.name, engine]:
                answers = {name: done[run] for name, run in runs.items()}
                if failed := failures(study, engine, answers):
                    found.append(failed)
                    continue
                results[study.name][engine] = answers
                found += study.checks(engine, answers)
        checks[study.name] = found + between_engines(found)
    return Verification(STUDIES, checks, results, quick, time.perf_counter() - started)


def failures(study: Study, engine: str, answers: dict[str, Any]) -> Check | None:
    """Return the missed check of a study some of whose runs failed."""
    failed = {name: answer for name, answer in answers.items() if isinstance(answer, DewingError)}
    if not failed:
        return None
    name, error = next(iter(failed.items()))
    return Check(f'{study.title}: failed runs', engine, len(failed), 0.0, f'{name}: {error}',
                 0.0, 1.0)


def between_engines(checks: list[Check]) -> list[Check]:
    """Return a check of each engine's value against the first engine's, where both exist."""
    first: dict[str, Check] = {}
    pairs = []
    for check in checks:
        other = first.setdefault(check.name, check)
        if other.engine != check.engine and check.scale is None and other.value != 0.0:
            pairs.append(Check(check.name, f'{check.engine} - {other.engine}', check.value,
                               float(other.value), other.engine))
    return pairs


def execute(runs: set[Run], workers: Workers | None = None, progress: Callable | None = None,
            ) -> dict[Run, Any]:
    """Return the result or `DewingError` of each run; the most expensive ones start first."""
    jobs = {run: Job(run, cost=run.cost) for run in sorted(runs, key=repr)}
    return {run: outcome.error if isinstance(outcome, Failed) else outcome
            for run, outcome in results(jobs, workers or Workers(idle_cores()), progress)}

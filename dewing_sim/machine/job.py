# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A computation for a process of its own, what becomes of it, and where such jobs run."""

from dataclasses import dataclass
from typing import Any, Callable, Mapping, Protocol

from dewing_sim.errors import DewingError

SINGLE_THREAD = ('OPENBLAS_NUM_THREADS', 'OMP_NUM_THREADS', 'MKL_NUM_THREADS',
                 'NUMBA_NUM_THREADS')
Tick = Callable[[float], None]          # hears the finished share of a job, 0 to 1


@dataclass(frozen=True)
class Job:
    """``call()`` in a process of its own, or ``call(tick, inputs)`` if ``linked``.

    ``inputs`` holds the results of the jobs named in ``needs``; ``call`` and results must pickle.
    """

    call: Callable
    needs: tuple = ()
    cost: float = 1.0                   # expected time in arbitrary units
    linked: bool = False


@dataclass(frozen=True)
class Failed:
    """Why there is no result. What is ``lost`` has neither a result nor a reason of our own."""

    error: BaseException
    lost: bool = False

    def __str__(self) -> str:
        return ' '.join(str(self.error).split())

    @property
    def reason(self) -> str:
        """Return kind and message of the error."""
        return f'{type(self.error).__name__}: {self}'


def execute(job: Job, inputs: Mapping, tick: Tick = lambda share: None) -> Any:
    """Return the outcome of a job in this process; what is no error of ours is raised."""
    try:
        return job.call(tick, inputs) if job.linked else job.call()
    except DewingError as error:
        return Failed(error)


class Backend(Protocol):
    """Where jobs run; they are numbered."""

    def room(self) -> int:
        """Return how many jobs may be submitted at present."""

    def submit(self, number: int, job: Job, inputs: Mapping) -> None:
        """Start a job, or as soon as there is a free process."""

    def finished(self, timeout: float) -> list[tuple[int, Any]]:
        """Return numbers and outcomes of what has finished, after ``timeout`` s at the latest."""

    def share(self, number: int) -> float:
        """Return the finished share of a running job."""

    def close(self, finished: bool) -> None:
        """End all processes, or forget all jobs; they are in the midst unless ``finished``."""

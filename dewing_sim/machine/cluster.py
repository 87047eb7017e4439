# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs on a running dask cluster. Dask appears here only.

Dask gives a job whose worker died to another one, some times over. It hears nothing of shares.
"""

import time
import warnings
from typing import Any, Mapping

from dewing_sim.errors import BadInput
from dewing_sim.machine.job import Failed, Job, execute

ANSWER, MUSTER = 10.0, 5.0          # s until a scheduler answers, until it has workers
MISSING = "--scheduler needs dask.distributed: pip install 'dewing[sweep]'"
UNLIMITED = 1_000_000


class Cluster:
    """A `job.Backend`: a client of the scheduler at ``address``."""

    def __init__(self, address: str):
        """Connect; raise `BadInput` if no scheduler answers, warn if it has no workers."""
        try:
            from distributed import Client
        except ImportError:
            raise BadInput(MISSING) from None
        try:
            self._client = Client(address, timeout=ANSWER)
        except (OSError, ValueError) as error:      # a time-out is an OSError
            raise BadInput(f'--scheduler {address}: no scheduler answers ({error})') from None
        self._numbers: dict[Any, int] = {}
        self._wait_for_workers(address)

    def _wait_for_workers(self, address: str) -> None:
        deadline = time.monotonic() + MUSTER
        while not self._client.scheduler_info()['workers']:
            if time.monotonic() > deadline:
                warnings.warn(f'--scheduler {address} has no workers yet: nothing is computed '
                              f'until one joins (dask worker {address})', RuntimeWarning,
                              stacklevel=2)
                return
            time.sleep(0.1)

    def room(self) -> int:
        """Return a large number: the scheduler has its own queue."""
        return UNLIMITED

    def submit(self, number: int, job: Job, inputs: Mapping) -> None:
        """Hand a job to the scheduler; earlier ones come first."""
        future = self._client.submit(execute, job, inputs, pure=False, priority=-number)
        self._numbers[future] = number

    def finished(self, timeout: float) -> list[tuple[int, Any]]:
        """Return numbers and outcomes of what has finished."""
        from distributed import TimeoutError as Late
        from distributed import wait
        try:
            done, _ = wait(list(self._numbers), timeout, return_when='FIRST_COMPLETED')
        except Late:
            return []
        return [(self._numbers.pop(future), _outcome(future)) for future in done]

    def share(self, number: int) -> float:
        """Return nothing: a cluster tells of whole jobs only."""
        return 0.0

    def close(self, finished: bool) -> None:
        """Cancel what has not started and leave the cluster to others."""
        if not finished:
            self._client.cancel(list(self._numbers))
        self._client.close()


def _outcome(future: Any) -> Any:
    if future.status == 'finished':
        return future.result()
    error = future.exception() if future.status == 'error' else None
    return Failed(error or RuntimeError('withdrawn by the cluster'), lost=True)

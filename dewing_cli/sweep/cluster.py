# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a sweep on a dask cluster: processes of this machine, or any running one.

Dask appears here only. One thread a process: a step gains nothing from more.
"""

from contextlib import contextmanager
from typing import Any, Iterator, Sequence

from dewing_cli.sweep.sweep import LOST, Point, Result, Sweep, run_point
from dewing_sim.errors import BadInput

CONNECTION_TIMEOUT = 10.0       # s
MISSING_EXTRA = "dewing sweep needs dask.distributed and xarray: pip install 'dewing[sweep]'"


def require_extra() -> None:
    """Raise `BadInput` unless the packages of a sweep are installed."""
    try:
        import distributed  # noqa: F401
        import xarray  # noqa: F401
    except ImportError:
        raise BadInput(MISSING_EXTRA) from None


def run(sweep: Sweep, points: Sequence[Point], jobs: int, scheduler: str | None = None,
        ) -> Iterator[list[tuple[Point, Result]]]:
    """Yield the results of ``points`` as they come, all that are there at a time.

    ``scheduler`` is the address of a running cluster; without it ``jobs`` processes are started.
    A point whose process died, or that raised what no solver raises on purpose, is `LOST`.
    Raises `BadInput` if no scheduler answers. What has not begun is withdrawn when the consumer
    stops.
    """
    from distributed import as_completed
    if not points:
        return
    with _client(min(jobs, len(points)), scheduler) as client:
        futures = {client.submit(run_point, point.case, sweep.duration, sweep.skip, pure=False):
                   point for point in points}
        try:
            for batch in as_completed(futures, raise_errors=False).batches():
                yield [(futures[future], _result(future)) for future in batch]
        finally:
            client.cancel(list(futures))


def _result(future: Any) -> Result:
    if future.status == 'finished':
        return future.result()
    error = future.exception() if future.status == 'error' else 'withdrawn by the cluster'
    return Result(LOST, f'{type(error).__name__}: {" ".join(str(error).split())}', {})


@contextmanager
def _client(jobs: int, scheduler: str | None) -> Iterator[Any]:
    """Open a client of the cluster at ``scheduler``, or of one made for the occasion."""
    from distributed import Client
    if scheduler is None:
        with _processes(jobs) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=CONNECTION_TIMEOUT)
    except (OSError, ValueError) as error:      # a time-out is an OSError
        raise BadInput(f'--scheduler {scheduler}: no scheduler answers ({error})') from None
    with client:
        yield client


def _processes(jobs: int) -> Any:
    """Return a cluster of ``jobs`` processes that leave a Ctrl-C to this one."""
    import logging
    import signal

    from distributed import LocalCluster
    previous = signal.signal(signal.SIGINT, signal.SIG_IGN)     # children inherit it
    try:
        return LocalCluster(n_workers=jobs, threads_per_worker=1, memory_limit=0,
                            dashboard_address='127.0.0.1:0', silence_logs=logging.CRITICAL)
    finally:
        signal.signal(signal.SIGINT, previous)

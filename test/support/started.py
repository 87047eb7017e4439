# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that a test starts and that do not outlive it."""

import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from dewing_sim.machine.signals import kill

PATIENCE = 300.0            # s, for a machine that is busy with other things


@contextmanager
def started(command: Sequence, **options) -> Iterator[subprocess.Popen]:
    """Start ``command`` in a group of its own, which is killed at the end, stopped or not."""
    process = subprocess.Popen(list(command), start_new_session=True, **options)
    try:
        yield process
    finally:
        kill(process)
        for stream in filter(None, (process.stdin, process.stdout, process.stderr)):
            stream.close()


def wait_until(condition: Callable[[], bool], *processes: subprocess.Popen,
               patience: float = PATIENCE) -> None:
    """Wait for ``condition()``; fail at once when one of ``processes`` ends before it holds."""
    deadline = time.monotonic() + patience
    while not condition():
        ended = [process for process in processes if process.poll() is not None]
        # What a process did before it ended counts.
        assert not ended or condition(), (
            f'{ended[0].args} ended with status {ended[0].returncode} before it held')
        assert time.monotonic() < deadline, f'the condition did not hold within {patience:g} s'
        time.sleep(0.05)

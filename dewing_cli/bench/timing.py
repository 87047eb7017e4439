# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Clocks, and the floors that no program on this machine goes below."""

import multiprocessing
import socket
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np

from dewing_cli.progress import Laps

BLOCK, WARM_UP = 20, 100    # consecutive calls of a best time; laps that do not count
ARRAYS_READ, ARRAYS_WRITTEN = 9, 5
DATAGRAM = 256              # bytes, of the order of a measurement


def best(work: Callable[[], Any], repetitions: int) -> float:
    """Return milliseconds a call of ``work``, best of all runs of `BLOCK` calls."""
    laps = Laps()
    for _ in range(repetitions):
        work()
        laps.add()
    return 1.0e3 * laps.best(BLOCK)


def median(work: Callable[[], Any], repetitions: int) -> float:
    """Return milliseconds a call of ``work``, in the median."""
    times = np.empty(repetitions)
    for k in range(repetitions):
        began = perf_counter()
        work()
        times[k] = perf_counter() - began
    return 1.0e3 * float(np.median(times))


def copy_time(cells: int, repetitions: int) -> float:
    """Return milliseconds to read and write the arrays of one step once."""
    source = np.ones((ARRAYS_READ, cells))
    target = np.empty((ARRAYS_WRITTEN, cells))

    def stream():
        source.sum()
        target.fill(1.0)
    return best(stream, repetitions)


def socket_time(repetitions: int) -> float:
    """Return the median milliseconds of a datagram to another process and back."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    with ours, theirs:
        echo = multiprocessing.get_context('spawn').Process(
            target=_echo, args=(theirs, repetitions), daemon=True)
        echo.start()
        data = bytes(DATAGRAM)

        def there_and_back():
            ours.send(data)
            ours.recv(DATAGRAM)
        there_and_back()        # the other process is up now
        found = median(there_and_back, repetitions - 1)
        echo.join()
    return found


def _echo(line: socket.socket, repetitions: int) -> None:
    for _ in range(repetitions):
        line.send(line.recv(DATAGRAM))

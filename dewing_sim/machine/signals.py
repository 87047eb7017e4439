# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Signals that ask for an end: Ctrl-C, SIGTERM and, of a terminal that closes, SIGHUP.

All three end a run in the same order, and what was computed is kept. Schedulers, service managers
and shells often send SIGTERM and SIGHUP twice, or both, so only a second Ctrl-C is impatience.
"""

import os
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from typing import Any

ENDS = tuple(getattr(signal, name) for name in ('SIGINT', 'SIGTERM', 'SIGHUP')
             if hasattr(signal, name))
STATUS = 128                # of a process that a signal ended, plus its number


class Interrupted(KeyboardInterrupt):
    """The end was asked for by the signal ``number``."""

    def __init__(self, number: int):
        super().__init__(signal.Signals(number).name)
        self.number = number


def status_of(error: KeyboardInterrupt) -> int:
    """Return the exit status of a command that ``error`` ended: 130, 143 or 129."""
    return STATUS + getattr(error, 'number', signal.SIGINT)


class Stop:
    """The signals inside a ``with``: `Interrupted` at once, or once ``orderly`` a note.

    rclpy loses an exception that a handler raises while a callback runs, and files want to be
    finished, hence the note. A second Ctrl-C always raises. What was asked of an inner one is
    known to the outer one. A SIGHUP that is ignored, as by ``nohup``, stays so. Python handles
    signals in its main thread: elsewhere this is void.
    """

    def __init__(self, orderly: bool = False):
        """Note the first signal if ``orderly``."""
        self.orderly, self.number = orderly, 0
        self._previous: dict[int, Any] = {}

    @property
    def asked(self) -> bool:
        """Whether the end was asked for."""
        return bool(self.number)

    def check(self) -> None:
        """Raise `Interrupted` if the end was asked for."""
        if self.asked:
            raise Interrupted(self.number)

    def __enter__(self) -> 'Stop':
        if current_thread() is main_thread():
            self._previous = {number: signal.signal(number, self._note) for number in ENDS
                              if number == signal.SIGINT
                              or signal.getsignal(number) is not signal.SIG_IGN}
        return self

    def __exit__(self, *_error):
        for number, handler in self._previous.items():
            outer = getattr(handler, '__self__', None)
            if isinstance(outer, Stop):
                outer.number = outer.number or self.number
            signal.signal(number, handler)

    def _note(self, number, _frame):
        first = not self.asked
        if first:
            self.number = number
        if number == signal.SIGINT and not first or first and not self.orderly:
            raise Interrupted(number)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Put a signal that asks for the end off until the block, such as a save, is done."""
    with Stop(orderly=True) as stop:
        yield
    stop.check()


def end(process: subprocess.Popen, patience: float = 30.0) -> int:
    """Ask a process group to end as Ctrl-C does, kill it after ``patience`` s; return its status.

    ``process`` leads the group. A process that is stopped takes no signal until it is continued.
    """
    if process.poll() is None:
        _send(process, signal.SIGINT)
        _send(process, getattr(signal, 'SIGCONT', signal.SIGINT))
    try:
        return process.wait(patience)
    except subprocess.TimeoutExpired:
        return kill(process)


def kill(process: subprocess.Popen) -> int:
    """Kill the process group that ``process`` leads, stopped or not; return its status."""
    if process.poll() is None:
        _send(process, signal.SIGKILL)
    return process.wait()


def _send(process: subprocess.Popen, number: int) -> None:
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        pass                    # it has ended meanwhile

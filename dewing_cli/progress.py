# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a long run shows and how it stops: a progress bar, step times, an orderly end."""

import sys
import time
from contextlib import contextmanager
from typing import Callable, Iterable, Iterator, TypeVar

from dewing_sim.machine.signals import Stop

Item = TypeVar('Item')


@contextmanager
def bar(label: str, unit: str = 's', quiet: bool = False) -> Iterator[Callable]:
    """Show a progress bar on standard error; yield ``show(done, total, simulated=None)``.

    ``simulated`` is the time reached in ``unit``; with it the bar shows the ratio of simulated to
    wall time. Nothing is shown when ``quiet`` or when standard error is not a terminal.
    """
    if quiet or not sys.stderr.isatty():
        yield lambda done, total, simulated=None: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
    with Progress(TextColumn('{task.description}'), BarColumn(), TextColumn('{task.fields[note]}'),
                  TimeRemainingColumn(compact=True), console=Console(stderr=True),
                  transient=True) as progress:
        task = progress.add_task(label, total=None, note='')
        started = time.perf_counter()

        def show(done: int, total: int, simulated: float | None = None) -> None:
            note = ''
            if simulated is not None:
                rate = simulated / (time.perf_counter() - started)
                note = f'{simulated:.4g} {unit}, {rate:.3g} {unit} per second'
            progress.update(task, completed=done, total=total, note=note)

        yield show


class Laps:
    """Wall times of the steps of a run."""

    def __init__(self):
        """Start the clock."""
        self._instants = [time.perf_counter()]

    def add(self) -> None:
        """Note the end of a step."""
        self._instants.append(time.perf_counter())

    @property
    def total(self) -> float:
        """Seconds from the start to the end of the last step."""
        return self._instants[-1] - self._instants[0]

    def best(self, block: int = 20) -> float:
        """Return seconds per step, best of all runs of ``block`` consecutive steps."""
        block = min(block, len(self._instants) - 1)
        pairs = zip(self._instants, self._instants[block:])
        return min(after - before for before, after in pairs) / block


def until_interrupted(items: Iterable[Item]) -> Iterator[Item]:
    """Yield from ``items``; a signal that asks for the end takes effect between two of them.

    Raises `Interrupted` after the consumer has dealt with the item in hand, on a second Ctrl-C
    at once.
    """
    with Stop(orderly=True) as stop:
        for item in items:
            yield item
            stop.check()

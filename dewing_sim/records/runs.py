# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Stamped messages of named numbers, told apart into runs.

A simulator that is reset, restored or started again stamps from an earlier time on: wherever a
stamp is earlier than the one before it, a run begins, unless the stamps go on at once from where
they were: then a few messages came late.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.records.mcap_file import Losses

JOINTS = 'sensor_msgs/msg/JointState'
UNNAMED = 'do not have one name for each number'
RENAMED = 'have other names than the first of their run'
LATE_ONES = 'come too late, behind those of later stamps'
DECODED = (UNNAMED, RENAMED, LATE_ONES)      # losses among messages that were decoded
LATE = 20       # messages behind others that can be repeats rather than a run
LISTED = 9


@dataclass
class Run:
    """Numbers by name at rising stamps (ns); ``rows`` are in the order of ``names``."""

    names: tuple[str, ...]
    stamps: list[int] = field(default_factory=list)
    rows: list[Sequence[float]] = field(default_factory=list)

    @property
    def span(self) -> float:
        """Time from the first stamp to the last in s."""
        return 1.0e-9 * (self.stamps[-1] - self.stamps[0])

    def missing(self, dt: float) -> int:
        """Return how many steps of ``dt`` (s) between the first and the last there are not."""
        return round(self.span / dt) + 1 - len(self.stamps)

    def series(self) -> dict[str, np.ndarray]:
        """Return ``time`` in s and each quantity by name, each of shape (messages,)."""
        columns = np.array(self.rows, float).T
        return {'time': np.array(self.stamps) * 1.0e-9, **dict(zip(self.names, columns))}

    def __str__(self) -> str:
        return f'{1.0e-9 * self.stamps[0]:g} to {1.0e-9 * self.stamps[-1]:g} s'


class Splitter:
    """Takes the messages of one topic one by one; ``runs`` are those so far."""

    def __init__(self, topic: str, losses: Losses):
        """Count in ``losses`` what is not a message of named numbers."""
        self._topic, self._losses = topic, losses
        self._runs: list[Run] = []
        self._earlier: Run | None = None        # since the stamps went back: perhaps a run

    @property
    def runs(self) -> list[Run]:
        """The runs so far."""
        if self._earlier is None or self._is_late(self._earlier):
            return self._runs
        return [*self._runs, self._earlier]

    def add(self, message: Any) -> None:
        """Append a message; of repeated stamps the first counts."""
        if message.__msgtype__ != JOINTS:
            self._lose(f'are of the type {message.__msgtype__}, not {JOINTS}')
            return
        names = tuple(message.name)
        values = message.position if len(message.position) else message.effort
        if not names or len(set(names)) != len(names) or len(names) != len(values):
            self._lose(UNNAMED)
            return
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        run = self._run_of(stamp, names)
        if not run.stamps or stamp > run.stamps[-1]:
            if set(names) != set(run.names):
                self._lose(RENAMED)
                return
            run.stamps.append(stamp)
            run.rows.append([values[names.index(name)] for name in run.names])

    def _run_of(self, stamp: int, names: tuple[str, ...]) -> Run:
        """Return the run that ``stamp`` is of, or repeats a stamp of; open one if need be."""
        if not self._runs:
            self._runs.append(Run(names))
            return self._runs[-1]
        last, earlier = self._runs[-1], self._earlier
        if earlier and len(earlier.stamps) > LATE:
            self._runs.append(earlier)
            last, self._earlier = earlier, None
        elif earlier and stamp > last.stamps[-1] > earlier.stamps[-1]:
            self._drop(earlier)                 # the run goes on: these were late
            self._earlier = None
        elif earlier and stamp < earlier.stamps[-1]:
            if self._is_late(earlier):
                self._drop(earlier)
            else:
                self._runs.append(earlier)
            last, self._earlier = self._runs[-1], None
        if self._earlier is None and stamp < last.stamps[-1]:
            self._earlier = Run(names)
        return self._earlier or last

    def _is_late(self, earlier: Run) -> bool:
        """Return whether a few messages repeat the inside of the last run."""
        last = self._runs[-1]
        return (len(earlier.stamps) <= LATE and earlier.stamps[0] > last.stamps[0]
                and set(earlier.stamps) <= set(last.stamps))

    def _drop(self, late: Run) -> None:
        """Leave out repeats, as of a second controller that is slower, and count the others."""
        unknown = len(set(late.stamps) - set(self._runs[-1].stamps))
        if unknown:
            self._losses.messages[self._topic, LATE_ONES] += unknown

    def _lose(self, reason: str) -> None:
        self._losses.messages[self._topic, reason] += 1


def split(messages: Iterable[Any], losses: Losses) -> list[Run]:
    """Return the runs in what `bag.read` yields of one topic."""
    splitter = None
    for topic, _, message in messages:
        splitter = splitter or Splitter(topic, losses)
        splitter.add(message)
    return splitter.runs if splitter else []


def choose(runs: Sequence[Run], number: int | None, path: str | Path, topic: str) -> Run:
    """Return run ``number``, counted from 1, or the only one; raise `BadInput` if that is none."""
    if not runs:
        raise BadInput(f'{path}: no messages on {topic}')
    listed = ', '.join(f'{k} ({run})' for k, run in enumerate(runs[:LISTED], start=1))
    listed += ', ...' if len(runs) > LISTED else ''
    if number is None and len(runs) > 1:
        raise BadInput(f'{path}: {topic} has {len(runs)} runs, of which one is to be chosen: '
                       f'{listed}')
    if number is not None and not 1 <= number <= len(runs):
        raise BadInput(f'{path}: {topic} has no run {number}; it has {listed}')
    return runs[(number or 1) - 1]

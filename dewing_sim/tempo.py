# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How fast a run goes, and what the machine would hold: percentiles over a second or so.

A lap begins with a step and ends when the answer to the measurement after it is there. In real
time it has to fit into the time from one step to the next, ``dt / rate``; where it does not, the
answer comes late and is applied a step later than the controller believes.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

TOLERATED = 0.03            # share of late steps or answers
SHORTEST = 0.5              # s of a window
FEWEST = 50                 # steps of a window, for its percentiles to mean something
OLDEST = 10                 # steps: what is older answers nothing of now


class Speed(NamedTuple):
    """What was found in one window; all zero before the first."""

    rtf_now: float = 0.0            # simulated over wall time
    lap_ms_p50: float = 0.0         # from the beginning of a step to the answer
    lap_ms_p99: float = 0.0
    jitter_ms_p50: float = 0.0      # by which a step began later than it was due
    jitter_ms_p99: float = 0.0
    largest_rate: float = 0.0       # simulated over wall time that all but `TOLERATED` would hold


@dataclass
class Tempo:
    """Notes when steps of ``dt`` (s) begin, are made and are answered; all times in s."""

    dt: float
    rate: float = 0.0               # simulated over wall time that is asked for, 0: none
    found: Speed = Speed()
    caution: str = ''               # that the rate is not held, and what would be
    _window: float = 0.0            # when it began
    _began: float = 0.0             # when the present step did
    _open: bool = False             # the present step has no answer yet
    _steps: list[float] = field(default_factory=list)
    _laps: list[float] = field(default_factory=list)
    _jitter: list[float] = field(default_factory=list)
    _late: int = 0                  # steps that began late, or without their answer
    _overdue: int = 0               # steps that began late

    def begin(self, now: float, due: float | None = None) -> None:
        """Note that a step begins ``now``, which was due at ``due`` in real time."""
        if due is not None:
            overdue = now - due > self.dt / self.rate
            self._jitter.append(max(now - due, 0.0))
            self._overdue += overdue
            self._late += overdue or self._open
        self._window = self._window or now
        self._began, self._open = now, True

    def made(self, now: float) -> None:
        """Note that the step has been made, and published with all that goes with it."""
        self._steps.append(now - self._began)

    def answered(self, now: float, steps_ago: int = 0) -> None:
        """Note that the answer to the measurement came, or to one so many steps before it."""
        if steps_ago:
            if steps_ago <= OLDEST and self.rate and self._window:
                self._laps.append(now - self._began + steps_ago * self.dt / self.rate)
            return
        if self._open:
            self._laps.append(now - self._began)
        self._open = False

    def forget(self) -> None:
        """Begin a new window with the next step: the run stood still."""
        self._window, self._late, self._overdue, self._open = 0.0, 0, 0, False
        self._steps, self._laps, self._jitter = [], [], []

    def close(self, now: float) -> None:
        """Find the figures of the window that ends ``now``, and begin another."""
        steps, laps = self._steps, self._laps
        if len(steps) < FEWEST or now - self._window < SHORTEST:
            return
        answered = laps if 2 * len(laps) > len(steps) else []
        needed = max(_percentile(series, 100.0 * (1.0 - TOLERATED))
                     for series in (steps, answered))
        self.found = Speed(
            len(steps) * self.dt / (now - self._window),
            1.0e3 * _percentile(laps, 50.0), 1.0e3 * _percentile(laps, 99.0),
            1.0e3 * _percentile(self._jitter, 50.0), 1.0e3 * _percentile(self._jitter, 99.0),
            self.dt / needed)
        share = (self._late if laps else self._overdue) / len(steps)
        if not self.rate or share <= TOLERATED:
            self.caution = ''
        elif not self.caution:      # the same one until the rate is held again
            self.caution = self._sentence(share, steps, needed)
        still_open = self._open
        self.forget()
        self._open = still_open

    def _sentence(self, share: float, steps: list[float], needed: float) -> str:
        found = self.found
        lap = f', a lap {found.lap_ms_p50:.3g} ms' if found.lap_ms_p50 else ''
        holds = (f'{found.largest_rate:.2g} would hold, or steps of '
                 f'{1.0e3 * needed * self.rate:.3g} ms' if found.largest_rate < self.rate
                 else 'what holds it up is not the run itself')
        return (f'run.rate = {self.rate:g} is not held: {share:.0%} of the steps began late or '
                f'without their answer, which acts when it comes; a step takes '
                f'{1.0e3 * _percentile(steps, 50.0):.3g} ms{lap}; {holds}')


def _percentile(values: list[float], which: float) -> float:
    return float(np.percentile(values, which)) if values else 0.0

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acted in the runs of a bag beside V^2, so that it is not taken for the response to V^2.

The effect of gusts, motions and pressures cancels where the baseline, the run without excitation,
was disturbed in the same way; a run that was disturbed otherwise is refused.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dewing_sim.errors import BadInput
from dewing_sim.records.runs import Run

INPUTS = '/dewing/inputs'
Acting = dict[int, tuple[float, ...]]       # stamp in ns -> values and rates from there on


class Disturbances:
    """Collects, in any order, when runs began and what acted."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._begins: list[tuple[int, int]] = []        # time of arrival and stamp, of first ones
        self._before: int | None = None
        self._acted: list[tuple[int, int, tuple[str, ...], tuple[float, ...]]] = []

    def measured(self, received: int, message: Any) -> None:
        """Note a measurement, which begins a run if its stamp is earlier than the one before."""
        stamp = _stamp(message)
        if self._before is None or stamp < self._before:
            self._begins.append((received, stamp))
        self._before = stamp

    def acted(self, received: int, message: Any) -> None:
        """Note what acts from a stamp on."""
        self._acted.append((received, _stamp(message), tuple(message.name),
                            (*message.position, *message.velocity)))

    def by_run(self, runs: Sequence[Run]) -> list[Acting]:
        """Return what acted in each of ``runs``, nothing where all of it is zero."""
        begins, rest = [], list(self._begins)
        for run in runs:
            while rest and rest[0][1] != run.stamps[0]:
                rest.pop(0)                 # messages that came late, no run
            begins.append(rest.pop(0)[0] if rest else begins[-1] if begins else 0)
        found: list[Acting] = [{} for _ in runs]
        for received, stamp, _names, values in sorted(self._acted):
            number = sum(begin <= received for begin in begins) - 1
            if number >= 0:
                found[number][stamp] = values
        return [acting if any(map(any, acting.values())) else {} for acting in found]

    def names(self, acting: Acting) -> str:
        """Say what acted in a run."""
        known = next(names for _, _, names, values in self._acted if values in acting.values())
        moved = [name for k, name in enumerate(known)
                 if any(values[k] for values in acting.values())]
        return ' and '.join(moved)


def require_cancelled(path: str | Path, found: Disturbances, acting: Sequence[Acting],
                      run: int, baseline: int | None, end: int) -> None:
    """Raise `BadInput` if ``run`` was disturbed until ``end`` (ns) as its baseline was not.

    Both are counted from 1; without a ``baseline`` nothing may have acted.
    """
    own = _until(end, acting[run - 1])
    other = _until(end, acting[baseline - 1]) if baseline else {}
    if own == other:
        return
    disturbed, number = (own, run) if own else (other, baseline)
    raise BadInput(
        f'{path}: {found.names(disturbed)} acted in run {number} from '
        f'{1.0e-9 * min(disturbed):g} s on, and would be taken for the response to V^2: identify '
        'from a run without, or record one at constant V^2 under the same inputs')


def _until(end: int, acting: Acting) -> Acting:
    return {stamp: values for stamp, values in acting.items() if stamp <= end}


def _stamp(message: Any) -> int:
    stamp = message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec

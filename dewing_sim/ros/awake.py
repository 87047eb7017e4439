# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The clock of all patience with others: it stands still while this process does not run."""

from time import monotonic

LONGEST = 1.0               # s that count between two looks


class Awake:
    """Seconds of wall time in which this process ran, as far as it was looked at.

    When a machine sleeps, or all processes are stopped and continued, nobody has had a chance to
    answer, and nobody is to be given up for it. Between two looks at most `LONGEST` counts.
    """

    def __init__(self):
        """Begin at zero."""
        self._last, self._seconds = monotonic(), 0.0

    def __call__(self) -> float:
        """Return the seconds so far."""
        now = monotonic()
        self._seconds += min(now - self._last, LONGEST)
        self._last = now
        return self._seconds

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Garbage collection between the steps of a loop instead of within them."""

import gc
from time import monotonic

PERIOD = 1.0                # s, wall


class Deferred:
    """Inside a ``with`` Python collects only when `look` finds it due, once in `PERIOD`.

    Left alone, the collector runs after so many new objects, whatever is under way, and walks all
    that lives in the process: some 30 ms with Numba and SciPy loaded, a hundred steps. What is
    there at the beginning is therefore left out until the end. An interpreter whose collector is
    off already is left as it is.
    """

    def __init__(self):
        """Defer nothing yet."""
        self._due = 0.0
        self._mine = False

    def __enter__(self) -> 'Deferred':
        self._mine = gc.isenabled()
        if self._mine:
            gc.disable()
            gc.freeze()
        self._due = monotonic() + PERIOD
        return self

    def look(self, now: float) -> None:
        """Collect if it is due at ``now``, a time of `time.monotonic`."""
        if now > self._due and self._mine:
            gc.collect()
            self._due = now + PERIOD

    def __exit__(self, *_error):
        if self._mine:
            gc.unfreeze()
            gc.enable()

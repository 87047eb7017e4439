# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The garbage collector pauses while numba compiles."""

import gc
from functools import cache

from numba.core import event


class _Pause(event.Listener):
    """Keeps the garbage collector from running; compilations are nested."""

    def __init__(self):
        self._depth, self._was_enabled = 0, False

    def on_start(self, compilation: event.Event) -> None:
        if self._depth == 0:
            self._was_enabled = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, compilation: event.Event) -> None:
        self._depth -= 1
        if self._depth == 0 and self._was_enabled:
            gc.enable()


@cache
def prepare() -> None:
    """Let numba compile without garbage collection, which takes an eighth of a first run."""
    event.register('numba:compile', _Pause())

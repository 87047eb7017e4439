# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""While numba compiles the garbage collector pauses, and who waits at a terminal is told why."""

import gc
import sys
from functools import cache

from numba.core import event

from dewing_sim.machine.kernel_cache import KernelCache

NOTE = 'dewing: compiling for this machine what is not there yet; it is kept for the next run'


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


class _Note(event.Listener):
    """Tells a terminal, once, that a kernel of ours is compiled."""

    told = False

    def on_start(self, compilation: event.Event) -> None:
        kernel = compilation.data['dispatcher']
        if self.told or not isinstance(getattr(kernel, '_cache', None), KernelCache):
            return
        self.told = True
        if sys.stderr is not None and sys.stderr.isatty():
            print(NOTE, file=sys.stderr, flush=True)

    def on_end(self, compilation: event.Event) -> None:
        pass


NOTING = _Note()


@cache
def prepare() -> None:
    """Let numba compile without garbage collection, which takes an eighth of a first run."""
    event.register('numba:compile', _Pause())
    event.register('numba:compile', NOTING)

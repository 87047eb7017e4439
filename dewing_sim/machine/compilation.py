# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What numba needs to be told once in a process: when not to collect, and what to compile anew."""

import gc
import re
from functools import cache
from pathlib import Path

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
    """Let numba compile without garbage collection, and nothing that is out of date.

    Collection takes an eighth of the time of a first run.
    """
    event.register('numba:compile', _Pause())
    forget_stale(Path(__file__).parents[1])


def forget_stale(package: Path) -> None:
    """Delete the indices of compiled functions older than any source that is compiled.

    Numba compiles a function anew when its own file has changed, but not when one has that it
    calls: a change of one kernel would have no effect on the step that it is part of.
    """
    changed = max((path.stat().st_mtime for path in package.rglob('*.py')
                   if re.search('numba|kernels import', path.read_text('utf-8'))),
                  default=0.0)
    for index in package.rglob('__pycache__/*.nbi'):
        try:
            if index.stat().st_mtime < changed:
                index.unlink()
        except OSError:
            continue            # gone already, or not ours to delete

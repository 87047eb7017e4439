# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The garbage collector pauses while numba compiles, and a terminal hears of it."""

import gc
import io
import sys

import numba
import pytest
from numba.core import event
from numba.core.errors import TypingError

from dewing_sim.machine import compilation, kernels


class Witness(event.Listener):
    """Notes whether the collector runs when a compilation starts."""

    def __init__(self):
        self.seen = []

    def on_start(self, event):
        self.seen.append(gc.isenabled())

    def on_end(self, event):
        pass


@pytest.mark.parametrize('enabled', [True, False])
def test_collector_pauses_while_functions_compile(enabled):
    compilation.prepare()
    witness = Witness()
    event.register('numba:compile', witness)
    inner = numba.njit(lambda x: x + 1.0)
    outer = numba.njit(lambda x: inner(x) + inner(x))
    (gc.enable if enabled else gc.disable)()
    try:
        assert outer(1.0) == 4.0
        assert gc.isenabled() == enabled
        with pytest.raises(TypingError):
            numba.njit(lambda x: x.nothing)(1.0)
        assert gc.isenabled() == enabled
    finally:
        gc.enable()
        event.unregister('numba:compile', witness)
    assert len(witness.seen) == 3
    assert not any(witness.seen)


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize('stream, said', [(Terminal(), [compilation.NOTE]), (io.StringIO(), [])])
def test_a_terminal_is_told_once_that_kernels_compile(monkeypatch, tmp_path, stream, said):
    monkeypatch.setattr(sys, 'stderr', stream)
    monkeypatch.setattr(numba.config, 'CACHE_DIR', str(tmp_path))       # nothing is there yet
    monkeypatch.setattr(compilation.NOTING, 'told', False)
    compilation.prepare()
    assert numba.njit(lambda x: x + 1.0)(1.0) == 2.0        # a user's own is no affair of ours
    assert not stream.getvalue()
    for make in (lambda x: x + 2.0, lambda x: x + 3.0):
        kernels.kernel(make)(1.0)
    assert stream.getvalue().splitlines() == said

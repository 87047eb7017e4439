# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Garbage is collected between steps, and as before when the loop is over."""

import gc
import weakref

from dewing_sim.machine import garbage


class Ring:
    """Refers to itself, so that only the collector frees it."""

    def __init__(self):
        self.itself = self


def alive():
    return weakref.ref(Ring())


def test_a_ring_made_in_the_loop_lives_until_a_collection_is_due():
    with garbage.Deferred() as collector:
        assert not gc.isenabled() and gc.get_freeze_count() > 0
        ring = alive()
        gc_runs = gc.get_stats()[2]['collections']
        collector.look(0.0)
        assert ring() is not None and gc.get_stats()[2]['collections'] == gc_runs
        collector.look(float('inf'))
        assert ring() is None
    assert gc.isenabled() and gc.get_freeze_count() == 0


def test_an_interpreter_without_a_collector_is_left_alone():
    gc.disable()
    try:
        with garbage.Deferred() as collector:
            ring = alive()
            collector.look(float('inf'))
            assert ring() is not None
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_one_within_another_leaves_the_outer_one_in_charge():
    with garbage.Deferred():
        with garbage.Deferred() as inner:
            ring = alive()
            inner.look(float('inf'))
            assert ring() is not None
        assert not gc.isenabled()
    assert gc.isenabled()

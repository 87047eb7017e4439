# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Runs kept along the way: complete at any moment, gone at the end."""

import numpy as np

from dewing_sim.plant import Outputs
from dewing_sim.records.history import History, Recorder
from dewing_sim.records.partial import Partial, path_of


def outputs(step):
    return Outputs(time=0.1 * step, v_squared=0.0, camber_mean=1.0e-5, camber_max=2.0e-5)


def test_what_is_there_can_be_read_at_any_moment_and_is_gone_at_the_end(tmp_path):
    recorder = Recorder()
    partial = Partial(tmp_path / 'run.npz', recorder, period=0.0)
    for step in range(3):
        recorder.add(outputs(step))
        partial._due = 0.0              # it is time
        partial.keep()
        np.testing.assert_array_equal(History.load(partial.path).time, 0.1 * np.arange(step + 1))
    partial.remove()
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_kept_before_it_is_time_or_of_a_stream(tmp_path):
    recorder = Recorder()
    partial = Partial(tmp_path / 'run.npz', recorder, period=1.0e6)
    recorder.add(outputs(0))
    partial.keep()
    assert not partial.path.exists()
    assert path_of('/dev/null') is None and path_of(None) is None

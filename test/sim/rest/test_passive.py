# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What cambers are relative to: the rest state of a steady wing, the mean of one that sheds."""

import numpy as np
import pytest

from dewing_sim import build, parameters
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import rollout
from dewing_sim.rest import passive
from dewing_sim.wing import Wing

COARSE = {'numerics.grid': 'fast', 'membrane.elements': 32}


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    return tmp_path / 'dewing'


def test_a_steady_wing_has_the_camber_of_its_rest_state(cache):
    case = parameters.load('paper', changes=COARSE | {
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
        'numerics.time_step': 2.0e-4, 'numerics.trim_time': 14.0, 'disturbance.pressure': 0.1})
    built = build.build_wing(case)
    outputs = built.plant.observe(built.rest)
    assert built.identity.camber_mean == outputs.camber_mean
    assert built.identity.camber_max == outputs.camber_max
    kept, = cache.glob('passive-*.npz')
    kept.write_text('broken', encoding='utf-8')
    assert build.build_wing(case).identity == built.identity


def test_a_shedding_wing_has_its_mean_camber(cache):
    wing = Wing(parameters.load('paper_alpha8', changes=COARSE | {
        'numerics.time_step': 2.0e-4, 'numerics.trim_time': 16.0}))
    rest, calls = wing.rest(), []
    mean, largest = passive.camber(wing, rest, lambda *done: calls.append(done))
    assert calls and calls[-1][0] == calls[-1][1]
    steps = round(passive.AVERAGE * wing.scales.time / wing.dt)
    outputs = [found for _, found in rollout(wing, rest, lambda _: Inputs(0.0), steps)]
    assert np.ptp([found.camber_mean for found in outputs]) > 0.05 * mean
    assert mean == pytest.approx(np.mean([found.camber_mean for found in outputs]), rel=2.0e-3)
    assert largest == pytest.approx(np.mean([found.camber_max for found in outputs]), rel=2.0e-3)
    assert passive.camber(wing, rest) == (mean, largest)

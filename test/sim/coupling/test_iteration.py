# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupling iteration: light membranes, good guesses, and what it says when it fails."""

import dataclasses

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import NotConverged
from dewing_sim.inputs.base import Inputs
from dewing_sim.rest import trim
from dewing_sim.wing import Wing


def test_coupling_that_cannot_converge_says_so_and_keeps_the_last_state():
    case = parameters.load('paper', changes={'numerics.grid': 'fast',
                                             'numerics.coupling_iterations': 1,
                                             'numerics.coupling_tolerance': 1.0e-12})
    wing = Wing(case)
    state = trim.start(wing)
    with pytest.raises(NotConverged, match=r'step 1 \(t = 0\.0001 s\): coupling') as caught:
        wing.step(state, Inputs(0.0))
    assert caught.value.state is state


def test_coupling_is_stable_far_below_the_added_mass():
    case = parameters.load('paper', changes={'numerics.grid': 'fast', 'membrane.density': 30.0})
    wing = Wing(case)
    assert wing.membrane.mass.sum() < 0.03          # the first mode's added mass is 0.85 / 2
    state = trim.start(wing)
    passes = []
    for _ in range(60):
        state = wing.step(state, Inputs(0.0))
        passes.append(state.iterations)
    assert max(passes[1:]) <= 5
    assert 0.0 < wing.observe(state).camber_max < 1.0e-3


def test_extrapolated_loads_foresee_the_shape():
    """After a jump of voltage too: what the flow does next is smoother than the motion."""
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'fast', 'numerics.time_step': 5.0e-4,
        'numerics.trim_time': 4.0}))
    knowing = ignorant = trim.march(wing)
    passes = []
    for step in range(12):
        v_squared = 900.0**2 if step > 3 else 0.0
        ignorant = wing.step(dataclasses.replace(knowing, jump_history=np.empty((0, 0))),
                             Inputs(v_squared))
        knowing = wing.step(knowing, Inputs(v_squared))
        passes.append((knowing.iterations, ignorant.iterations))
    assert len(knowing.jump_history) == 3
    ours, theirs = np.sum(passes, axis=0)
    assert ours <= theirs - 8, passes
    assert knowing.motion.position == pytest.approx(ignorant.motion.position, abs=1.0e-6)

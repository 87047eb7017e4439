# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The wing on the conformal engine: its targets, its agreement with the other, restart."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import SCALARS, rollout
from dewing_sim.rest import checkpoint, trim
from dewing_sim.wing import Wing

CONFORMAL = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
             'numerics.time_step': 5.0e-4}


def wing(**changes) -> Wing:
    return Wing(parameters.load('paper', changes={**CONFORMAL, **changes}))


@pytest.fixture(scope='module')
def paper():
    plant = wing()
    return plant, trim.march(plant)


def test_paper_wing_at_rest_meets_its_targets(paper):
    plant, rest = paper
    outputs = plant.observe(rest)
    assert outputs.cl == pytest.approx(0.395, rel=0.015)
    assert outputs.camber_max / plant.reference_deflection == pytest.approx(0.325, rel=0.04)
    assert outputs.camber_max_position == pytest.approx(0.394, abs=0.015)


def test_voltage_raises_camber_and_a_step_needs_few_passes(paper):
    plant, rest = paper
    outputs = [outputs for _, outputs in rollout(plant, rest, lambda _: Inputs(1000.0**2), 200)]
    assert np.mean([instant.camber_mean for instant in outputs]) > 1.5 * plant.observe(
        rest).camber_mean
    assert np.mean([instant.coupling_iterations for instant in outputs]) < 1.7


def test_a_saved_state_continues_bit_for_bit(paper, tmp_path):
    plant, rest = paper
    states = [state for state, _ in rollout(plant, rest, lambda _: Inputs(90000.0), 40)]
    checkpoint.save(tmp_path / 'half.npz', states[19], plant.case)
    fresh = Wing(checkpoint.load_case(tmp_path / 'half.npz'))
    state = checkpoint.load(tmp_path / 'half.npz')
    for _ in range(20):
        state = fresh.step(state, Inputs(90000.0))
    for name, value in vars(states[-1].flow).items():
        assert np.array_equal(value, getattr(state.flow, name)), name
    assert state.flow.slip > 0.0
    direct, restarted = plant.observe(states[-1]), fresh.observe(state)
    assert all(getattr(direct, name) == getattr(restarted, name) for name in SCALARS)


@pytest.mark.parametrize('dt', [1.0e-4, 2.5e-4, 5.0e-4])
def test_coupling_is_stable_for_a_membrane_of_hardly_any_mass(dt):
    plant = wing(**{'numerics.time_step': dt, 'membrane.density': 10.0,
                    'numerics.trim_time': 4.0})
    rest = trim.march(plant)
    heights = [outputs.camber_mean
               for _, outputs in rollout(plant, rest, lambda _: Inputs(0.0), 300)]
    assert np.ptp(heights[-50:]) < 0.1 * np.mean(heights)

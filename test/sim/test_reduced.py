# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The linear plant: exact responses, files, refusals."""

import dataclasses

import numpy as np
import pytest
from reduced_wing import CAMBER, first_mode

from dewing_sim import reduced
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.parameters import config_file
from dewing_sim.plant import rollout
from dewing_sim.reduced import Reduced


def fibonacci() -> Reduced:
    """Return the system whose pulse response is 1, 1, 2, 3, 5, 8, ..."""
    return Reduced(np.array([[0.0, 1.0], [1.0, 1.0]]), np.array([1.0, 1.0]),
                   np.array([[1.0, 0.0]]), 0.5, 0.0, np.zeros(1), ('cl',), 1.0, 1.0)


def test_pulse_response_has_the_markov_parameters():
    plant = fibonacci()
    states = rollout(plant, plant.trim(0.0), lambda outputs: float(outputs.time == 0.0), 8)
    assert [outputs.cl for _, outputs in states] == [1, 1, 2, 3, 5, 8, 13, 21]


def test_no_feed_through_and_time_is_exact():
    plant = first_mode()
    rest = plant.rest()
    after = plant.observe(plant.step(rest, 1.0e6))
    assert plant.observe(rest).camber_mean == CAMBER
    assert after.time == 1.0e-4 and after.v_squared == 1.0e6


def test_trim_is_steady_with_the_static_gain():
    plant = first_mode()
    state = plant.trim(4.0e5)
    camber = plant.observe(state).camber_mean
    assert camber == pytest.approx(CAMBER + 1.56e-11 * 4.0e5, rel=1.0e-12)
    for _, outputs in rollout(plant, state, lambda _: 4.0e5, 100):
        assert outputs.camber_mean == pytest.approx(camber, rel=1.0e-9)


def test_output_disturbance_follows_one_minus_cosine():
    plant = first_mode(disturbance=0.05)
    camber = np.array([outputs.camber_mean
                       for _, outputs in rollout(plant, plant.rest(), lambda _: 0.0, 1000)])
    assert camber[499] == pytest.approx(0.90 * CAMBER, rel=1.0e-12)
    assert camber[-1] == pytest.approx(CAMBER, rel=1.0e-12)


def test_models_and_states_survive_a_file(tmp_path):
    plant = dataclasses.replace(first_mode(disturbance=0.05), extra={'fit': np.array(97.0)})
    reduced.save(tmp_path / 'model.npz', plant)
    again = reduced.load(tmp_path / 'model.npz')
    assert again.extra['fit'] == 97.0 and again.output_names == plant.output_names
    state = plant.step(plant.rest(), 1.0e5)
    plant.save(tmp_path / 'state.npz', state)
    one, other = plant.step(state, 2.0e5), again.step(again.load(tmp_path / 'state.npz'), 2.0e5)
    assert one.step == other.step and np.array_equal(one.x, other.x)


def test_limits_follow_from_the_case_in_the_file(tmp_path):
    plant = fibonacci()
    np.savez(tmp_path / 'model.npz', A=plant.A, B=plant.B[:, None], C=plant.C, D=np.zeros((1, 1)),
             dt=plant.dt, operating_v_squared=0.0, operating_outputs=np.zeros(1),
             output_names=np.array(['cl']), case_yaml=config_file('paper').read_text())
    again = reduced.load(tmp_path / 'model.npz')
    assert again.v_squared_max == 1250.0**2
    assert again.v_squared_slack == pytest.approx(1300.0**2, rel=1.0e-3)


def test_divergence_returns_the_last_good_state():
    plant = dataclasses.replace(fibonacci(), A=np.array([[0.0, 1.0], [1.0e300, 1.0e300]]))
    state = plant.step(plant.step(reduced.State(0, np.zeros(2), 0.0), 1.0), 0.0)
    with pytest.raises(Diverged, match='not finite after step 3') as caught:
        plant.step(state, 0.0)
    assert caught.value.state is state


@pytest.mark.parametrize('change, message', [
    (dict(B=np.ones(3)), r'A must be finite and of shape \(3, 3\)'),
    (dict(C=np.full((1, 2), np.nan)), 'C must be finite'),
    (dict(output_names=('lift',)), "'lift' is not an output"),
    (dict(dt=0.0), 'dt = 0.0 is not positive'),
])
def test_bad_models_are_refused(change, message):
    with pytest.raises(BadInput, match=message):
        dataclasses.replace(fibonacci(), **change)


def test_bad_files_are_refused(tmp_path):
    for content, message in ((dict(D=np.ones(1)), 'D is not zero'),
                             (dict(A=np.eye(2)), 'not a reduced model, B, C')):
        np.savez(tmp_path / 'bad.npz', **content)
        with pytest.raises(BadInput, match=message):
            reduced.load(tmp_path / 'bad.npz')
    (tmp_path / 'text.npz').write_text('no archive')
    with pytest.raises(BadInput, match='cannot be read as npz'):
        reduced.load(tmp_path / 'text.npz')
    with pytest.raises(BadInput, match='No such file'):
        reduced.load(tmp_path / 'absent.npz')

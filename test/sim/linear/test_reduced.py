# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The linear plant: exact responses, files, refusals."""

import dataclasses

import numpy as np
import pytest
from reduced_wing import CAMBER, first_mode

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model
from dewing_sim.linear.reduced import Reduced
from dewing_sim.parameters import config_file
from dewing_sim.plant import Measurement, rollout, units_of


def fibonacci() -> Reduced:
    """Return the system whose pulse response is 1, 1, 2, 3, 5, 8, ..."""
    return Reduced(Model(
        np.array([[0.0, 1.0], [1.0, 1.0]]), np.ones((2, 1)), np.array([[1.0, 0.0]]),
        np.zeros((1, 1)), 0.5, ('cl',), np.zeros(1), 1.0, v_squared_max=1.0))


def test_pulse_response_has_the_markov_parameters():
    plant = fibonacci()
    states = rollout(plant, plant.trim(0.0), lambda outputs: Inputs(float(outputs.time == 0.0)), 8)
    assert [outputs.cl for _, outputs in states] == [1, 1, 2, 3, 5, 8, 13, 21]


def test_no_feed_through_and_time_is_exact():
    plant = first_mode()
    rest = plant.rest()
    after = plant.observe(plant.step(rest, Inputs(1.0e6)))
    assert plant.observe(rest).camber_mean == CAMBER
    assert after.time == 1.0e-4 and after.v_squared == 1.0e6


def test_trim_is_steady_with_the_static_gain():
    plant = first_mode()
    state = plant.trim(4.0e5)
    camber = plant.observe(state).camber_mean
    assert camber == pytest.approx(CAMBER + 1.56e-11 * 4.0e5, rel=1.0e-12)
    for _, outputs in rollout(plant, state, lambda _: Inputs(4.0e5), 100):
        assert outputs.camber_mean == pytest.approx(camber, rel=1.0e-9)


def test_output_disturbance_follows_one_minus_cosine():
    plant = first_mode(disturbance=0.05)
    run = rollout(plant, plant.rest(), lambda _: Inputs(0.0), 1000)
    camber = np.array([outputs.camber_mean for _, outputs in run])
    assert camber[499] == pytest.approx(0.90 * CAMBER, rel=1.0e-12)
    assert camber[-1] == pytest.approx(CAMBER, rel=1.0e-12)


def test_models_and_states_survive_a_file(tmp_path):
    plant = first_mode(disturbance=0.05)
    reduced.save(tmp_path / 'model.npz', plant)
    again = reduced.load(tmp_path / 'model.npz')
    assert again.model.output_names == plant.model.output_names
    assert np.array_equal(again.disturbance, plant.disturbance)
    state = plant.step(plant.rest(), Inputs(1.0e5))
    plant.save(tmp_path / 'state.npz', state)
    one = plant.step(state, Inputs(2.0e5))
    other = again.step(again.load(tmp_path / 'state.npz'), Inputs(2.0e5))
    assert one.step == other.step and np.array_equal(one.x, other.x)


def test_limits_follow_from_the_case_in_the_file(tmp_path):
    model = fibonacci().model
    np.savez(tmp_path / 'model.npz', A=model.a, B=model.b, C=model.c, D=model.d, dt=model.dt,
             operating_v_squared=0.0, operating_outputs=np.zeros(1),
             output_names=np.array(['cl']), case_yaml=config_file('paper').read_text())
    again = reduced.load(tmp_path / 'model.npz')
    assert again.v_squared_max == 1250.0**2
    assert again.v_squared_slack == pytest.approx(1300.0**2, rel=1.0e-3)


def test_divergence_returns_the_last_good_state():
    plant = fibonacci()
    plant = dataclasses.replace(plant, model=dataclasses.replace(
        plant.model, a=np.array([[0.0, 1.0], [1.0e300, 1.0e300]])))
    state = plant.step(plant.step(reduced.State(0, np.zeros(2), 0.0), Inputs(1.0)), Inputs(0.0))
    with pytest.raises(Diverged, match='not finite after step 3') as caught:
        plant.step(state, Inputs(0.0))
    assert caught.value.state is state


@pytest.mark.parametrize('change, message', [
    (dict(output_names=('lift',), units=()), "'lift' is not an output"),
    (dict(output_names=('not a name',), units=('m',)), 'unusable name of an output'),
    (dict(d=np.ones((1, 1))), 'D is not zero'),
])
def test_models_that_are_no_plants_are_refused(change, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = dataclasses.replace(fibonacci().model, **change)
    with pytest.raises(BadInput, match=message):
        Reduced(model)
    model.save('model.npz')
    with pytest.raises(BadInput, match=f'model.npz: reduced model: .*{message}'):
        reduced.load('model.npz')


def test_what_the_model_lacks_is_absent_and_what_it_has_beyond_is_measured():
    """A model may have any output whose unit it says; no zero stands for the others."""
    plant = Reduced(dataclasses.replace(fibonacci().model, output_names=('wake',),
                                        units=('m/s',), operating_outputs=np.array([2.0])))
    outputs = plant.observe(plant.trim(0.0))
    assert outputs.wake == 2.0 and outputs.cl is None and outputs.tension is None
    assert Measurement.of(outputs) == (0.0, 0.0, 2.0)
    assert units_of(outputs) == {'wake': 'm/s'}


def test_a_disturbance_of_another_shape_is_refused():
    with pytest.raises(BadInput, match=r'disturbance must be finite and of shape \(1,\)'):
        Reduced(fibonacci().model, disturbance=np.ones(2))


def test_a_disturbance_too_fast_for_the_time_step_is_refused_with_the_fastest_there_is():
    model = dataclasses.replace(fibonacci().model, dt=5.0e-4)
    with pytest.raises(BadInput, match=r'disturbance_frequency = 2010 Hz .* to 1000 Hz, 1/\(2 dt'):
        Reduced(model, disturbance=np.ones(1), disturbance_frequency=2010.0)
    Reduced(model, disturbance=np.ones(1), disturbance_frequency=1000.0)


def test_a_plant_is_not_written_over_another_without_permission(tmp_path):
    reduced.save(tmp_path / 'model.npz', fibonacci())
    with pytest.raises(BadInput, match='exists'):
        reduced.save(tmp_path / 'model.npz', first_mode())
    reduced.save(tmp_path / 'model.npz', first_mode(), overwrite=True)
    assert reduced.load(tmp_path / 'model.npz').model.output_names[0] == 'camber_mean'


def test_rest_is_the_operating_point_unless_said_otherwise(tmp_path):
    model = dataclasses.replace(first_mode().model, operating_v_squared=1.0e5)
    assert not np.any(Reduced(model).rest().x)
    plant = Reduced(model, rest_v_squared=2.0e5)
    reduced.save(tmp_path / 'model.npz', plant)
    assert np.array_equal(reduced.load(tmp_path / 'model.npz').rest().x, plant.trim(2.0e5).x)


def test_bad_files_are_refused(tmp_path):
    np.savez(tmp_path / 'bad.npz', A=np.eye(2))
    with pytest.raises(BadInput, match='not a linear model'):
        reduced.load(tmp_path / 'bad.npz')
    (tmp_path / 'text.npz').write_text('no archive')
    with pytest.raises(BadInput, match='not a linear model'):
        reduced.load(tmp_path / 'text.npz')
    with pytest.raises(BadInput, match='no such file'):
        reduced.load(tmp_path / 'absent.npz')

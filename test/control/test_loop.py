# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Frequency domain and discretisation against closed forms and python-control."""

import dataclasses

import control
import numpy as np
import pytest
from identified_wing import design_model, identity, reduced_model
from loops import mode, pid

from dewing_control.law.lqg import regulator
from dewing_control.law.registry import law
from dewing_control.model.design import Design, load
from dewing_control.model.loop import Loop, closed_matrix, sensitivity_at
from dewing_control.settings import ControllerSettings
from dewing_control.tuning.judge import step_error
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.linear import reduced
from dewing_sim.linear.state_space import Matrices, frequency_response

KINDS = ('pid', 'periodic', 'lqg')


def settings(kind='pid', **changes):
    changes = {name.replace('__', '.'): value for name, value in changes.items()}
    return parameters.load('controller', ControllerSettings, {'kind': kind, **changes})


def test_pid_is_the_backward_difference_of_python_control():
    """Substitute s = (z - 1)/(T z) in kp + ki/s + kd s/(Tf s + 1), built by python-control."""
    kp, ki, kd, tf, dt = 2.5, 9.7e3, 0.016, 1.15e-4, 1.0e-4
    continuous = (kp + control.tf([ki], [1.0, 0.0]) + control.tf([kd, 0.0], [tf, 1.0]))
    expected = control.sample_system(continuous, dt, method='backward_diff')
    ours = pid(kp, ki, kd, tf, dt).compensator()
    frequency = np.geomspace(1.0, 4.9e3, 60)
    reference = np.array([expected(np.exp(2j * np.pi * f * dt)) for f in frequency])
    np.testing.assert_allclose(frequency_response(ours, frequency, dt)[0], reference, rtol=1.0e-9)


@pytest.mark.parametrize('kind', KINDS)
def test_closed_loop_and_margins_agree_with_python_control(kind):
    model = design_model()
    compensator = law(settings(kind), identity(), model).compensator()
    ours = Loop.of(model, compensator)
    series = model.to_control() * compensator.to_control(model.dt)
    poles = control.feedback(series, 1.0).poles()
    assert np.abs(poles).max() == pytest.approx(np.abs(ours.poles).max(), abs=1.0e-6)
    points = np.array([3.0, 33.0, 333.0])
    expected = series(np.exp(2j * np.pi * points * model.dt))
    measured = model.response(points) * frequency_response(compensator, points, model.dt)[0]
    np.testing.assert_allclose(measured, np.squeeze(expected), rtol=1.0e-6)


def delayed_integrator(gain, dt=1.0e-3):
    """Return the loop L = k/(z (z - 1)), whose delay a compensator brings."""
    return Loop.of(Design.normalised(np.eye(1), np.array([gain]), np.ones(1), dt, 0.0),
                   control.ss(0.0, 1.0, 1.0, 0.0, dt))


def test_margins_of_a_delayed_integrator():
    """At z = exp(iw): arg L = -pi/2 - 3 w/2, |L| = k / 2 sin(w/2), so that k_max = 1 at pi/3."""
    gain = 0.5
    loop = delayed_integrator(gain)
    assert loop.stable and not delayed_integrator(1.01).stable
    crossing = 2.0 * np.arcsin(gain / 2.0)
    assert loop.margins == pytest.approx(
        (20.0 * np.log10(1.0 / gain), 90.0 - np.degrees(1.5 * crossing)), rel=1.0e-4)
    z = np.exp(2j * np.pi * loop.frequency * 1.0e-3)
    by_hand = np.abs(1.0 / (1.0 + gain / (z * (z - 1.0)))).max()
    assert loop.peak == pytest.approx(by_hand, rel=1.0e-9)


@pytest.mark.parametrize('kind', KINDS)
def test_margins_are_those_of_python_control(kind):
    """Also of the state space itself, sampled as finely as our response, and by Ms for disks."""
    model = design_model()
    loop = Loop.of(model, law(settings(kind), identity(), model).compensator())
    gain, phase, least, *_ = control.stability_margins(loop.to_control(), method='frd')
    assert loop.margins == pytest.approx((abs(20.0 * np.log10(gain)), phase), rel=1.0e-4)
    assert 1.0 / loop.peak == pytest.approx(least, rel=1.0e-4)      # ours is on a grid
    disk = 1.0 / np.abs(loop.sensitivity - 0.5).max()
    assert loop.disk_margins == pytest.approx((
        20.0 * np.log10((1.0 + disk / 2.0) / (1.0 - disk / 2.0)),
        2.0 * np.degrees(np.arctan(disk / 2.0))), rel=1.0e-9)
    assert loop.disk_margins[0] <= loop.margins[0] and loop.disk_margins[1] <= loop.margins[1]


@pytest.mark.parametrize('kind', KINDS)
def test_sensitivity_and_step_are_those_of_python_control(kind):
    model = design_model()
    loop = Loop.of(model, law(settings(kind), identity(), model).compensator())
    sensitivity = control.feedback(1, loop.to_control())
    points = loop.frequency[::40]
    np.testing.assert_allclose(loop.sensitivity[::40],
                               sensitivity(np.exp(2j * np.pi * points * model.dt)), atol=1.0e-9)
    error = step_error(model, loop.compensator)
    response = control.step_response(sensitivity, model.dt * np.arange(error.size))
    np.testing.assert_allclose(error, response.outputs, atol=1.0e-9)


def test_regulator_and_filter_are_those_of_python_control():
    """Riccati solutions come from scipy, as those of `dlqr` do, without its 1.2 s of import."""
    base = law(settings('lqg'), identity(), design_model())
    observer, weights = base.observer, settings('lqg')
    model = observer.design
    gain, cost, _ = control.dlqr(model.a, model.b[:, None], np.outer(model.c, model.c),
                                 [[weights.lqg.control_weight]])
    np.testing.assert_allclose(base.feedback, gain[0], rtol=1.0e-9)
    np.testing.assert_allclose(regulator(model, weights.lqg.control_weight)[1], cost, rtol=1.0e-9)
    noise = weights.estimator
    drive = np.zeros((observer.inlet.size, observer.inlet.size))
    drive[:model.order, :model.order] = noise.load_noise**2 * np.outer(model.b, model.b)
    drive[model.order:, model.order:] = np.diag(
        [noise.drift**2, *[noise.oscillation**2] * (observer.inlet.size - model.order - 1)])
    kalman, *_ = control.dlqe(observer.transition, np.eye(len(drive)), observer.outlet[None],
                              drive, [[noise.sensor_noise**2]])
    np.testing.assert_allclose(observer.transition @ observer.gain, kalman[:, 0], rtol=1.0e-6)


def test_closed_matrix_is_the_loop_stepped_by_hand():
    model, compensator = design_model(), pid(2.5, 9.7e3, 0.016, 1.15e-4).compensator()
    matrix = closed_matrix(model, compensator)
    start = np.random.default_rng(2).standard_normal(matrix.shape[0])
    x, z = start[:model.order], start[model.order:]
    error = -(model.c @ x)
    w = compensator.c[0] @ z + compensator.d[0, 0] * error
    by_hand = np.concatenate([model.a @ x + model.b * w,
                              compensator.a @ z + compensator.b[:, 0] * error])
    np.testing.assert_allclose(matrix @ start, by_hand, rtol=1.0e-12, atol=1.0e-9)


@pytest.mark.parametrize('kp', [0.0, 0.5, 2.0])
def test_pi_on_a_lightly_damped_mode_is_stable_up_to_the_closed_form(kp):
    """Ki G0 = 2 zeta w1 (1 + Kp G0): Routh's criterion on s^3 + 2 z w s^2 + w^2 (1 + k) s."""
    damping, frequency, gain = 0.02, 72.0, 1.3
    limit = 2.0 * damping * 2.0 * np.pi * frequency * (1.0 + kp * gain) / gain
    model = mode(frequency, damping, gain)
    below, above = (pid(kp, share * limit, dt=model.dt).compensator() for share in (0.97, 1.03))
    assert Loop.of(model, below).stable
    assert not Loop.of(model, above).stable


def test_the_gains_as_printed_are_unstable_on_the_wing():
    """Ki = 2.3e15, Kp = 4.0e11, Kd = 7.5e5 per metre of camber fail: Kd damps next to nothing."""
    from dewing_control.tuning.printed import printed_gains
    model, wing = design_model(), identity()
    printed = pid(**printed_gains(wing)).compensator()
    assert not Loop.of(model, printed).stable
    gains = printed_gains(wing)
    assert Loop.of(model, pid(**{**gains, 'kd': 3000.0 * gains['kd']}).compensator()).stable


@pytest.mark.parametrize('kind', ('periodic', 'lqg'))
def test_known_frequency_is_rejected_entirely(kind):
    model = design_model()
    compensator = law(settings(kind), identity(), model).compensator()
    assert Loop.of(model, compensator).stable
    assert abs(sensitivity_at(model, compensator, 10.0)) < 1.0e-5
    assert abs(sensitivity_at(model, compensator, 13.0)) > 1.0e-4


def test_design_model_keeps_the_response_through_resampling_and_tension():
    model = design_model()
    points = np.array([5.0, 40.0, 72.0, 150.0])
    assert design_model(5).static_gain == pytest.approx(model.static_gain, rel=1.0e-9)
    assert design_model(5).dt == pytest.approx(5.0e-4)
    np.testing.assert_allclose(model.at_tension(1.0).response(points), model.response(points),
                               rtol=1.0e-6)
    looser = model.at_tension(0.81)
    assert looser.static_gain == pytest.approx(model.static_gain, rel=1.0e-6)
    grid = np.linspace(40.0, 100.0, 2000)
    peaks = [grid[np.abs(plant.response(grid)).argmax()] for plant in (looser, model)]
    assert peaks[0] / peaks[1] == pytest.approx(0.9, abs=0.005)


def test_fundamental_keeps_static_gain_frequency_and_damping():
    fundamental = design_model().fundamental()
    poles = np.log(np.linalg.eigvals(fundamental.a)) / fundamental.dt
    assert abs(poles[0]) / (2.0 * np.pi) == pytest.approx(73.4, rel=1.0e-6)
    assert -poles[0].real / abs(poles[0]) == pytest.approx(0.027, rel=1.0e-6)
    assert fundamental.static_gain == pytest.approx(design_model().static_gain, rel=1.0e-9)


def test_unusable_models_are_refused(tmp_path):
    with pytest.raises(BadInput, match='model is empty'):
        load('', 'camber_mean', 1.0e-4)
    with pytest.raises(BadInput, match='no output tension'):
        Design.of(reduced_model().model, 'tension')
    model = reduced_model().model
    with pytest.raises(BadInput, match='unstable'):
        Design.of(dataclasses.replace(model, a=1.2 * model.a), 'camber_mean')
    with pytest.raises(BadInput, match='camber falls with V'):
        Design.of(dataclasses.replace(model, c=-model.c), 'camber_mean')


def test_a_model_is_sampled_at_the_control_period(tmp_path):
    path = str(tmp_path / 'model.npz')
    reduced.save(path, reduced_model())
    for steps in (1, 3):
        np.testing.assert_array_equal(load(path, 'camber_mean', steps * 1.0e-4).a,
                                      design_model(steps).a)
    for period in (5.0e-5, 1.5e-4):
        with pytest.raises(BadInput, match=rf'control period, {period:g} s, is no multiple'):
            load(path, 'camber_mean', period)


def test_compensator_response_is_its_transfer_function():
    compensator = Matrices.siso(np.array([[0.5]]), np.array([2.0]), np.array([3.0]), 1.0)
    z = np.exp(2j * np.pi * 0.1)
    assert frequency_response(compensator, np.array([0.1]), 1.0)[0, 0] == pytest.approx(
        6.0 / (z - 0.5) + 1.0)

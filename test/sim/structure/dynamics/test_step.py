# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The implicit time step: frequencies, order, added mass, damping, restarts and failures."""

import dataclasses
import io

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import Diverged, NotConverged, Slack
from dewing_sim.structure.dynamics.band import LowRank
from dewing_sim.structure.dynamics.step import Motion, Operator, advance
from dewing_sim.structure.membrane import Membrane

SECTION = parameters.replace(parameters.load('paper').membrane, {'elements': 16})
MEMBRANE = Membrane.from_parameters(SECTION)
REST = MEMBRANE.rest_position
SHAPE = np.sin(np.pi * REST[:, 0] / MEMBRANE.chord)
TENSION = MEMBRANE.sheet.respond([1.5], 0.0).tension[0]
OMEGA = 2.0 * np.sqrt(TENSION * 16 / 0.03 / MEMBRANE.mass[1]) * np.sin(np.pi / 32)


def no_load(position, velocity):
    return np.zeros_like(position)


def released(amplitude, omega, dt, membrane=MEMBRANE):
    """Return the motion y = amplitude cos(omega t) sin(pi x / c) at t = 0 and t = -dt."""
    shape = np.sin(np.pi * membrane.rest_position[:, :1] / membrane.chord) * [[0.0, amplitude]]
    return Motion(membrane.rest_position + shape, 0.0 * shape,
                  membrane.rest_position + shape * np.cos(omega * dt),
                  shape * omega * np.sin(omega * dt))


def run(motion, dt, steps, load=no_load, v_squared=0.0, membrane=MEMBRANE, operator=None,
        damping=0.0):
    operator = operator or Operator.of(membrane, dt, damping=damping)
    motions = [motion]
    for _ in range(steps):
        motions.append(advance(membrane, motions[-1], v_squared, load, operator))
    return motions


def midspan(motions):
    return np.array([motion.position[len(motion.position) // 2, 1] for motion in motions])


def test_rest_stays_at_rest():
    last = run(Motion.at_rest(REST), 1e-4, 5, v_squared=4.0e5)[-1]
    assert np.abs(last.position - REST).max() < 1e-14 * MEMBRANE.chord


def test_plucked_membrane_rings_at_102_6_hz():
    membrane = Membrane.from_parameters(parameters.replace(SECTION, {'elements': 128}))
    dt = 2e-5
    motions = run(released(1e-8, 2 * np.pi * 102.6, dt, membrane), dt, 1000, membrane=membrane)
    y = midspan(motions)
    down = np.flatnonzero((y[:-1] > 0) & (y[1:] <= 0))
    crossings = down + y[down] / (y[down] - y[down + 1])
    assert crossings.size == 2
    assert 1.0 / (np.diff(crossings)[0] * dt) == pytest.approx(102.6, rel=1e-3)


def test_small_vibration_is_second_order_in_time():
    steps = np.array([40, 80, 160, 320])
    errors = []
    for n in steps:
        dt = 1.5 * np.pi / OMEGA / n        # to where the exact motion passes zero
        errors.append(abs(midspan(run(released(1e-7, OMEGA, dt), dt, n))[-1]))
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.15)


def test_large_forced_motion_is_second_order_in_time():
    def final(n):
        dt = 0.02 / n
        motion, operator = Motion.at_rest(REST), Operator.of(MEMBRANE, dt)
        for k in range(1, n + 1):
            pressure = 10.0 * (1.0 - np.cos(2.0 * np.pi * k / n)) ** 2
            motion = advance(MEMBRANE, motion, 4.0e5,
                             lambda p, w, q=pressure: MEMBRANE.pressure_force(p, q), operator)
        return motion.position
    coarse, middle, fine, finest = (final(n) for n in (200, 400, 800, 1600))
    assert np.abs(finest[:, 1]).max() > 0.05 * MEMBRANE.chord
    gaps = [np.abs(a - b).max() for a, b in ((coarse, middle), (middle, fine), (fine, finest))]
    assert np.log2(gaps[1] / gaps[2]) == pytest.approx(2.0, abs=0.15)


def test_prediction_errs_with_the_third_power_of_the_step():
    def error(dt):
        ahead = released(1e-3, 600.0, dt).predict(dt) - REST
        return np.abs(ahead[:, 1] - 1e-3 * np.cos(600.0 * dt) * SHAPE).max()
    # cos is even, so at t = 0 even the third power drops out.
    assert np.log2(error(2e-4) / error(1e-4)) == pytest.approx(4.0, abs=0.1)


def added_mass_load(motion, dt, added):
    """Return the load -added * acceleration, with acceleration by the scheme's BDF2."""
    def load(position, velocity):
        rate = (3 * velocity - 4 * motion.velocity + motion.velocity_before) / (2 * dt)
        return -added[:, None] * rate
    return load


def test_impedance_acts_as_added_mass():
    dt, added = 1e-4, 2.5 * MEMBRANE.mass
    weight = np.diag(np.repeat(added, 2)[MEMBRANE.free]) * 1.5 / dt
    impedance = LowRank(np.eye(len(weight)), weight)
    operator = Operator.of(MEMBRANE, dt, impedance)
    heavy = Membrane(MEMBRANE.sheet, 1.5, REST, MEMBRANE.mass + added)
    start = released(2e-3, 300.0, dt)
    motion = start
    for _ in range(30):
        motion = advance(MEMBRANE, motion, 1e5, added_mass_load(motion, dt, added), operator)
    reference = run(start, dt, 30, v_squared=1e5, membrane=heavy)[-1]
    assert np.abs(motion.position - reference.position).max() < 1e-8 * MEMBRANE.chord


def test_damping_decays_and_settles_on_the_static_shape():
    dt, damping = 1e-4, 100.0
    omega = np.sqrt(OMEGA ** 2 - 0.25 * damping ** 2)
    periods = 4.0 * np.pi / omega
    y = midspan(run(released(1e-7, OMEGA, dt), dt, round(periods / dt), damping=damping))
    assert np.log(y[0] / y[-1]) == pytest.approx(0.5 * damping * periods, rel=0.02)
    settled = run(Motion.at_rest(REST), dt, 1500, damping=2.0 * OMEGA,
                  load=lambda p, w: MEMBRANE.pressure_force(p, 20.0), v_squared=2.5e5)[-1]
    static = MEMBRANE.equilibrium(20.0, 2.5e5)
    assert np.abs(settled.position - static).max() < 1e-7 * MEMBRANE.chord


def counted(load):
    calls = []

    def wrapped(position, velocity):
        calls.append(1)
        return load(position, velocity)
    return wrapped, calls


def test_operator_changes_the_work_but_not_the_result():
    dt = 1e-4
    start = released(3e-3, OMEGA, dt)
    other = Operator.of(MEMBRANE, dt, position=start.position)
    wrong = dataclasses.replace(Operator.of(MEMBRANE, 20.0 * dt), dt=dt)
    results = [run(start, dt, 10, operator=operator)[-1].position
               for operator in (None, other, wrong)]
    assert np.abs(results[1] - results[0]).max() < 1e-8 * MEMBRANE.chord
    assert np.abs(results[2] - results[0]).max() < 1e-8 * MEMBRANE.chord


def test_usual_step_takes_three_chord_iterations_and_a_good_guess_fewer():
    dt = 1e-4
    load, calls = counted(lambda p, w: MEMBRANE.pressure_force(REST, 0.9))
    operator = Operator.of(MEMBRANE, dt)
    motion = run(Motion.at_rest(REST), dt, 50, load, operator=operator)[-1]
    assert len(calls) <= 3 * 50
    calls.clear()
    ahead = advance(MEMBRANE, motion, 0.0, load, operator)
    first = len(calls)
    again = advance(MEMBRANE, motion, 0.0, load, operator, guess=ahead.position)
    assert len(calls) - first == 1
    assert np.abs(again.position - ahead.position).max() < 1e-10 * MEMBRANE.chord


def test_forty_steps_equal_twenty_saved_and_twenty_bit_for_bit():
    dt, start = 1e-4, released(2e-3, OMEGA, 1e-4)
    kept = [array.copy() for array in vars(start).values()]
    through = run(start, dt, 40, v_squared=2e5)[-1]
    halfway = run(start, dt, 20, v_squared=2e5)[-1]
    file = io.BytesIO()
    np.savez(file, **vars(halfway))
    file.seek(0)
    resumed = run(Motion(**np.load(file)), dt, 20, v_squared=2e5)[-1]
    for name, array in vars(through).items():
        assert np.array_equal(array, getattr(resumed, name)), name
    assert all(np.array_equal(a, b) for a, b in zip(kept, vars(start).values()))


def test_voltage_above_the_limit_is_slack():
    with pytest.raises(Slack, match=r'element \d+ has tension -.* at 1310 V .* at 1300\.0\d+ V'):
        run(Motion.at_rest(REST), 1e-4, 1, v_squared=1310.0 ** 2)


@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_non_finite_load_stops_the_step(value):
    motion = Motion.at_rest(REST)
    with pytest.raises(Diverged, match='iteration 0') as caught:
        run(motion, 1e-4, 1, lambda p, w: np.full_like(p, value))
    assert caught.value.state is motion


def test_undeclared_impedance_does_not_converge():
    motion = released(1e-4, OMEGA, 1e-4)
    with pytest.raises(NotConverged, match='after 30 iterations .* reduce the time') as caught:
        run(motion, 1e-4, 1, lambda p, w: -1.1 * MEMBRANE.mass[:, None] * 1.5e4 * w)
    assert caught.value.state is motion

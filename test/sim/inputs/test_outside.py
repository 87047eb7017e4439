# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from outside: held, limited, in the step for which they are meant."""

import math

import numpy as np
import pytest
from gusty_plant import Plant
from reduced_wing import first_mode

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.following import Following
from dewing_sim.inputs.outside import OutsideInputs
from dewing_sim.wing import Wing

CASE = parameters.load('paper')
FLOW, CHORD = CASE.flow, CASE.membrane.chord
DT = CASE.numerics.time_step


def outside(plant=None, lag=2.0e-3):
    return OutsideInputs(plant or Plant(CASE), FLOW.speed, FLOW.dynamic_pressure, CHORD, lag)


def during(inputs, step):
    """Return the inputs of a step that begins after ``step`` others."""
    return inputs.during(0.0, round(step * DT * 1.0e9), (step + 1) * DT)


def test_nothing_acts_until_something_is_given_and_a_pressure_is_held_from_its_step_on():
    inputs = outside()
    assert during(inputs, 0) == Inputs(0.0)
    inputs.give('pressure_disturbance', 300_000, 100_000, [0.25 * FLOW.dynamic_pressure])
    pressures = [during(inputs, step).wall_pressure for step in range(1, 7)]
    assert pressures == pytest.approx([0.0, 0.0, 0.25, 0.25, 0.25, 0.25])
    assert during(inputs, 7).inflow is None and inputs.late == 0


def test_what_comes_too_late_acts_in_the_next_step_and_is_counted():
    inputs = outside()
    inputs.give('pressure_disturbance', 100_000, 500_000, [1.0])
    inputs.give('pressure_disturbance', 0, 500_000, [2.0])         # no stamp: as soon as may be
    assert inputs.late == 1
    assert during(inputs, 5).wall_pressure == pytest.approx(2.0 / FLOW.dynamic_pressure)


def test_a_gust_is_followed_with_its_rate():
    inputs = outside()
    inputs.give('gust', 0, 0, [0.0, 0.2])
    expected = Following.at_rest(2.0e-3, 2).towards(np.array([0.0, 0.2]), np.zeros(2))
    for step in range(50):
        inflow, expected = during(inputs, step).inflow, expected.after(DT)
        assert inflow.stream.imag == pytest.approx(expected.now[0, 1] / FLOW.speed)
        assert inflow.stream_rate.imag == pytest.approx(expected.now[1, 1] / FLOW.speed)
    names, values, rates = inputs.acting
    assert names == ('gust_along', 'gust_up', 'wall_pressure', 'heave', 'pitch')
    assert values[1] == pytest.approx(expected.now[0, 1]) and rates[2:] == [0.0, 0.0, 0.0]


def test_a_motion_goes_on_at_its_rate_until_the_next_message_is_due():
    inputs, speed = outside(lag=2.0 * DT), 0.05
    for step in range(400):
        heave = inputs.acting[1][3]
        if step == 100:
            assert heave == 0.0                     # one message tells no interval
        if step in (0, 100, 200):                   # 10 ms apart, then silence
            inputs.give('motion', 0, round(step * DT * 1.0e9), [speed * step * DT, 0.0],
                        [speed, 0.0])
        if step == 180:
            assert heave == pytest.approx(speed * step * DT, rel=1.0e-6)
        during(inputs, step)
    assert inputs.acting[1][3] == pytest.approx(speed * 300 * DT)
    assert inputs.acting[2][3] == 0.0


def test_a_run_that_begins_anew_begins_undisturbed():
    inputs = outside()
    inputs.give('gust', 0, 0, [0.1, 0.1])
    inputs.give('motion', 10**9, 0, [0.001, 0.0])
    during(inputs, 0)
    inputs.restart()
    assert during(inputs, 0) == Inputs(0.0) and not any(inputs.acting[1])


@pytest.mark.parametrize('kind, value, rate, said', [
    ('gust', [0.0, math.nan], [], 'gust_up = nan m/s'),
    ('gust', [1.0, 1.0], [], 'more than the free stream, 1.21725 m/s'),
    ('gust', [-2.0, 0.0], [], 'gust_along = -2 m/s is out of range'),
    ('pressure_disturbance', [10.0], [], 'wall_pressure = 10 Pa is out of range, from -9.07'),
    ('motion', [0.0, 1.0], [], 'pitch = 1 rad is out of range, from -0.523599 to 0.523599 rad'),
    ('motion', [0.0, 0.0], [math.inf, 0.0], 'heave = 0.0 m at inf m/s is not finite'),
    ('motion', [0.02, 0.0], [], 'heave would move at 2.707 m/s, at most 1.217 m/s'),
    ('motion', [0.0, 0.1], [0.0, 50.0], 'pitch would move at 63.53 rad/s, at most 40.58 rad/s'),
])
def test_what_no_wing_should_meet_is_refused(kind, value, rate, said):
    inputs = outside()
    with pytest.raises(BadInput, match=said.replace('.', r'\.')):
        inputs.give(kind, 0, 0, value, rate)
    assert during(inputs, 0) == Inputs(0.0)


def test_a_plant_that_cannot_says_what_it_takes():
    with pytest.raises(BadInput, match='gust: this plant takes no input but V'):
        outside(first_mode()).give('gust', 0, 0, [0.0, 0.1])
    wing = Wing(parameters.load('paper', changes={'numerics.grid': 'fast'}))
    with pytest.raises(BadInput, match='motion: this plant takes only pressure_disturbance'):
        outside(wing).give('motion', 0, 0, [0.0, 0.0])


def test_a_queue_has_an_end():
    inputs = outside()
    for _ in range(10_000):
        inputs.give('pressure_disturbance', 10**9, 0, [1.0])
    with pytest.raises(BadInput, match='10000 messages wait'):
        inputs.give('pressure_disturbance', 10**9, 0, [1.0])


def test_a_wing_meets_what_comes_from_outside_as_if_it_were_a_function_of_time():
    """Analytic rates here, central differences of a user's function there."""
    case = parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
        'numerics.time_step': 5.0e-4, 'numerics.trim_time': 0.5, 'membrane.elements': 16})
    lag, step = 2.0e-3, case.numerics.time_step
    gust = Following.at_rest(lag, 2).towards(np.array([0.05, 0.2]), np.zeros(2))
    motion = Following.at_rest(lag, 2).towards(np.array([1.0e-3, 0.03]), np.zeros(2))

    def course(following):
        return lambda time: following.after(max(time, 0.0)).now[0]

    told = Wing(case, gust=course(gust), motion=course(motion))
    plain = Wing(case)
    inputs = OutsideInputs(plain, FLOW.speed, FLOW.dynamic_pressure, CHORD, lag)
    inputs.give('gust', 0, 0, [0.05, 0.2])
    inputs.give('motion', 0, 0, [1.0e-3, 0.03])
    states = [plain.rest()] * 2
    for k in range(20):
        states = [told.step(states[0], Inputs(0.0)),
                  plain.step(states[1], inputs.during(0.0, round(k * step * 1.0e9),
                                                      (k + 1) * step))]
    one, other = told.observe(states[0]), plain.observe(states[1])
    assert abs(one.cl - plain.observe(plain.rest()).cl) > 0.3
    assert one.cl == pytest.approx(other.cl, rel=2.0e-3)
    assert one.camber_mean == pytest.approx(other.camber_mean, rel=2.0e-3)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on a wing: its case's disturbances, a user's functions of time, and given inputs."""

import math

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.sources import Sources
from dewing_sim.inputs.trajectory import SHAPES, Course, Differentiated
from dewing_sim.rest import trim
from dewing_sim.scales import Scales
from dewing_sim.wing import Wing

CONFORMAL = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
             'numerics.time_step': 5.0e-4, 'numerics.trim_time': 4.0}
GUST = {'gust.shape': 'one_minus_cosine', 'gust.vertical': 0.1, 'gust.horizontal': 0.05,
        'gust.duration': 0.02}
MOTION = {'rigid_motion.shape': 'ramp', 'rigid_motion.heave': 0.001,
          'rigid_motion.pitch_deg': 2.0, 'rigid_motion.duration': 0.02}

STILL = Inputs(0.0)


def case(**more):
    return parameters.load('paper', changes={**CONFORMAL, **more})


def course_of(section):
    """Return the course of a section of a case, time in s."""
    return Course(section.shape, section.start, section.duration)


def flown(wing, steps=30, inputs=STILL):
    """Return the outputs at the end of some steps from the undisturbed rest state."""
    state = trim.rest(wing)
    for _ in range(steps):
        state = wing.step(state, inputs)
    return wing.observe(state)


@pytest.mark.parametrize('shape', SHAPES)
def test_differences_find_the_rates_of_a_course_to_second_order(shape):
    course = Course(shape, 0.1, 2.0)
    for time in (0.5, 1.1, 1.9):
        exact = course(time)
        errors = [np.abs(Differentiated(lambda t: course(t)[0], step)(time) - exact).max()
                  for step in (0.02, 0.01)]
        assert errors[1] < 1.0e-2 and errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_pressures_of_case_user_and_inputs_add_up():
    disturbed = case(**{'disturbance.pressure': 0.01})
    sources = Sources.of(disturbed, Scales.of(disturbed.flow, 0.03), lambda time: 3.0 * time)
    time = 0.05                         # the disturbance is at its trough
    acting = sources.at(time, Inputs(4.0e4, 0.002))
    assert acting == Inputs(4.0e4, pytest.approx(-0.02 + 0.15 + 0.002), None)


def test_a_disturbance_from_outside_is_that_of_the_case():
    def pressure(time):
        return -0.02 * (1.0 - math.cos(2.0 * math.pi * 25.0 * time))
    told = Wing(case(**{'disturbance.pressure': 0.02, 'disturbance.frequency': 25.0}))
    assert flown(Wing(case(), wall_pressure=pressure)).y == pytest.approx(
        flown(told).y, rel=1.0e-12)


def test_a_gust_from_outside_is_that_of_the_case():
    told = Wing(case(**GUST))
    course, section = course_of(told.case.gust), told.case.gust

    def gust(time):
        return section.horizontal * course(time)[0], section.vertical * course(time)[0]
    calm, ours, theirs = (flown(wing).cl for wing in (Wing(case()), Wing(case(), gust=gust), told))
    assert abs(theirs - calm) > 0.1
    assert ours == pytest.approx(theirs, abs=1.0e-3 * abs(theirs - calm))


def test_a_motion_from_outside_is_that_of_the_case():
    told = Wing(case(**MOTION))
    course, section = course_of(told.case.rigid_motion), told.case.rigid_motion

    def motion(time):
        return section.heave * course(time)[0], section.pitch * course(time)[0]
    calm, ours, theirs = (
        flown(wing).cl for wing in (Wing(case()), Wing(case(), motion=motion), told))
    assert abs(theirs - calm) > 0.02
    assert ours == pytest.approx(theirs, abs=5.0e-3 * abs(theirs - calm))


def test_an_inflow_among_the_inputs_takes_the_place_of_the_schedule():
    wing = Wing(case(**GUST))
    steady = Inflow.steady(wing.case.flow.angle_of_attack)
    calm = flown(Wing(case())).cl
    assert flown(wing, inputs=Inputs(0.0, inflow=steady)).cl == pytest.approx(calm, rel=1.0e-9)
    assert abs(flown(wing).cl - calm) > 0.1


def test_a_gust_from_outside_asks_for_an_engine_that_takes_it():
    with pytest.raises(BadInput, match='numerics.engine = .finite_volume. knows no gust'):
        Wing(parameters.load('paper'), gust=lambda time: (0.0, 0.1))


def test_a_rest_state_does_not_depend_on_what_acts_later():
    calm, disturbed = Wing(case()), Wing(case(), wall_pressure=lambda time: 1.0)
    assert trim.fingerprint(calm) == trim.fingerprint(disturbed)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gusts, heave and pitch: their courses in time, and what they do to flow and membrane."""

import dataclasses

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.coupling.transfer import Load
from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal.geometry.exterior import metric_and_flux
from dewing_sim.fluid.conformal.geometry.frame import Frame
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.inflow_schedule import InflowSchedule
from dewing_sim.inputs.trajectory import SHAPES, Course
from dewing_sim.rest import trim
from dewing_sim.verification.fluid import unsteady
from dewing_sim.verification.fluid.rigid_flow import parabola
from dewing_sim.wing import Wing

ALPHA = np.radians(4.0)
CONFORMAL = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
             'numerics.time_step': 5.0e-4, 'numerics.trim_time': 4.0}
GUST = {'gust.shape': 'one_minus_cosine', 'gust.vertical': 0.1, 'gust.duration': 0.05}
HEAVE = {'rigid_motion.shape': 'ramp', 'rigid_motion.heave': 0.003,
         'rigid_motion.duration': 0.05}


def conformal(dt=0.01, alpha=ALPHA):
    return engines.make('conformal', 'realtime', 2500.0, alpha, dt)


def lift(fluid, inflow_at, steps):
    wall = Wall.flat(fluid.columns)
    flow = fluid.rest(wall, 0.1)
    for step in range(1, steps + 1):
        flow = fluid.correct(fluid.predict(flow, wall, inflow_at(step * fluid.dt)), wall.velocity)
    return fluid.loads(flow).cl


@pytest.mark.parametrize('shape', SHAPES)
def test_rates_are_the_derivatives_of_a_course(shape):
    course, step = Course(shape, 0.3, 2.0), 1.0e-5
    for time in (0.1, 0.7, 1.3, 2.1, 3.0):
        before, now, after = (course(time + shift) for shift in (-step, 0.0, step))
        assert now[1:] == pytest.approx((after - before)[:2] / (2.0 * step), abs=1.0e-7)


@pytest.mark.parametrize('shape, end', [('ramp', 1.0), ('one_minus_cosine', 0.0)])
def test_courses_start_and_end_where_they_say(shape, end):
    course = Course(shape, 1.0, 2.0)
    assert course(1.0).tolist() == [0.0, 0.0, 0.0]
    assert course(2.0)[0] == pytest.approx(0.5 if shape == 'ramp' else 1.0)
    assert course(3.0).tolist() == [end, 0.0, 0.0]


def test_nothing_is_a_steady_stream():
    case = parameters.load('paper')
    wing = Wing(case)
    schedule = wing.sources.inflow_schedule
    assert schedule.is_steady
    assert schedule.at(1.0) == Inflow(stream=np.exp(1j * ALPHA), incidence=ALPHA,
                                      pivot=case.rigid_motion.pivot)


def test_an_undisturbed_inflow_changes_nothing():
    fluid = conformal()
    expected = lift(fluid, lambda time: None, 20)
    assert lift(fluid, InflowSchedule(ALPHA).at, 20) == pytest.approx(expected, rel=1.0e-12)


def test_heave_is_the_opposite_of_a_vertical_gust():
    fluid = conformal()
    heaving = InflowSchedule(ALPHA, heave=0.05, motion_course=Course('ramp', 0.0, 0.5))

    def gust_at(time):
        inflow = heaving.at(time)
        return dataclasses.replace(inflow, pivot_acceleration=0.0)

    assert lift(fluid, gust_at, 60) == lift(fluid, heaving.at, 60)
    assert lift(fluid, heaving.at, 25) < lift(fluid, lambda time: None, 25)


@pytest.mark.parametrize('shape', ['ramp', 'sine'])
def test_a_frame_adds_the_acceleration_of_its_points(shape):
    moving = InflowSchedule(0.1, heave=0.2, pitch=0.3, pivot=0.25,
                            motion_course=Course(shape, 0.0, 2.0))
    start, speed, step = 0.7 + 0.02j, 0.1 - 0.2j, 1.0e-4

    def place(time):            # in axes at rest along the chord at the incidence 0.1
        heave, pitch = (moving.heave * moving.motion_course(time)[0],
                        moving.pitch * moving.motion_course(time)[0])
        within = start + speed * (time - 0.8)
        return 1j * heave * np.exp(0.1j) + (within - 0.25) * np.exp(-1j * pitch)

    total = (place(0.8 + step) - 2.0 * place(0.8) + place(0.8 - step)) / step**2
    inflow = moving.at(0.8)
    found = inflow.frame_acceleration(np.array([[start.real, start.imag]]),
                                      np.array([[speed.real, speed.imag]]))
    turned = total * np.exp(1j * (inflow.incidence - 0.1))
    assert complex(*found[0]) == pytest.approx(turned, rel=1.0e-4)


def test_sudden_acceleration_meets_the_exact_added_mass():
    fluid = conformal()
    wall = Wall.flat(fluid.columns)
    rest = fluid.rest(wall, 0.0)
    dx = np.diff(fluid.columns)
    x = fluid.columns[1:] - 0.5 * dx
    still = fluid.predict(rest, wall, Inflow(0.0)).jump
    heave = fluid.predict(rest, wall, Inflow(0.0, stream_rate=-1.0j)).jump - still
    pitch = fluid.predict(rest, wall, Inflow(0.0, pitch_acceleration=1.0, pivot=0.5)).jump - still
    assert np.sum(heave * dx) == pytest.approx(-np.pi / 4.0, rel=2.0e-3)
    assert np.sum(pitch * dx) == pytest.approx(0.0, abs=1.0e-6)
    assert np.sum(pitch * (x - 0.5) * dx) == pytest.approx(np.pi / 128.0, rel=5.0e-3)


def test_turning_moves_the_grid_as_a_rigid_body():
    fluid = conformal()
    grid, mapping = fluid.grid, fluid.geometry.mapping
    m = mapping.follow(parabola(grid.columns, 0.03, 0.0).height, mapping.flat())
    frame = Frame.of(Inflow(1.0, pitch_rate=-2.0, pivot=0.3), grid)
    pivot = 0.3 * (np.arange(len(m.shape)) == 0)
    _, g_v, g_u = metric_and_flux(
        fluid.solver.exterior, m.shape, m.scale, m.shape - pivot, m.scale)
    flux = 2.0j * (g_v + 1j * g_u)                      # V + i U of turning at the rate 2
    stream, near = frame.stream(m).turning, (slice(None), slice(1, 30))
    v = (stream - np.roll(stream, 1, axis=0))[near] / grid.step
    u = -np.diff(stream, axis=1)[:, :29] / grid.width[1:30]
    size = np.abs(flux[near]).max()
    assert v == pytest.approx(0.5 * (flux[near] + flux[:, 2:31]).real, abs=0.01 * size)
    assert u == pytest.approx(0.5 * (flux + np.roll(flux, -1, axis=0))[near].imag,
                              abs=0.01 * size)


def test_a_lasting_pitch_is_an_angle_of_attack():
    dt, pitched = 0.02, InflowSchedule(np.radians(2.0), pitch=np.radians(2.0), pivot=0.25,
                                       motion_course=Course('ramp', 0.0, 2.0))
    turned = lift(conformal(dt, np.radians(2.0)), pitched.at, 1000)
    assert turned == pytest.approx(lift(conformal(dt), lambda time: None, 1000), rel=0.01)


def test_oscillations_on_either_engine_agree():
    found = [unsteady.response(unsteady.UnsteadyRun(
        engine, 'fast', 'pitch', 'sine', 2.0 * np.pi / unsteady.OMEGA, 7.0)())
        for engine in ('conformal', 'finite_volume')]
    assert abs(found[0] - found[1]) < 0.02 * abs(found[0])


def test_axes_that_accelerate_load_the_membrane_with_its_inertia():
    wing = Wing(parameters.load('paper', changes=CONFORMAL))
    position = wing.membrane.rest_position
    still = np.zeros(len(wing.fluid.columns) - 1)
    plain, heaved = (Load.of(wing.fluid, wing.membrane, still, still, Inputs(0.0, 0.0, inflow))(
        position, np.zeros_like(position)) for inflow in (
            None, Inflow(1.0, pivot_acceleration=0.5j)))
    assert heaved[:, 0] == pytest.approx(plain[:, 0])
    assert (heaved - plain)[:, 1] == pytest.approx(-0.5 * wing.membrane.mass)


@pytest.mark.parametrize('changes, sign', [(GUST, 1.0), (HEAVE, -1.0)])
def test_the_wing_answers_and_rests_as_without_disturbance(changes, sign):
    calm, disturbed = (Wing(parameters.load('paper', changes=CONFORMAL | more))
                       for more in ({}, changes))
    assert trim.fingerprint(calm) == trim.fingerprint(disturbed)
    state = other = calm.rest()
    for _ in range(50):                     # the middle of either course
        state, other = calm.step(state, Inputs(0.0)), disturbed.step(other, Inputs(0.0))
    change = disturbed.observe(other).cl - calm.observe(state).cl
    assert sign * change > 0.1


@pytest.mark.parametrize('changes', [GUST, HEAVE])
def test_the_other_engine_refuses_at_once(changes):
    with pytest.raises(BadInput, match='numerics.engine = .finite_volume. knows no gust nor'):
        Wing(parameters.load('paper', changes=changes))


@pytest.mark.parametrize('changes, message', [
    ({**GUST, 'gust.horizontal': 2.0}, '^gust: it reaches 1.65 free-stream speeds, at most 1'),
    ({**HEAVE, 'rigid_motion.duration': 1.0e-3}, '^rigid_motion: it reaches .* at most 1'),
])
def test_what_outruns_the_stream_is_refused(changes, message):
    with pytest.raises(BadInput, match=message):
        Wing(parameters.load('paper', changes=CONFORMAL | changes))


def test_a_course_that_is_not_known_is_refused():
    with pytest.raises(BadInput, match='^gust.shape = .step. is out of range: .*one_minus_cosine'):
        parameters.load('paper', changes={'gust.shape': 'step'})


def test_a_gust_along_the_stream_raises_the_lift_with_the_square_of_the_speed():
    dt, gust = 0.02, InflowSchedule(ALPHA, gust=0.2, gust_course=Course('ramp', 0.0, 1.0))
    calm, fast = (lift(conformal(dt), schedule.at, 900)
                  for schedule in (InflowSchedule(ALPHA), gust))
    assert fast == pytest.approx(1.44 * calm, rel=0.04)


def test_a_membrane_pressed_down_has_its_largest_deflection_where_it_is_lowest():
    wing = Wing(parameters.load('paper', changes={
        **CONFORMAL, **GUST, 'gust.vertical': -0.3, 'gust.shape': 'ramp'}))
    state = wing.rest()
    for _ in range(100):
        state = wing.step(state, Inputs(0.0))
    outputs = wing.observe(state)
    assert outputs.camber_mean < 0.0
    lowest = outputs.y.argmin()
    assert outputs.camber_max == pytest.approx(outputs.y[lowest], rel=1.0e-3)
    assert outputs.camber_max_position == pytest.approx(outputs.x[lowest] / 0.03, abs=0.01)
    assert outputs.camber_max < outputs.camber_mean

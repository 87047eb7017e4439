# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal engine where it is hard: it runs, or stops and says why."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import Diverged, NotConverged
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.plate import Plate
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.inflow_schedule import Course
from dewing_sim.rest import trim
from dewing_sim.verification.fluid.rigid_flow import parabola
from dewing_sim.wing import Wing


def bent(camber: float, dt: float, duration: float) -> float:
    """Return Cl at the end, over 1 c/U, of a flat plate that bends within 4 c/U."""
    fluid = engines.make('conformal', 'realtime', 2500.0, np.radians(4.0), dt)
    course, lift = Course('ramp', 0.0, 4.0), []
    flow = fluid.rest(Wall.flat(fluid.columns), 0.2)
    for step in range(1, round(duration / dt) + 1):
        value, rate, _ = camber * course(step * dt)
        wall = parabola(fluid.columns, value, rate)
        flow = fluid.correct(fluid.predict(flow, wall), wall.velocity)
        lift.append(fluid.loads(flow).cl)
    return float(np.mean(lift[-round(1.0 / dt):]))


def test_a_plate_bends_to_fifteen_percent_at_any_step():
    coarse, fine = (bent(0.15, dt, 6.0) for dt in (0.01, 0.005))
    assert coarse == pytest.approx(fine, rel=0.01)


def test_a_plate_that_bends_beyond_the_map_is_refused():
    with pytest.raises(NotConverged, match='the membrane is too strongly cambered'):
        bent(0.30, 0.02, 4.0)


@pytest.mark.parametrize('dt', [0.002, 0.005])
def test_no_response_of_the_wall_vorticity_resonates(dt):
    fluid = engines.make('conformal', 'realtime', 2500.0, 0.0, dt)
    flat = fluid.geometry.mapping.flat()
    for camber in np.linspace(0.0, 0.2, 21):
        m = fluid.geometry.mapping.follow(parabola(fluid.columns, camber, 0.0).height, flat)
        influence = fluid.edges.near(m).value.influence
        assert influence.decay.max() <= 1.0
        assert np.linalg.cond(influence.inverse) < 1.0e3


@pytest.mark.parametrize('reynolds', [100.0, 1000.0, 10000.0])
@pytest.mark.parametrize('alpha', [0.0, 6.0, 12.0])
@pytest.mark.parametrize('dt', [0.004, 0.02])
def test_any_incidence_and_reynolds_number_runs_or_stops_with_advice(alpha, reynolds, dt):
    plate = Plate(np.radians(alpha), 0.0, reynolds, 'realtime', dt, 'conformal')
    state, lift = plate.rest(), []
    try:
        while state.time < 3.0:
            state = plate.step(state)
            lift.append(plate.observe(state).cl)
    except Diverged as stopped:
        assert 'lower the time step' in str(stopped)
        assert dt == 0.02 and reynolds == 10000.0
    assert np.abs(lift[round(1.0 / dt):]).max(initial=0.0) < 0.3 + 0.25 * alpha
    if alpha == 0.0:
        assert np.abs(lift).max() < 1.0e-6


def test_a_wing_bears_violent_steps_of_the_voltage():
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
        'numerics.time_step': 5.0e-4, 'numerics.trim_time': 4.0}))
    state = trim.march(wing)
    calm = wing.observe(state).camber_max
    cambers = []
    for step in range(80):
        state = wing.step(state, Inputs(wing.case.actuation.voltage_limit**2 * (step // 7 % 2)))
        cambers.append(wing.observe(state).camber_max)
    assert calm < max(cambers) < 0.1 * wing.case.membrane.chord
    assert np.isfinite(wing.observe(state).cl)


def test_the_lift_of_a_bending_plate_is_free_of_noise():
    fluid = engines.make('conformal', 'fast', 2500.0, np.radians(4.0), 0.002)
    omega, lift = 2.0 * np.pi * 1.44, []
    flow = fluid.rest(Wall.flat(fluid.columns), 0.0)
    for step in range(1, 201):
        phase = omega * step * fluid.dt
        wall = parabola(fluid.columns, 0.005 * (1.0 - np.cos(phase)),
                        0.005 * omega * np.sin(phase))
        flow = fluid.correct(fluid.predict(flow, wall), wall.velocity)
        lift.append(fluid.loads(flow).cl)
    amplitude = np.ptp(lift[60:])
    assert amplitude > 0.5
    assert np.abs(np.diff(lift[60:], 3)).max() < 1.5e-4 * amplitude

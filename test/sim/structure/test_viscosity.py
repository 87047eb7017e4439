# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The viscous branches: relaxation, creep, rate independence of the rest, restarts, refusals."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.structure import elements
from dewing_sim.structure.dynamics.band import full
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator, advance
from dewing_sim.structure.material.viscosity import Prony

PRONY = Prony((0.5, 0.3), (0.02, 0.5))
SECTION = parameters.replace(parameters.load('paper').membrane,
                             {'elements': 16, 'viscous_share': 0.5, 'viscous_time': 0.01})
ELASTIC = elements.make(parameters.replace(SECTION, {'viscous_share': 0.0}))
VISCOUS = elements.make(SECTION)


@pytest.mark.parametrize('dt', [1.0e-3, 1.0e-2])
def test_stress_relaxes_with_the_series_whatever_the_time_step(dt):
    memory = PRONY.relaxed(np.zeros((2, 3)))
    jump = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    memory = PRONY.remember(memory, jump, 1.0e-9)
    for _ in range(round(0.1 / dt)):
        memory = PRONY.remember(memory, jump, dt)
    expected = 0.5 * np.exp(-5.0) + 0.3 * np.exp(-0.2)
    assert memory[:-1].sum(axis=0) == pytest.approx(expected * jump, rel=1e-6)


def test_a_ramp_of_stress_is_followed_exactly():
    memory, rate, dt = PRONY.relaxed(np.zeros((1, 1))), 7.0, 0.05
    for k in range(1, 11):
        memory = PRONY.remember(memory, np.array([[rate * k * dt]]), dt)
    exact = sum(share * rate * time * (1.0 - np.exp(-0.5 / time))
                for share, time in zip(PRONY.shares, PRONY.times))
    assert memory[:-1].sum() == pytest.approx(exact, rel=1e-12)


def test_gain_and_held_part_make_the_remembered_overstress():
    memory = PRONY.remember(PRONY.relaxed(np.ones((2, 4))), np.full((2, 4), 3.0), 0.01)
    stress = np.full((2, 4), -2.0)
    overstress = PRONY.instant_gain(0.01) * stress + PRONY.held(memory, 0.01)
    assert overstress == pytest.approx(
        PRONY.remember(memory, stress, 0.01)[:-1].sum(axis=0), rel=1e-12)


def settle(membrane, steps, dt=1.0e-3, pressure=20.0, motion=None):
    motion = motion or Motion.at_rest(membrane.rest_position)
    operator = Operator.of(membrane, dt, damping=2000.0)
    for _ in range(steps):
        motion = advance(membrane, motion, 1.0e5,
                         lambda p, w: membrane.pressure_force(p, pressure), operator)
    return motion


def test_a_viscous_membrane_creeps_to_the_elastic_shape():
    static = ELASTIC.equilibrium(20.0, 1.0e5)[8, 1]
    early, late = settle(VISCOUS, 5).position[8, 1], settle(VISCOUS, 150).position[8, 1]
    assert settle(ELASTIC, 5).position[8, 1] > early
    assert early < 0.99 * static
    assert late == pytest.approx(static, rel=1e-4)


def test_a_fast_stretch_meets_the_instantaneous_modulus():
    dt, position = 1.0e-7, VISCOUS.rest_position * [1.01, 1.0]
    motion = Motion.at_rest(VISCOUS.rest_position)
    during = VISCOUS.during(motion, dt, 0.0)
    stiffer = (during.tension(position, 0.0) - during.tension(VISCOUS.rest_position, 0.0)).mean()
    softer = (ELASTIC.tension(position, 0.0) - ELASTIC.tension(VISCOUS.rest_position, 0.0)).mean()
    change = np.diff([ELASTIC.sheet.deviatoric_stress(
        np.array([stretch]), ELASTIC.sheet.respond([stretch], 0.0).thickness)[:, 0]
        for stretch in (1.5, 1.515)], axis=0)[0]
    h = ELASTIC.sheet.respond([1.515], 0.0).thickness[0]
    along = 1.515 ** 2 * change[0] - (h / 5.0e-5) ** 2 * change[1]
    assert stiffer - softer == pytest.approx(0.5 * along * h, rel=1e-3)
    after = VISCOUS.after(motion, position, 0.0, dt)
    settled = VISCOUS.settled(Motion(position, position, position, position, after))
    assert settled.tension(position, 0.0) == pytest.approx(during.tension(position, 0.0), rel=1e-6)


def test_rest_and_steady_states_are_the_elastic_ones():
    still = settle(VISCOUS, 5, pressure=0.0)
    assert np.abs(still.position - VISCOUS.rest_position).max() < 1e-12
    assert VISCOUS.equilibrium(5.0, 1.0e5) == pytest.approx(ELASTIC.equilibrium(5.0, 1.0e5))
    assert settle(ELASTIC, 2).memory.size == 0


def test_a_restart_continues_bit_for_bit():
    through = settle(VISCOUS, 20)
    resumed = settle(VISCOUS, 10, motion=settle(VISCOUS, 10))
    for name, array in vars(through).items():
        assert np.array_equal(array, getattr(resumed, name)), name


SOLID = elements.make(parameters.replace(SECTION, {'element': 'solid', 'support': 'middle'}))


def test_solid_elements_creep_like_the_membrane():
    fine = parameters.replace(SECTION, {'elements': 64})
    thin, thick, elastic = (elements.make(parameters.replace(fine, changes)) for changes in (
        {}, {'element': 'solid', 'support': 'middle'}, {'viscous_share': 0.0}))
    for steps in (10, 20):
        height = settle(thin, steps, pressure=100.0).position[:, 1].max()
        assert thick.surface(settle(thick, steps, pressure=100.0).position)[:, 1].max(
            ) == pytest.approx(height, rel=1e-4)
        assert settle(elastic, steps, pressure=100.0).position[:, 1].max() > 1.06 * height


def test_a_held_solid_strip_relaxes_with_the_series():
    position = SOLID.rest_position * [1.02, 1.0 / 1.02]
    rest, time = Motion.at_rest(SOLID.rest_position), SECTION.viscous_time
    memory, found = SOLID.after(rest, position, 0.0, 1.0e-9), []
    dt, motion = 0.3 * time, Motion(position, position, position, position, memory)
    elastic = SOLID.tension(position, 0.0)
    for _ in range(4):
        found.append((SOLID.settled(motion).tension(position, 0.0) - elastic).mean())
        memory = SOLID.after(motion, position, 0.0, dt)
        motion = Motion(position, position, position, position, memory)
    thickness = SOLID.respond(SOLID.rest_position, 0.0).thickness[:1]
    change = [SOLID.sheet.deviatoric_stress(np.array([1.5 * stretch]), thickness / stretch)[0, 0]
              for stretch in (1.0, 1.02)]
    jump = 0.5 * 1.53 * SECTION.initial_thickness * (change[1] - change[0])
    assert found == pytest.approx(jump * np.exp(-0.3 * np.arange(4)), rel=1e-5)


def test_tangent_and_force_of_a_viscous_solid_belong_together():
    section = parameters.replace(SECTION, {'element': 'solid', 'elements': 6, 'chord': 0.002,
                                           'bulk_modulus': 1.0e6})
    solid = elements.make(section)
    rng = np.random.default_rng(1)
    bent = solid.rest_position + 5.0e-6 * rng.uniform(-1.0, 1.0, solid.rest_position.shape)
    during = solid.during(Motion(bent, bent, bent, bent, solid.after(
        Motion.at_rest(solid.rest_position), bent, 0.0, 1.0e-3)), 1.0e-3, 1.0e5)
    assert np.abs(during.overstress.held).max(axis=1).min() > 10.0

    def force(moved):
        return during.internal_force(moved, 1.0e5).ravel()[solid.free]
    computed = full(during.tangent(bent, 1.0e5))
    for column, i in enumerate(solid.free):
        step = np.zeros(bent.size)
        step[i] = 1.0e-10
        step = step.reshape(bent.shape)
        slope = (force(bent + step) - force(bent - step)) / 2.0e-10
        assert computed[:, column] == pytest.approx(slope, abs=1e-6 * np.abs(computed).max())


def test_a_viscous_solid_restarts_bit_for_bit():
    through, resumed = settle(SOLID, 6), settle(SOLID, 3, motion=settle(SOLID, 3))
    assert through.memory.shape == (2, 3, 64)
    assert np.array_equal(through.position, resumed.position)
    assert np.array_equal(through.memory, resumed.memory)


@pytest.mark.parametrize('shares, times', [((0.1,), ()), ((-0.1,), (1.0,)), ((0.1,), (0.0,))])
def test_impossible_series_are_refused(shares, times):
    with pytest.raises(BadInput, match='viscous branch'):
        Prony(shares, times)

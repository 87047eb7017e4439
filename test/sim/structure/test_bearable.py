# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The V^2 that a membrane bears in its present shape, against the sheet's own loss of tension."""

import math

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.scales import Scales
from dewing_sim.structure import elements
from dewing_sim.structure.bearable import Bearable
from dewing_sim.structure.dynamics.motion import Motion


def structure(**changes):
    case = parameters.load('paper', changes={
        'membrane.elements': 16, **{f'membrane.{name}': value for name, value in changes.items()}})
    return elements.make(case.membrane, Scales.of(case.flow, case.membrane.chord))


def cambered(membrane, camber=0.05):
    """Return the motion of a membrane bent and pulled unevenly along the chord."""
    position = membrane.rest_position.copy()
    x = position[:, 0]
    position[:, 1] += camber * np.sin(np.pi * x)
    position[:, 0] += 0.002 * np.sin(2.0 * np.pi * x)
    return Motion.at_rest(position)


@pytest.mark.parametrize('v_squared', [0.0, 900.0**2])
def test_it_is_the_loss_of_tension_of_the_least_stretched_element(v_squared):
    membrane = structure()
    motion = cambered(membrane)
    lost = membrane.sheet.loss_of_tension_v_squared(membrane.stretch(motion.position).min())
    assert Bearable(membrane, 0.05)(motion, v_squared) == pytest.approx(0.95 * lost, rel=1.0e-9)
    assert membrane.tension(motion.position, lost).min() == pytest.approx(0.0, abs=1.0e-9)


def test_a_margin_leaves_its_share_of_the_tension():
    membrane = structure()
    motion = cambered(membrane)
    left = membrane.tension(motion.position, Bearable(membrane, 0.1)(motion, 0.0)).min()
    assert left == pytest.approx(0.1 * membrane.tension(motion.position, 0.0).min(), rel=1.0e-4)


def test_without_a_margin_everything_is_borne():
    membrane = structure()
    assert Bearable(membrane, 0.0)(cambered(membrane), 0.0) == math.inf


def test_a_membrane_already_slack_bears_nothing():
    membrane = structure()
    loose = Motion.at_rest(membrane.rest_position * [0.6, 1.0])
    assert Bearable(membrane, 0.05)(loose, 0.0) == 0.0


def test_a_viscous_membrane_loses_its_tension_there_too():
    membrane = structure(viscous_share=0.3, viscous_time=0.01)
    motion = Motion.at_rest(membrane.rest_position)
    lost = Bearable(membrane, 1.0e-9)(motion, 500.0**2)
    tension = membrane.settled(motion).tension(motion.position, lost)
    assert np.abs(tension).max() < 1.0e-4 * membrane.rest_tension(0.0)


@pytest.mark.parametrize('support', ['lower', 'middle'])
def test_solid_elements_bear_what_the_sheet_does(support):
    solid = structure(element='solid', support=support)
    lost = Bearable(solid, 1.0e-9)(Motion.at_rest(solid.equilibrium(0.0, 1100.0**2)), 1100.0**2)
    assert lost == pytest.approx(solid.sheet.loss_of_tension_v_squared(1.5), rel=0.01)


def test_beyond_the_curve_elements_are_asked_one_by_one():
    membrane = structure()
    stretched = Motion.at_rest(membrane.rest_position * [1.5, 1.0])
    lost = membrane.sheet.loss_of_tension_v_squared(1.5 * 1.5)
    assert Bearable(membrane, 0.05)(stretched, 0.0) == pytest.approx(0.95 * lost, rel=1.0e-4)

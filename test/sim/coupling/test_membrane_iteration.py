# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled iteration of a membrane is the general one, or leaves it the work."""

from types import SimpleNamespace

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.coupling.membrane_iteration import MembraneIteration, iteration_of
from dewing_sim.coupling.transfer import Load
from dewing_sim.errors import Diverged, Slack
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.structure.dynamics.step import Motion, Operator, Step
from dewing_sim.structure.elements import make
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.sheet import Sheet
from dewing_sim.structure.tension_curve import HIGHEST, LOWEST, TensionCurve

SECTION = parameters.replace(parameters.load('paper').membrane, {'elements': 24})
MEMBRANE = Membrane.from_parameters(SECTION)
VISCOUS = Membrane.from_parameters(parameters.replace(SECTION, {'viscous_share': 0.5}))
CHORD, DT, V_SQUARED = MEMBRANE.chord, 1.0e-4, 2.5e5
PLACE = MEMBRANE.rest_position[:, :1] / CHORD
ARCH = CHORD * np.sin(np.pi * PLACE) * [[0.0, 1.0]]
MOTION = Motion(MEMBRANE.rest_position + 0.020 * ARCH, 2.0 * ARCH,
                MEMBRANE.rest_position + 0.019 * ARCH, 1.5 * ARCH)
OPERATOR = Operator.of(MEMBRANE, DT, damping=30.0)


def loaded(pressure: float = 10.0, inflow: Inflow | None = None) -> Load:
    """Return the load of a flow on 9 columns that resists motion."""
    columns = CHORD * np.linspace(0.0, 1.0, 10)**1.2
    rng = np.random.default_rng(2)
    fluid = SimpleNamespace(columns=columns, impedance=np.asfortranarray(
        10.0 * np.eye(9) + rng.uniform(0.0, 3.0, (9, 9))))
    return Load.of(fluid, MEMBRANE, pressure * rng.uniform(0.5, 1.5, 9),
                   0.05 * rng.normal(size=9), Inputs(0.0, 0.6, inflow))


def steps(motion: Motion = MOTION, v_squared: float = V_SQUARED, membrane: Membrane = MEMBRANE,
          ) -> tuple[Step, Step]:
    """Return the compiled step and the general one."""
    arguments = membrane.during(motion, DT, v_squared), motion, v_squared, OPERATOR
    return Step(*arguments, iteration_of(*arguments)), Step(*arguments)


@pytest.mark.parametrize('element, kind', [
    ('membrane', MembraneIteration), ('solid', type(None))])
def test_the_step_of_a_membrane_is_compiled(element, kind):
    structure = make(parameters.replace(SECTION, {'element': element}))
    iteration = iteration_of(structure, Motion.at_rest(structure.rest_position), 0.0,
                             Operator.of(structure, DT))
    assert type(iteration) is kind


@pytest.mark.parametrize('inflow', [None, Inflow(stream=1.0, pivot_acceleration=30.0 - 50.0j)])
@pytest.mark.parametrize('membrane', [MEMBRANE, VISCOUS])
def test_compiled_iteration_is_the_general_one(membrane, inflow):
    compiled, general = steps(membrane=membrane)
    position = MOTION.predict(DT) + 1.0e-3 * ARCH[:, ::-1]
    moved, size = compiled._iterate(loaded(inflow=inflow), position, None)
    expected, expected_size = general._iterate(loaded(inflow=inflow), position, None)
    assert expected_size > 1.0e-4 * CHORD
    assert moved == pytest.approx(expected, rel=1.0e-12, abs=1.0e-13 * CHORD)
    assert size == pytest.approx(expected_size, rel=1.0e-9)


@pytest.mark.parametrize('height', [0.02, 0.30])
def test_compiled_step_is_the_general_one_beyond_the_curve_too(height):
    motion = Motion.at_rest(MEMBRANE.rest_position + height * ARCH)
    stretch = MEMBRANE.stretch(motion.position).max() / MEMBRANE.prestretch
    assert (stretch > HIGHEST) == (height > 0.1)
    ends = [step.end(step.reach(loaded(), motion.predict(DT), 1.0e-10))
            for step in steps(motion)]
    assert np.abs(ends[0].position - motion.position).max() > 1.0e-5 * CHORD
    assert ends[0].position == pytest.approx(ends[1].position, abs=1.0e-9 * CHORD)
    assert ends[0].velocity == pytest.approx(ends[1].velocity, abs=1.0e-9 * 2.0 * CHORD / DT)


def test_compiled_step_ends_where_tension_or_numbers_end():
    slack, _ = steps(v_squared=1320.0**2)
    with pytest.raises(Slack, match='element .* has tension -'):
        slack.end(slack.reach(loaded(0.0), MOTION.predict(DT), 1.0e-10))
    compiled, _ = steps()
    with pytest.raises(Diverged, match='non-finite'):
        compiled.reach(loaded(np.nan), MOTION.predict(DT))


@pytest.mark.parametrize('v_squared', [0.0, 9.0e5])
@pytest.mark.parametrize('bulk_modulus', [1.0e5, 3.8e8])
def test_curve_is_the_tension_of_the_sheet(bulk_modulus, v_squared):
    sheet = Sheet.from_parameters(parameters.replace(SECTION, {'bulk_modulus': bulk_modulus}))
    curve = TensionCurve.of(sheet, 1.5, v_squared)
    stretch = 1.5 * np.linspace(LOWEST + 1.0e-9, HIGHEST - 1.0e-9, 50)
    tension = sheet.respond(stretch, v_squared).tension
    position = np.zeros((51, 2))
    position[1:, 1] = np.cumsum(stretch)
    found, lowest, is_covered = curve.along(position, np.ones(50))
    assert is_covered
    assert lowest == found.min()
    assert found == pytest.approx(tension, abs=1.0e-12 * tension.max())
    assert not curve.along(1.01 * position, np.ones(50))[2]
    assert not curve.along(0.99 * position, np.ones(50))[2]


def test_no_curve_where_the_chains_lock_or_the_thickness_pulls_in():
    assert TensionCurve.of(MEMBRANE.sheet, 10.0, 0.0) is None
    assert TensionCurve.of(MEMBRANE.sheet, 9.1, 0.0) is None
    soft = Sheet.from_parameters(parameters.replace(SECTION, {'bulk_modulus': 1.0e4}))
    assert TensionCurve.of(soft, 1.5, 1.0e8) is None

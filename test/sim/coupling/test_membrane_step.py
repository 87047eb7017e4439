# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled step of a membrane is the general one, bit by bit, in failures too."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.coupling.membrane_step import MembraneStep, step_of, tables_of
from dewing_sim.coupling.structure_step import StructureStep
from dewing_sim.errors import Diverged, RunFailed, Slack
from dewing_sim.fluid.base import Prediction, Wall
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import Measurement
from dewing_sim.rest import trim
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator
from dewing_sim.structure.elements import make
from dewing_sim.structure.membrane import Membrane
from dewing_sim.wing import Wing

SECTION = parameters.replace(parameters.load('paper').membrane, {'elements': 24})
MEMBRANE = Membrane.from_parameters(SECTION)
CHORD, DT, V_SQUARED = MEMBRANE.chord, 1.0e-4, 2.5e5
ARCH = CHORD * np.sin(np.pi * MEMBRANE.rest_position[:, :1] / CHORD) * [[0.0, 1.0]]
MOTION = Motion(MEMBRANE.rest_position + 0.020 * ARCH, 2.0 * ARCH,
                MEMBRANE.rest_position + 0.019 * ARCH, 1.5 * ARCH)
OPERATOR = Operator.of(MEMBRANE, DT, damping=30.0)
RNG = np.random.default_rng(2)
FLUID = SimpleNamespace(
    columns=CHORD * np.linspace(0.0, 1.0, 10)**1.2,
    impedance=np.asfortranarray(10.0 * np.eye(9) + RNG.uniform(0.0, 3.0, (9, 9))))
JUMP, REFERENCE = 10.0 * RNG.uniform(0.5, 1.5, 9), 0.05 * RNG.normal(size=9)
TABLES = tables_of(FLUID, MEMBRANE, OPERATOR)


def steps(v_squared=V_SQUARED, motion=MOTION):
    """Return the compiled step and the general one."""
    arguments = motion, Inputs(v_squared, 0.6)
    compiled = step_of(FLUID, MEMBRANE, OPERATOR, TABLES, *arguments)
    assert type(compiled) is MembraneStep
    return compiled, StructureStep(FLUID, MEMBRANE, OPERATOR, *arguments)


def flown(step, past, jump):
    """Return walls and motion of a step, as bytes, or kind and text of its failure."""
    walls = [step.foresee(past)]
    try:
        for factor in (1.0, 1.01):
            walls.append(step.answer(Prediction(Wall(walls[-1].height, REFERENCE), factor * jump,
                                                None)))
        motion = step.end()
    except RunFailed as error:
        return type(error), str(error)
    parts = [part for wall in walls for part in (wall.height, wall.velocity)]
    return [np.asarray(part).tobytes() for part in [*parts, *dataclasses.astuple(motion)]]


@pytest.mark.parametrize('past', [
    np.empty((0, 0)), JUMP[None], np.stack((JUMP, 0.9 * JUMP)),
    np.stack((0.5 * JUMP, 0.4 * JUMP, 0.45 * JUMP)), np.full((1, 9), np.nan)])
@pytest.mark.parametrize('motion', [MOTION, Motion.at_rest(MEMBRANE.rest_position + 0.3 * ARCH)])
def test_it_is_the_general_step_bit_by_bit(motion, past):
    """From a flat membrane, and from one that is stretched beyond the curve of tensions."""
    compiled, general = steps(motion=motion)
    found = flown(compiled, past, JUMP)
    assert found == flown(general, past, JUMP) and len(found) == 11
    usual = motion is MOTION and len(past) and not np.isnan(past).any()
    assert (compiled._general is None) is bool(usual)
    assert compiled.coasting.tobytes() == general.coasting.tobytes()


FLAT = Motion.at_rest(MEMBRANE.rest_position)


@pytest.mark.parametrize('v_squared, factor, kind, motion', [
    (1450.0**2, 0.0, Slack, FLAT), (1500.0**2, 0.0, Slack, MOTION),
    (V_SQUARED, np.nan, Diverged, MOTION), (V_SQUARED, np.inf, Diverged, MOTION)])
def test_it_fails_with_the_same_sentence(v_squared, factor, kind, motion):
    compiled, general = steps(v_squared, motion)
    found = flown(compiled, JUMP[None], factor * JUMP)
    assert found == flown(general, JUMP[None], factor * JUMP)
    assert found[0] is kind, found


def test_what_it_does_not_know_takes_the_general_step():
    accelerated = Inputs(0.0, 0.0, Inflow(stream=1.0, pivot_acceleration=30.0j))
    assert type(step_of(FLUID, MEMBRANE, OPERATOR, TABLES, MOTION, accelerated)) is StructureStep
    gusty = Inputs(0.0, 0.0, Inflow(stream=1.1, stream_rate=3.0))
    assert type(step_of(FLUID, MEMBRANE, OPERATOR, TABLES, MOTION, gusty)) is MembraneStep
    solid = make(parameters.replace(SECTION, {'element': 'solid'}))
    viscous = Membrane.from_parameters(parameters.replace(SECTION, {'viscous_share': 0.5}))
    assert tables_of(FLUID, solid, OPERATOR) is None
    assert tables_of(FLUID, viscous, OPERATOR) is None


@pytest.mark.parametrize('changes', [
    {'disturbance.pressure': 0.015, 'disturbance.frequency': 40.0, 'gust.shape': 'sine',
     'gust.vertical': 0.02, 'gust.duration': 0.01},
    {'actuation.amplifier_lag': 0.002, 'actuation.amplifier_slew_rate': 1.0e5,
     'rigid_motion.shape': 'one_minus_cosine', 'rigid_motion.heave': 1.0e-4}])
def test_a_wing_flies_the_same_way(changes):
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime', 'numerics.time_step': 5.0e-4,
        'numerics.trim_time': 0.5, 'membrane.elements': 32} | changes))
    one = other = trim.march(wing)
    general = wing.coupling()
    vars(general)['tables'] = None
    for k in range(40):
        inputs = Inputs((300.0 if k < 10 else 700.0 + k)**2)
        one = wing.step(one, inputs)
        wing._coupling, ours = general, wing._coupling
        other = wing.step(other, inputs)
        wing._coupling = ours
    assert one.iterations == other.iterations and one.residual == other.residual
    for name in ('w', 'psi', 'pressure', 'velocity', 'circulation'):
        assert np.array_equal(getattr(one.flow, name), getattr(other.flow, name)), name
    assert np.array_equal(one.motion.position, other.motion.position)
    assert np.array_equal(one.jump_history, other.jump_history)
    assert wing.measure(one) == Measurement.of(wing.observe(other))

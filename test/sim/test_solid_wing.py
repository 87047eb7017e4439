# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupled wing with solid elements against the one with membrane elements."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.inputs.amplifier import Amplifier
from dewing_sim.inputs.base import Inputs
from dewing_sim.rest.trim import march
from dewing_sim.structure import elements
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator, Step, advance
from dewing_sim.structure.solid.pins import MIDDLE
from dewing_sim.structure.solid.solid import Solid
from dewing_sim.verification.wing.solid_wing import compare
from dewing_sim.wing import Wing

COARSE = {'numerics.grid': 'fast', 'numerics.trim_time': 4.0, 'membrane.elements': 64}


def wing(**changes):
    changes = {name.replace('__', '.'): value for name, value in changes.items()}
    return Wing(parameters.load('paper', changes=COARSE | changes))


@pytest.mark.slow
def test_solid_and_membrane_agree():
    """With pins in the middle in everything; those at the lower side add their eccentricity."""
    case = parameters.load('paper', changes=COARSE | {'membrane.elements': 128})
    for found in compare(case, [0.0, 800.0], rest=march, steps=60):
        static = found.cl, found.camber_mean, found.camber_max
        assert np.abs(static).max() < 5e-3
        if found.support == MIDDLE:
            assert max(np.abs(static).max(), abs(found.pulse_peak), found.pulse_rms) < 5e-4
            assert found.pulse_cl_rms < 5e-3
        else:
            assert abs(found.pulse_peak) < 1e-2 and 1e-3 < found.pulse_rms < 1.5e-2


def test_solid_elements_are_stepped_from_flow_to_outputs():
    plant = wing(membrane__element='solid', membrane__elements=16, numerics__trim_time=0.1)
    assert isinstance(plant.membrane, Solid)
    state = plant.step(march(plant), Inputs(400.0 ** 2))
    outputs = plant.observe(state)
    assert outputs.x.shape == outputs.y.shape == outputs.pressure_jump.shape == (17,)
    assert (outputs.x[0], outputs.y[0]) == (0.0, 0.0)
    assert outputs.tension == pytest.approx(1.10, abs=0.01)
    # The pinned corners are thinner than the sheet.
    assert outputs.electric_field == pytest.approx(400.0 / 33.3e-6, rel=0.05)


def test_the_last_tangent_serves_the_next_load(monkeypatch):
    solid = elements.make(parameters.replace(parameters.load('paper').membrane,
                                             {'element': 'solid', 'elements': 16}))
    step = Step(solid, Motion.at_rest(solid.rest_position), 1.0e4, Operator.of(solid, 1.0e-4))
    made, tangent = [], Solid.tangent
    monkeypatch.setattr(Solid, 'tangent', lambda *args: made.append(1) or tangent(*args))
    counts, pressures = [], (0.35, 0.3501, 20.0)
    for pressure in pressures:
        position = step.reach(lambda p, w, q=pressure: solid.pressure_force(p, q),
                              solid.rest_position)
        counts.append(len(made))
    assert 0 < counts[0] == counts[1] < counts[2]
    alone = advance(solid, Motion.at_rest(solid.rest_position), 1.0e4,
                    lambda p, w: solid.pressure_force(p, pressures[-1]),
                    Operator.of(solid, 1.0e-4))
    assert np.abs(position - alone.position).max() < 1.0e-9 * solid.chord


def test_steps_with_solid_elements_repeat_bit_for_bit():
    plant = wing(membrane__element='solid', membrane__elements=16, numerics__trim_time=0.05)
    state = march(plant)
    results = []
    for _ in range(2):
        again = state
        for _ in range(3):
            again = plant.step(again, Inputs(1.0e5))
        results.append(again.motion.position)
    assert np.array_equal(*results)


def test_the_wing_sees_the_amplifier_s_voltage():
    plant = wing(numerics__trim_time=0.05, actuation__amplifier_lag=1.0e-3)
    state = plant.step(march(plant), Inputs(500.0 ** 2))
    expected = Amplifier(1250.0, lag=1.0e-3).drive(0.0, 500.0 ** 2, 1.0e-4)
    assert 0.0 < expected < 60.0 ** 2
    assert plant.observe(state).v_squared == expected


def test_a_viscous_membrane_is_stepped_and_remembers():
    plant = wing(numerics__trim_time=0.05, membrane__viscous_share=0.5,
                 membrane__viscous_time=0.01)
    state = plant.step(march(plant), Inputs(500.0 ** 2))
    assert state.motion.memory.shape == (2, 2, 64)
    assert np.isfinite(plant.observe(state).tension)

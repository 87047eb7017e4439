# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupled wing with solid elements against the one with membrane elements."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.amplifier import Amplifier
from dewing_sim.structure.solid import Solid
from dewing_sim.trim import march
from dewing_sim.wing import Wing

COARSE = {'numerics.grid': 'fast', 'numerics.trim_time': 4.0, 'membrane.elements': 64}


def wing(**changes):
    changes = {name.replace('__', '.'): value for name, value in changes.items()}
    return Wing(parameters.load('paper', changes=COARSE | changes))


def pulse_response(plant, rest, v_squared, steps):
    """Return what a V^2 of 1e5 held over one step adds to the mean camber."""
    cambers = []
    for height in (1.0e5, 0.0):
        state, camber = rest, []
        for k in range(steps):
            state = plant.step(state, v_squared + (height if k == 0 else 0.0))
            camber.append(plant.observe(state).camber_mean)
        cambers.append(camber)
    return np.subtract(*cambers)


@pytest.mark.slow
@pytest.mark.parametrize('volts', [0.0, 400.0, 800.0])
def test_solid_and_membrane_agree(volts):
    rests, pulses = [], []
    for element in ('membrane', 'solid'):
        plant = wing(membrane__element=element, actuation__voltage=volts)
        state = march(plant)
        rests.append(plant.observe(state))
        pulses.append(pulse_response(plant, state, volts ** 2, 60))
    thin, thick = rests
    assert thick.cl == pytest.approx(thin.cl, rel=5e-3)
    assert thick.camber_mean == pytest.approx(thin.camber_mean, rel=5e-3)
    assert thick.camber_max == pytest.approx(thin.camber_max, rel=5e-3)
    assert thick.tension == pytest.approx(thin.tension, rel=5e-3)
    # The pinned corners give way with the tension and take 0.4 % of the effect of a voltage.
    assert np.abs(pulses[1]).max() == pytest.approx(np.abs(pulses[0]).max(), rel=1e-2)
    assert np.linalg.norm(pulses[1] - pulses[0]) < 1.5e-2 * np.linalg.norm(pulses[0])


def test_solid_elements_are_stepped_from_flow_to_outputs():
    plant = wing(membrane__element='solid', membrane__elements=16, numerics__trim_time=0.1)
    assert isinstance(plant.membrane, Solid)
    state = plant.step(march(plant), 400.0 ** 2)
    outputs = plant.observe(state)
    assert outputs.x.shape == outputs.y.shape == outputs.pressure_jump.shape == (17,)
    assert (outputs.x[0], outputs.y[0]) == (0.0, 0.0)
    assert outputs.tension == pytest.approx(1.10, abs=0.01)
    # The pinned corners are thinner than the sheet.
    assert outputs.electric_field == pytest.approx(400.0 / 33.3e-6, rel=0.05)


def test_steps_with_solid_elements_repeat_bit_for_bit():
    plant = wing(membrane__element='solid', membrane__elements=16, numerics__trim_time=0.05)
    state = march(plant)
    results = []
    for _ in range(2):
        again = state
        for _ in range(3):
            again = plant.step(again, 1.0e5)
        results.append(again.motion.position)
    assert np.array_equal(*results)


def test_the_wing_sees_the_amplifier_s_voltage():
    plant = wing(numerics__trim_time=0.05, actuation__amplifier_lag=1.0e-3)
    state = plant.step(march(plant), 500.0 ** 2)
    expected = Amplifier(1250.0, lag=1.0e-3).drive(0.0, 500.0 ** 2, 1.0e-4)
    assert 0.0 < expected < 60.0 ** 2
    assert plant.observe(state).v_squared == expected


def test_a_viscous_membrane_is_stepped_and_remembers():
    plant = wing(numerics__trim_time=0.05, membrane__viscous_share=0.5,
                 membrane__viscous_time=0.01)
    state = plant.step(march(plant), 500.0 ** 2)
    assert state.motion.memory.shape == (2, 2, 64)
    assert np.isfinite(plant.observe(state).tension)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The offline loop on the reduced wing: target, disturbance, zero saturation, reproducibility."""

import control
import numpy as np
import pytest
from reduced_wing import CAMBER, SLACK, first_mode

from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity, loss_of_tension
from dewing_sim.linear.model import Model
from dewing_sim.linear.reduced import Reduced


def identity_of(plant):
    return Identity.of('reduced', plant, plant.rest(), plant.v_squared_max, {})


def run(steps=4000, disturbance=0.05, changes=None):
    """Return relative mean camber and V^2 of the loop with the shipped controller."""
    plant = first_mode(disturbance=disturbance)
    settings = parameters.load('controller', ControllerSettings, changes)
    law = controller(settings, identity_of(plant))
    outputs = [o for _, o in closed_loop(plant, plant.rest(), law, steps)]
    return (np.array([o.camber_mean for o in outputs]) / CAMBER,
            np.array([o.v_squared for o in outputs]))


def test_target_is_met_and_the_disturbance_rejected():
    camber, v_squared = run()
    second_half = camber[2000:]
    assert np.mean(second_half) == pytest.approx(1.10, abs=0.005)
    assert 0.5 * np.ptp(second_half) < 0.005
    assert np.min(v_squared) >= 0.0 and np.max(v_squared) < SLACK


def test_zero_saturation_binds_below_the_passive_camber():
    camber, v_squared = run(changes={'reference.target': 0.90}, disturbance=0.0)
    assert np.all(v_squared[-1000:] == 0.0)
    assert camber[-1] == pytest.approx(1.0, abs=1.0e-3)


def test_a_state_space_of_python_control_becomes_a_plant_and_flies():
    """A mode and a lag from a textbook, sampled by python-control, under LQG designed on it."""
    omega, damping = 2.0 * np.pi * 70.0, 0.05
    mode = control.tf([0.9 * CAMBER * omega**2], [1.0, 2.0 * damping * omega, omega**2])
    lag = control.tf([0.1 * CAMBER], [2.0e-3, 1.0])
    camber = control.sample_system(control.ss(mode + lag) / SLACK, 1.0e-4)
    both = control.ss([], [], [], [[1.0], [1.5]], 1.0e-4)
    model = Model.of_control(both * camber, output_names=('camber_mean', 'camber_max'),
                             operating_outputs=CAMBER * np.array([1.0, 1.5]),
                             v_squared_slack=SLACK, v_squared_max=1250.0**2)
    plant = Reduced(model, disturbance=-0.05 * model.operating_outputs, disturbance_frequency=10.0)
    law = controller(parameters.load('controller', ControllerSettings, {'kind': 'lqg'}),
                     identity_of(plant), Design.of(model, 'camber_mean'))
    late = [outputs.camber_mean / CAMBER
            for _, outputs in closed_loop(plant, plant.rest(), law, 3000)][-1000:]
    assert np.mean(late) == pytest.approx(1.10, abs=1.0e-4) and np.ptp(late) < 1.0e-3


def test_two_runs_agree_bit_for_bit():
    one, other = run(steps=300), run(steps=300)
    assert np.array_equal(one[0], other[0]) and np.array_equal(one[1], other[1])


def test_identity_survives_yaml_and_refuses_nonsense():
    identity = identity_of(first_mode())
    assert Identity.from_yaml(identity.to_yaml()) == identity
    with pytest.raises(BadInput, match='camber_mean = nan is not a finite number'):
        Identity.from_yaml(identity.to_yaml().replace(repr(CAMBER), '.nan'))
    with pytest.raises(BadInput, match='dt = 0.0 is not a positive number'):
        Identity.from_yaml(identity.to_yaml().replace(f'dt: {identity.dt!r}', 'dt: 0.0'))
    with pytest.raises(BadInput, match='not the identity of a plant'):
        Identity.from_yaml('just: words')


def test_loss_of_tension_of_the_shipped_cases():
    """Closed form h sqrt(sigma/eps) of physics: 1300 V and 814 V."""
    for name, voltage in (('paper', 1300.0), ('soft', 814.0)):
        assert loss_of_tension(parameters.load(name)) == pytest.approx(voltage**2, rel=2.0e-3)

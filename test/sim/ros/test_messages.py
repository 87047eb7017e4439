# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Messages carry outputs, commands and parameters without loss."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.plant import Measurement, Outputs
from dewing_sim.ros import messages

OUTPUTS = Outputs(time=1.2345, v_squared=1.0 / 3.0, cl=0.39, cd=0.06, cm=0.01,
                  camber_mean=2.0e-5 / 3.0, camber_max=3.0e-5 / 7.0, camber_max_position=0.4,
                  tension=1.2, x=np.array([0.0, 0.015, 0.03]), y=np.array([0.0, 2.5e-5, 0.0]),
                  pressure_jump=np.array([0.9, 0.4, 0.1]))


def test_measurement_is_exact_and_stamped_with_simulated_time():
    message = messages.measurement(OUTPUTS)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 234_500_000)
    assert messages.to_measurement(message) == Measurement.of(OUTPUTS)
    assert list(message.name) == ['camber_mean', 'camber_max', 'cl', 'cd', 'v_squared']


def test_measurement_without_a_quantity_is_refused():
    message = messages.measurement(OUTPUTS)
    message.name, message.position = message.name[1:], message.position[1:]
    measured = messages.to_measurement(message)
    assert measured.cl == 0.39 and not hasattr(measured, 'camber_mean')
    with pytest.raises(BadInput, match='measurement without camber_mean; it has camber_max, cl'):
        assert measured.camber_mean


@pytest.mark.parametrize('names', [['cl', 'cl'], ['cl', 'time'], ['cl', 'joint-2'], ['cl']])
def test_measurement_with_unusable_names_is_refused(names):
    with pytest.raises(BadInput, match='unusable names|1 names and 2 positions'):
        messages.to_measurement(messages.JointState(name=names, position=[0.4, 0.5]))


def test_what_a_plant_does_not_have_is_not_in_the_message():
    message = messages.measurement(Outputs(time=0.0, v_squared=4.0, camber_mean=2.0e-5))
    assert list(message.name) == ['camber_mean', 'v_squared']
    assert messages.to_measurement(message) == (0.0, 2.0e-5, 4.0)


def test_a_measurement_survives_copies_and_processes():
    for measured in (Measurement.of(OUTPUTS), Measurement.of(Outputs(time=0.1, v_squared=4.0))):
        again = pickle.loads(pickle.dumps(measured))
        assert again == measured and type(again) is type(copy.deepcopy(measured)) is type(measured)


def test_command_is_exact_and_keeps_the_stamp():
    message = messages.command(2.0e5 / 3.0, messages.to_stamp(123_456_789_012))
    assert messages.from_stamp(message.header.stamp) == 123_456_789_012
    assert messages.to_v_squared(message) == 2.0e5 / 3.0
    message.name = ['voltage']
    with pytest.raises(BadInput, match='expected one effort named v_squared'):
        messages.to_v_squared(message)


def test_membrane_has_shape_pressure_and_tension_as_float32():
    message = messages.membrane(OUTPUTS)
    points = np.frombuffer(message.data, '<f4').reshape(message.width, -1)
    assert [field.name for field in message.fields] == ['x', 'y', 'z', 'dp', 'tension']
    assert len(message.data) == message.row_step == 3 * message.point_step
    expected = np.stack([OUTPUTS.x, OUTPUTS.y, 0.0 * OUTPUTS.x, OUTPUTS.pressure_jump,
                         np.full(3, OUTPUTS.tension)], axis=1)
    np.testing.assert_allclose(points, expected, rtol=1.0e-6)


def test_loads_are_coefficients_times_q_c_and_right_handed():
    flow, chord = parameters.load('paper').flow, 0.03
    wrench = messages.loads(OUTPUTS, flow, chord).wrench
    scale = 0.5 * flow.density * flow.speed**2 * chord
    assert wrench.force.x == pytest.approx(0.06 * scale)
    assert wrench.force.y == pytest.approx(0.39 * scale)
    assert wrench.torque.z == pytest.approx(-0.01 * scale * chord)


def test_diagnostics_carry_every_value_as_text():
    status = messages.diagnostics('node', messages.WARN, 'late', {'steps': 3, 'share': 0.5},
                                  messages.to_stamp(0)).status[0]
    assert (status.name, status.level, status.message) == ('node', b'\x01', 'late')
    assert [(item.key, item.value) for item in status.values] == [('steps', '3'),
                                                                  ('share', '0.5')]


def test_descriptors_state_unit_meaning_and_range():
    fields = dict(parameters.fields(ControllerSettings))
    rate = messages.descriptor(fields['reference.rate'], read_only=False)
    assert rate.description == ('largest rate of change of the reference [1/s], '
                                'from 1e-06 to 1e+06')
    assert rate.floating_point_range[0].to_value == 1.0e6 and not rate.read_only
    period = messages.descriptor(fields['command.period_steps'], read_only=True)
    assert period.integer_range[0].from_value == 1 and period.read_only
    output = messages.descriptor(fields['reference.output'], read_only=False)
    assert output.additional_constraints == 'one of camber_mean, camber_max'


@dataclasses.dataclass
class Given:
    name: str
    value: object


def test_changes_are_all_taken_or_refused_with_a_reason():
    settings = parameters.load('controller', ControllerSettings)
    after, answer = messages.changed(settings, [Given('pid.kp', 5.0), Given('use_sim_time', True)])
    assert answer.successful and after.pid.kp == 5.0
    after, answer = messages.changed(settings, [Given('pid.kp', 5.0), Given('pid.ki', -1.0)])
    assert not answer.successful and after is settings
    assert answer.reason.startswith('pid.ki = -1.0 is out of range')

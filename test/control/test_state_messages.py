# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller publishes of its thoughts: the numbers of every law, and over DDS."""

import math

import numpy as np
import pytest
from rclpy.node import Node
from reduced_wing import CAMBER, first_mode
from ros_processes import PATIENCE, graph
from sensor_msgs.msg import JointState

from dewing_control.law import mpc, periodic, pid
from dewing_control.settings import ControllerSettings
from dewing_control.state_messages import state, terms
from dewing_control.trial.closed_loop import controller
from dewing_sim import parameters
from dewing_sim.identity import Identity
from dewing_sim.plant import Measurement
from dewing_sim.ros import harness, qos


def test_terms_are_the_numbers_of_a_memory_by_name():
    base = pid.Memory(1.05, 0.2, -0.1, 0.03)
    assert dict(terms(base)) == dict(reference=1.05, sum=0.2, derivative=-0.1, error=0.03)
    found = dict(terms(periodic.Memory(base, (3.0 + 4.0j, 0j))))
    assert found == dict(terms(base)) | {'phasors_1': 5.0, 'phasors_2': 0.0}
    assert dict(terms(mpc.Memory(base, np.zeros(40), np.ones(2)))) == dict(terms(base)) | {
        'dual_1': 1.0, 'dual_2': 1.0, 'falling': 0.0}
    assert dict(terms(7.5)) == {'memory': 7.5} and dict(terms(None)) == {}
    assert dict(terms(pid.Memory(None, math.nan, 0.0, 1.0))) == dict(derivative=0.0, error=1.0)


def test_the_state_of_a_step_says_what_it_was_about():
    plant = first_mode()
    identity = Identity.of('reduced', plant, plant.rest(), plant.v_squared_max, {})
    law = controller(parameters.load('controller', ControllerSettings), identity)
    seen = Measurement(0.0, CAMBER, 1.5 * CAMBER, 0.4, 0.1, 0.0)
    memory, v_squared = law.step(law.start(0.0), seen)
    memory, v_squared = law.step(memory, seen._replace(camber_mean=0.9 * CAMBER))
    found = state(seen._replace(camber_mean=0.9 * CAMBER), 'camber_mean', identity, law, memory,
                  v_squared)
    assert found['camber'] == pytest.approx(0.9)
    assert found['error'] == pytest.approx(found['reference'] - 0.9)
    assert found['error'] == pytest.approx(memory.inner.error)
    assert found['v_squared_share'] == pytest.approx(v_squared / plant.v_squared_slack)
    assert found['saturated'] == (v_squared in (0.0, law.limit))
    assert {'term_sum', 'term_derivative'} < found.keys()


class Listener(Node):
    """Keeps the states of the controller and the commands."""

    def __init__(self, _parameters=None, **options):
        super().__init__('listener', namespace='dewing', **options)
        self.states, self.commands = {}, {}
        for topic, kept in (('controller/state', self.states), ('command', self.commands)):
            self.create_subscription(
                JointState, topic, lambda message, kept=kept: kept.setdefault(
                    (message.header.stamp.sec, message.header.stamp.nanosec), message), qos.LOOP)


def test_every_answer_is_told_with_its_stamp(tmp_path):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        listener = session.add(Listener)
        processes.controller({'reference.target': 1.02})
        simulator = processes.simulator(duration=0.01)
        session.spin_until(lambda: simulator.poll() is not None
                           and len(listener.states) >= 100, PATIENCE)
    for stamp, said in listener.states.items():
        values = dict(zip(said.name, said.position))
        assert values['v_squared'] == listener.commands[stamp].effort[0]
        assert 0.0 < values['latency'] < PATIENCE and math.isfinite(sum(values.values()))
    assert {'reference', 'camber', 'error', 'saturated', 'term_sum'} < values.keys()

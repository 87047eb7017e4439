# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The harness in three worked examples: a loop, a controller of one's own, an injected fault."""

import math

import pytest
from rclpy.node import Node
from reduced_wing import first_mode
from ros_processes import PATIENCE
from sensor_msgs.msg import JointState

from dewing_control.node import ControllerNode
from dewing_sim.linear import reduced
from dewing_sim.ros import harness, messages, qos
from dewing_sim.ros.node import SimulatorNode


@pytest.fixture
def plant(tmp_path):
    """Return parameters of a simulator of a linear wing; leave them out for the wing itself."""
    reduced.save(tmp_path / 'model.npz', first_mode(disturbance=0.05))
    return {'run.plant': 'reduced', 'model': str(tmp_path / 'model.npz'),
            'save': str(tmp_path / 'state.npz')}


# 1. A closed loop in ten lines.

def test_a_closed_loop(plant):
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        simulator = session.add(SimulatorNode, plant | {'run.duration': 0.1})
        session.add(ControllerNode, {'reference.target': 1.10})
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    camber = simulator.lockstep.outputs.camber_mean / simulator.identity.camber_mean
    assert simulator.exit_status == 0 and 1.0 < camber < 1.2


# 2. A controller of your own against our simulator.

class Bang(Node):
    """Switches between no and half the admissible V^2 at 1.05 times the camber at rest."""

    def __init__(self, _parameters=None, **options):
        super().__init__('bang', namespace='dewing', **options)
        self.rest, self.seen = None, []
        self.command = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(JointState, 'measurement', self.answer, qos.LATEST)

    def answer(self, message):
        camber = messages.to_measurement(message).camber_mean
        self.rest = self.rest or camber
        self.seen.append(camber / self.rest)
        v_squared = 8.0e5 if camber < 1.05 * self.rest else 0.0
        qos.publish(self.command, messages.command(v_squared, message.header.stamp))


def test_a_controller_of_your_own(plant):
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        simulator = session.add(SimulatorNode, plant | {'run.duration': 0.1})
        controller = session.add(Bang)
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    late = controller.seen[len(controller.seen) // 2:]
    assert 1.02 < sum(late) / len(late) < 1.12


# 3. A fault injected: the controller dies for good in the middle of the run.

class Mortal(ControllerNode):
    """A controller that falls silent after a hundred answers."""

    def _on_measurement(self, read):
        if read.stamp < 10_000_000:
            super()._on_measurement(read)


def test_an_injected_fault(plant):
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        simulator = session.add(SimulatorNode, plant | {
            'run.command_timeout': 1.0, 'run.hold_timeout': 2.0})
        session.add(Mortal)
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert simulator.exit_status == 1 and 'no valid command for' in simulator.reason
    saved = simulator.built.load(plant['save'])
    assert saved.step == 100 and math.isfinite(simulator.lockstep.outputs.camber_mean)

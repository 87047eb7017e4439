# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Laws of one's own as nodes over DDS: each stamp is answered once, whatever is sent again."""

import time

import numpy as np
import pytest
from rclpy.node import Node
from reduced_wing import first_mode
from ros_processes import PATIENCE, graph
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from dewing_control.answers import Answers
from dewing_control.law_node import LawNode, law_node
from dewing_control.trial.closed_loop import closed_loop
from dewing_sim.plant import Measurement
from dewing_sim.ros import harness, messages, qos

RATE = 50.0                 # V_L^2 per second and passive camber
STALLED = 50                # step in which the controller is slow
DURATION = 0.01             # s


class Integrator(LawNode):
    """V^2 grows at a rate proportional to the missing camber."""

    def __init__(self, *given, **options):
        super().__init__(*given, **options)
        self.target = self.declare_parameter('target', 1.02).value
        self.steps, self.asked = 0, []

    def start(self, v_squared=0.0):
        return v_squared

    def step(self, memory, measurement):
        self.steps += 1
        if self.steps == STALLED:
            time.sleep(0.5)
        error = self.target - measurement.camber_mean / self.identity.camber_mean
        memory += RATE * self.identity.dt * error * self.identity.v_squared_slack
        memory = min(max(memory, 0.0), self.limit)
        self.asked.append(memory)
        return memory, memory


class Naive(Node):
    """Counts messages as if each were another step, as a first attempt would."""

    def __init__(self, _parameters=None, **options):
        super().__init__('naive', namespace='dewing', **options)
        self.steps = 0
        self.out = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(JointState, 'measurement', self.answer, qos.LATEST)

    def answer(self, measurement):
        self.steps += 1
        if self.steps == STALLED:
            time.sleep(0.5)
        qos.publish(self.out, messages.command(0.0, measurement.header.stamp))


def flown(tmp_path, make, parameters=None):
    """Return the node that flew against a simulator process, which repeats after 50 ms."""
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        node = session.add(make, parameters)
        simulator = processes.simulator(duration=DURATION, resend_period=0.05,
                                        delivery_timeout=1.0)
        session.spin_until(lambda: simulator.poll() is not None, PATIENCE)
        assert simulator.returncode == 0, processes.said('simulator')
        return node


def test_a_law_acts_once_for_each_step_where_a_naive_node_acts_again_in_a_stall(tmp_path):
    steps = round(DURATION / first_mode().dt)
    assert flown(tmp_path, Naive).steps >= steps + 3
    node = flown(tmp_path, Integrator, {'target': 1.03})
    assert steps <= node.steps <= steps + 1     # the last measurement may come too late
    assert node.answers.begun == 1 and node.answers.made == node.steps
    plant = first_mode(disturbance=0.05)
    over_dds, node.asked = node.asked[:steps], []
    list(closed_loop(plant, plant.rest(), node, steps))
    assert over_dds == node.asked and np.ptp(over_dds) > 0.0


@law_node
def leak(memory, measurement):
    """Remember how many measurements came."""
    seen = 0 if memory is None else memory
    return seen + 1, min(100.0 * seen, 1.0e4)


def test_a_function_becomes_a_node_which_begins_anew_after_a_reset(tmp_path):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        node = session.add(leak)
        processes.simulator(plant='reduced')
        session.spin_until(lambda: node.answers and node.answers.made > 20, PATIENCE)
        reset = node.create_client(Trigger, 'simulator/reset')
        session.spin_until(reset.service_is_ready, PATIENCE)
        before, made = node.answers.stamp, node.answers.made
        reset.call_async(Trigger.Request())
        session.spin_until(lambda: node.answers.begun == 2, PATIENCE)
        session.spin_until(lambda: node.answers.made > made + 5, PATIENCE)
        assert node.answers.memory.inner < made and node.answers.begun == 2 and before > 0
    assert leak.__name__ == 'leak' and 'how many' in leak.__doc__


@law_node
def broken(memory, measurement):
    """Fail."""
    return memory, 1.0 / 0.0


def test_a_law_that_fails_ends_its_node_with_one_sentence(tmp_path):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        node = session.add(broken)
        processes.simulator()
        session.spin_until(lambda: node.exit_status is not None, PATIENCE)
        assert node.exit_status == 1 and 'ZeroDivisionError' in node.reason


class Fragile:
    """A law that refuses the measurement at 1 s and remembers how often it stepped."""

    def start(self, v_squared=0.0):
        return 0

    def step(self, memory, measurement):
        if measurement.time == 1.0:
            raise ValueError('no')
        return memory + 1, 10.0 * (memory + 1)


def test_a_refused_measurement_leaves_memory_and_stamp_as_they_were():
    answers = Answers(Fragile())
    seen = Measurement(0.0, *np.zeros(len(Measurement._fields) - 1))
    assert [answers.to(stamp, seen) for stamp in (0, 0, 1, 1, 2)] == [10., 10., 20., 20., 30.]
    with pytest.raises(ValueError):
        answers.to(3, seen._replace(time=1.0))
    assert answers.to(3, seen) == 40.0 and answers.to(1, seen) == 10.0
    assert answers.figures == dict(v_squared=10.0, answers=5, begun=2)

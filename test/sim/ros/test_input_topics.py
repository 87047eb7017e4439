# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gusts, motions and pressures over topics: what acts is what was asked for, and is recorded."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Vector3Stamped
from gusty_plant import Plant
from rclpy.node import Node
from ros_processes import PATIENCE, graph, last_status
from sensor_msgs.msg import FluidPressure, JointState

from dewing_control.law_node import law_node
from dewing_sim import parameters
from dewing_sim.inputs.outside import OutsideInputs
from dewing_sim.records import bag
from dewing_sim.ros import harness, messages, qos

CASE = parameters.load('paper')
DT = CASE.numerics.time_step
STEPS = 300
# Stamp in ns, topic and values; of the motion rates as well.
PLAN = ((5_000_000, 'gust', [0.05, 0.2], []),
        (8_000_000, 'pressure_disturbance', [-0.02], []),
        (10_000_000, 'motion', [0.0, 0.03], [0.0, 1.0]),
        (12_000_000, 'motion', [0.001, 0.032], [0.0, 1.0]),
        (20_000_000, 'gust', [0.0, 0.0], []))


def message_of(topic, stamp, value, rate=()):
    """Return a message as any node would publish it."""
    if topic == 'gust':
        message = Vector3Stamped()
        message.vector.x, message.vector.y, *_ = [*value, 0.0]
    elif topic == 'motion':
        message = JointState(name=['heave', 'pitch'], position=value, velocity=rate)
    else:
        message = FluidPressure(fluid_pressure=value[0])
    message.header.stamp = messages.to_stamp(stamp)
    return message


class Weather(Node):
    """Publishes gusts, motions and pressures, and keeps the reports of the simulator."""

    def __init__(self, _parameters=None, **options):
        super().__init__('weather', namespace='dewing', **options)
        self.out = {topic: self.create_publisher(kind, topic, qos.EVENTS) for topic, kind in (
            ('gust', Vector3Stamped), ('pressure_disturbance', FluidPressure),
            ('motion', JointState))}
        self.said, self.values = [], {}
        self.create_subscription(messages.DiagnosticArray, '/diagnostics', self.hear, qos.EVENTS)

    @property
    def heard(self):
        return all(each.get_subscription_count() for each in self.out.values())

    def hear(self, message):
        for status in message.status:
            if status.name == '/dewing/simulator':
                self.said.append(status.message)
                self.values = {item.key: item.value for item in status.values}


@law_node
def nothing(memory, measurement):
    """Ask for no voltage."""
    return memory, 0.0


def offline():
    """Return measured Cl and what acted, by stamp, of the same flight in this process."""
    plant = Plant(CASE)
    inputs = OutsideInputs(plant, CASE.flow.speed, CASE.flow.dynamic_pressure,
                           CASE.membrane.chord, 2.0e-3)
    state, lift, acted = plant.rest(), {}, {}
    for stamp, topic, value, rate in PLAN:
        inputs.give(topic, stamp, 0, value, rate)
    for _ in range(STEPS):
        begin = round(plant.observe(state).time * 1.0e9)
        state = plant.step(state, inputs.during(0.0, begin, plant.observe(state).time + plant.dt))
        stamp = round(plant.observe(state).time * 1.0e9)
        lift[stamp], acted[stamp] = plant.observe(state).cl, inputs.acting[1:]
    return lift, acted


def test_what_was_asked_for_acts_in_its_step_and_stands_in_the_bag(tmp_path):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        weather, path = session.add(Weather), processes.recorder()
        simulator = processes.simulator(
            plant='gusty_plant:Plant', subscribers=2, duration=STEPS * DT)
        # Simulator and recorder listen: what is published before nobody gets.
        session.spin_until(processes.alive(lambda: weather.heard and all(
            each.get_subscription_count() >= 2 for each in weather.out.values())), PATIENCE)
        for stamp, topic, value, rate in PLAN:      # long before their time: nothing races
            weather.out[topic].publish(message_of(topic, stamp, value, rate))
        session.spin_until(lambda: all(
            each.wait_for_all_acked() for each in weather.out.values()), PATIENCE)
        session.add(nothing, {'command.subscribers': 2})
        session.spin_until(lambda: simulator.poll() is not None, PATIENCE)
        assert simulator.returncode == 0, processes.said('simulator')
    lift, acted = offline()
    measured = bag.series(path, '/dewing/measurement')
    stamps = np.round(measured['time'] * 1.0e9).astype(int)
    assert dict(zip(stamps[1:], measured['cl'][1:])) == lift
    told = {messages.from_stamp(each.message.header.stamp):
            [each.message.position.tolist(), each.message.velocity.tolist()]
            for each in bag.read(path, '/dewing/inputs')}
    assert min(told) == 5_100_000               # led to by the step that began at 5 ms
    assert told == {stamp: list(values) for stamp, values in acted.items() if stamp in told}
    assert len(told) == STEPS - 50
    _, values = last_status(path)
    assert (values['refused_inputs'], values['late_inputs']) == ('0', '0')


BAD = [('gust', [math.nan, 0.0], [], 'gust_along = nan m/s at 0.0 m/s/s is not finite'),
       ('gust', [0.0, 0.1, 0.2], [], 'the wing is a section: z must be zero'),
       ('pressure_disturbance', [1.0e9], [], 'is out of range'),
       ('motion', [0.0, math.inf], [0.0, 0.0], 'is not finite'),
       ('motion', [0.1], [], 'motion with names'),
       ('motion', [0.1, 0.0], [0.0, 0.0], 'heave would move at')]


@pytest.mark.parametrize('plant, expected', [
    ('gusty_plant:Plant', [said for *_, said in BAD]),
    ('reduced', ['the wing is a section' if '0.2' in str(value) else
                 'motion with names' if len(value) == 1 and topic == 'motion' else
                 'this plant takes no input but V^2' for topic, value, *_ in BAD])])
def test_a_bad_message_is_refused_with_one_sentence_and_counted(tmp_path, plant, expected):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        weather = session.add(Weather)
        processes.simulator(plant=plant, discovery_timeout=300.0)
        session.spin_until(processes.alive(lambda: weather.heard and weather.values and all(
            each.get_subscription_count() >= 1 for each in weather.out.values())), PATIENCE)
        for count, ((topic, value, rate, _), said) in enumerate(zip(BAD, expected), start=1):
            message = message_of(topic, 0, value, rate)
            if len(value) == 3:
                message.vector.z = value[2]
            weather.out[topic].publish(message)
            session.spin_until(lambda count=count: weather.values['refused_inputs'] == str(count),
                               PATIENCE)
            assert any(said in sentence for sentence in weather.said), (said, weather.said[-2:])
        assert all('\n' not in sentence for sentence in weather.said)

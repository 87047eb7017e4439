# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time and the names of several wings in one domain."""

from types import SimpleNamespace

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from ros_processes import PATIENCE, graph
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool

from dewing_control.node import ControllerNode
from dewing_sim import parameters
from dewing_sim.plant import Outputs
from dewing_sim.records import bag
from dewing_sim.ros import harness, messages, names, qos
from dewing_sim.ros.telemetry import Telemetry
from dewing_sim.settings import SimulatorSettings


class Watcher(Node):
    """Keeps the times of clocks and the diagnostics of every node."""

    def __init__(self, *clocks, **options):
        super().__init__('watcher', namespace='dewing', **options)
        self.times = {topic: [] for topic in clocks}
        self.statuses = []
        for topic in clocks:
            self.create_subscription(Clock, topic, lambda message, topic=topic: self.times[
                topic].append(messages.from_stamp(message.clock)), qos.EVENTS)
        self.create_subscription(DiagnosticArray, '/diagnostics', lambda message:
                                 self.statuses.extend(message.status), qos.EVENTS)
        self.pause = self.create_client(SetBool, 'simulator/pause')

    def said(self, name, part):
        return any(status.name == name and part in status.message for status in self.statuses)


@pytest.fixture
def both(tmp_path):
    """Return processes and a session of this process, in one domain."""
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        yield ros, session


def test_a_controller_may_wait_for_the_clock_and_a_pause_does_not_stop_it(both):
    ros, session = both
    watcher = session.add(lambda _, **options: Watcher('/clock', **options))
    ros.simulator()
    times = watcher.times['/clock']
    session.spin_until(lambda: len(times) > 2, PATIENCE)    # before there is a controller
    assert set(times) == {0}
    session.add(ControllerNode)
    session.spin_until(lambda: times[-1] > 20_000_000, PATIENCE)
    paused = watcher.pause.call_async(SetBool.Request(data=True))
    session.spin_until(paused.done, PATIENCE)
    session.spin_until(lambda: len(times) > 4 and times[-1] == times[-4], PATIENCE)
    assert np.all(np.diff(times) >= 0)


def wings(ros, name, values):
    """Start a wing in a namespace of its own for each value of the setting ``name``."""
    for number, value in enumerate(values, start=1):
        ros.start('simulator', {
            'run.plant': 'reduced', 'model': ros.model, 'run.mode': 'free',
            'run.subscribers': 0, name: value}, arguments=['-r', f'__ns:=/wing{number}'])


def test_two_wings_with_one_clock_are_warned_of(both):
    ros, session = both
    watcher = session.add(lambda _, **options: Watcher(**options))
    wings(ros, 'run.publish_clock', [True, True])
    for number in (1, 2):
        session.spin_until(lambda name=f'/wing{number}/simulator': watcher.said(
            name, '1 more publish /clock, which jumps to and fro'), PATIENCE)
    assert {status.hardware_id for status in watcher.statuses} == {'wing1', 'wing2'}


@pytest.mark.parametrize('name, values, topics', [
    ('run.publish_clock', [True, False], ['/clock']),
    ('run.clock_topic', ['clock', 'clock'], ['/wing1/clock', '/wing2/clock'])])
def test_two_wings_share_a_domain_where_each_clock_has_one_publisher(both, name, values, topics):
    ros, session = both
    watcher = session.add(lambda _, **options: Watcher(*topics, **options))
    wings(ros, name, values)
    session.spin_until(lambda: all(len(times) > 50 for times in watcher.times.values()), PATIENCE)
    session.spin_until(lambda: {status.hardware_id for status in watcher.statuses}
                       == {'wing1', 'wing2'}, PATIENCE)
    assert all(np.all(np.diff(times) >= 0) for times in watcher.times.values())
    assert not any('jumps' in status.message for status in watcher.statuses)
    assert watcher.count_publishers('/clock') == topics.count('/clock')


@pytest.mark.parametrize('namespace, prefix', [('dewing', ''), ('wing1', 'wing1/')])
def test_frames_carry_the_namespace_of_another_wing(namespace, prefix):
    line = np.array([0.0, 0.5, 1.0])
    outputs = Outputs(time=0.0, v_squared=0.0, cl=0.3, cd=0.1, cm=0.0, x=line, y=0.0 * line,
                      pressure_jump=line, tension=1.0)
    lockstep = SimpleNamespace(outputs=outputs, time=outputs.time)
    run = parameters.load('simulator', SimulatorSettings).run
    frames = {}
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        wing = session.add(lambda _, **options: Node('wing', namespace=namespace, **options))
        telemetry = Telemetry(wing, parameters.load('paper'), run, 1.0e-4, outputs)
        for topic, kind in (('membrane', PointCloud2), ('loads', WrenchStamped)):
            wing.create_subscription(kind, topic, lambda message, topic=topic: frames.update(
                {topic: message.header.frame_id}), qos.EVENTS)
        session.spin_until(lambda: telemetry.listeners == 2, PATIENCE)
        telemetry.publish(lockstep)
        session.spin_until(lambda: len(frames) == 2, PATIENCE)
    assert frames == {'membrane': f'{prefix}wing', 'loads': f'{prefix}wind'}


@pytest.mark.parametrize('namespace, word', [
    ('/dewing', 'wing'), ('/wing1', 'wing1/wing'), ('/fleet/left', 'fleet/left/wing'),
    ('/', 'wing')])
def test_a_frame_is_named_after_its_namespace(namespace, word):
    assert names.frame(namespace, 'wing') == word
    assert names.hardware(namespace) == (namespace.strip('/') or 'dewing')


def test_the_first_sample_reaches_every_topic_of_who_is_waited_for(both):
    """The recorder subscribes to measurement last, and the simulator offers it last."""
    ros, session = both
    path = ros.recorder()
    simulator = ros.simulator(mode='free', subscribers=1, duration=0.001)
    assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
    ros.stop()
    counts = {}
    for topic, _, message in bag.read(path):
        counts.setdefault(topic, []).append(message)
    assert len(counts['/dewing/cl']) == len(counts['/dewing/camber']) == 2      # at 0 and 1 ms
    assert len({message.header.stamp.nanosec for message in counts['/dewing/measurement']}) == 11

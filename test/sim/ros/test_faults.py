# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Faults injected into a loop over DDS: each has a stated behaviour, and costs no step."""

import math
import random
import resource
import signal
import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from reduced_wing import first_mode
from ros_processes import (
    PATIENCE,
    graph,
    last_status,
    offline,
    simulated_time,
)
from sensor_msgs.msg import JointState

from dewing_control.node import ControllerNode
from dewing_sim.machine.signals import end, kill
from dewing_sim.records import bag
from dewing_sim.ros import harness, messages, qos


def assert_as_offline(path, steps):
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(steps)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name


class Rogue(Node):
    """Answers every measurement with commands that no simulator should obey."""

    def __init__(self, _parameters=None, **options):
        super().__init__('rogue', namespace='dewing', **options)
        self.out = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(JointState, 'measurement', self.disturb, qos.LATEST)

    def disturb(self, measurement):
        stamp = measurement.header.stamp
        for v_squared in (math.nan, -1.0, 1.0e12):
            self.out.publish(messages.command(v_squared, stamp))
        before = messages.to_stamp(messages.from_stamp(stamp) - 100_000)
        for old in (messages.to_stamp(7), before, before):
            self.out.publish(messages.command(1.0e5, old))


class Doctor(Node):
    """Keeps what the simulator says of itself."""

    def __init__(self, _parameters=None, **options):
        super().__init__('doctor', namespace='dewing', **options)
        self.sentences, self.values = [], {}
        self.create_subscription(DiagnosticArray, '/diagnostics', self.listen, qos.EVENTS)

    def listen(self, message):
        for status in message.status:
            if status.name == '/dewing/simulator':
                self.sentences.append(status.message)
                self.values = {item.key: item.value for item in status.values}


@pytest.fixture
def both(tmp_path):
    """Return processes and a session of this process, in one domain."""
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        yield ros, session


def test_unusable_stale_and_repeated_commands_of_another_node_change_nothing(both):
    ros, session = both
    path = ros.recorder()
    simulator = ros.simulator(duration=0.02, subscribers=3)
    rogue = session.add(Rogue)
    session.spin_until(ros.alive(lambda: rogue.out.get_subscription_count() >= 2), PATIENCE)
    ros.controller()
    session.spin_until(lambda: simulator.poll() is not None, PATIENCE)
    assert simulator.returncode == 0
    end(ros.processes[0], PATIENCE)
    assert_as_offline(path, 200)
    _, values = last_status(path)
    assert int(values['rejected']) > 0 and int(values['stale']) > 0


def test_two_controllers_are_reported_and_every_step_is_made_once(both):
    ros, session = both
    path = ros.recorder()
    simulator = ros.simulator(subscribers=3)
    ros.controller()
    ros.controller()
    doctor = session.add(Doctor)
    session.spin_until(ros.alive(
        lambda: '2 controllers: the first answer to a measurement counts' in doctor.sentences
        and int(doctor.values['stale']) > 0), PATIENCE)
    assert end(simulator, PATIENCE) == 0
    end(ros.processes[0], PATIENCE)
    time = bag.series(path, '/dewing/measurement')['time']
    np.testing.assert_allclose(time, 1.0e-4 * np.arange(len(time)), atol=1.0e-9)
    assert doctor.values['rejected'] == '0'


class Slow(ControllerNode):
    """A controller that answers after random delays, some longer than the simulator waits."""

    delays = random.Random(1)

    def _on_measurement(self, read):
        time.sleep(self.delays.choice((*10 * (0.0,), 0.002, 0.005, 0.12)))
        super()._on_measurement(read)


def test_a_slow_controller_gives_the_same_run_bit_for_bit(both):
    ros, session = both
    path = ros.recorder()
    simulator = ros.simulator(duration=0.01, subscribers=2, resend_period=0.05)
    session.add(Slow)
    session.spin_until(lambda: simulator.poll() is not None, PATIENCE)
    end(ros.processes[0], PATIENCE)
    assert_as_offline(path, 100)


def test_a_late_controller_is_waited_for(both):
    ros, session = both
    path, doctor = ros.recorder(), session.add(Doctor)
    simulator = ros.simulator(duration=0.01, subscribers=2)
    session.spin_until(ros.alive(lambda: any(
        'waiting for a controller' in said for said in doctor.sentences)), PATIENCE)
    ros.controller()
    assert simulator.wait(PATIENCE) == 0
    assert_as_offline(path, 100)


def test_a_killed_simulator_leaves_a_readable_bag_and_a_state_to_go_on_from(tmp_path):
    with graph(tmp_path) as ros:
        path = ros.recorder()
        simulator = ros.simulator(subscribers=2, save_steps=100)
        ros.controller()
        ros.wait_until(lambda: simulated_time(path) > 0.05)
        kill(simulator)
    recorded = bag.series(path, '/dewing/measurement')
    assert_as_offline(path, len(recorded['time']) - 1)
    state = first_mode().load(tmp_path / 'dewing_state.npz')
    # What the recorder had not taken yet died with the simulator, which kept it.
    assert state.step % 100 == 0 and state.step <= len(recorded['time']) + 2 * qos.KEPT
    with graph(tmp_path) as ros:
        settings = {'run.plant': 'reduced', 'model': ros.model, 'run.mode': 'free',
                    'run.subscribers': 0, 'restore': tmp_path / 'dewing_state.npz',
                    'run.duration': 1.0e-4 * (state.step + 10), 'save': tmp_path / 'on.npz'}
        assert ros.start('simulator', settings).wait(PATIENCE) == 0, ros.said('simulator')
    assert first_mode().load(tmp_path / 'on.npz').step == state.step + 10


@pytest.mark.slow
def test_a_recorder_that_does_not_run_holds_the_loop_up_and_loses_nothing(tmp_path):
    """The run has no end of its own, so that the queues fill however fast it is."""
    with graph(tmp_path, patient=True) as ros, harness.Session(ros.domain) as session:
        path, doctor = ros.recorder(), session.add(Doctor)
        simulator = ros.simulator(subscribers=2, hold_timeout=PATIENCE)
        ros.controller()
        ros.wait_until(lambda: simulated_time(path) > 0.001)
        ros.processes[0].send_signal(signal.SIGSTOP)
        # whichever queue fills first, that of the measurements or that of the commands
        session.spin_until(ros.alive(lambda: any(
            'does not keep up' in said or 'no valid command' in said
            for said in doctor.sentences)), PATIENCE)
        held = int(doctor.values['steps'])
        ros.processes[0].send_signal(signal.SIGCONT)
        session.spin_until(ros.alive(lambda: int(doctor.values['steps']) > held + 100), PATIENCE)
        assert end(simulator, PATIENCE) == 0
        assert end(ros.processes[0], PATIENCE) == 0
    _, values = last_status(path)
    assert int(values['steps']) > held + 100
    assert_as_offline(path, int(values['steps']))


@pytest.mark.slow
def test_a_recorder_that_is_given_up_is_said_to_be_gone(tmp_path):
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        path = ros.recorder()
        doctor = session.add(Doctor)
        ros.simulator(subscribers=2, hold_timeout=PATIENCE)
        ros.controller()
        # The controller answers once the recorder listens; not before may that be stopped.
        session.spin_until(ros.alive(lambda: simulated_time(path) > 0.0), PATIENCE)
        ros.processes[0].send_signal(signal.SIGSTOP)
        session.spin_until(ros.alive(lambda: any(
            '1 of 2 listeners of measurement are left' in said for said in doctor.sentences)),
            PATIENCE)
        ros.processes[0].send_signal(signal.SIGCONT)


def limit_files():
    """Let files of this process grow to 32 KiB only, as a disk that is full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (32768, 32768))


def test_a_full_disk_ends_the_recording_and_not_the_run(tmp_path):
    with graph(tmp_path) as ros:
        path = tmp_path / 'run.mcap'
        recorder = ros.start('recorder', {'output': path}, preexec_fn=limit_files)
        simulator = ros.simulator(duration=5.0, subscribers=1, mode='free', delivery_timeout=1.0)
        assert recorder.wait(PATIENCE) == 1
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
    assert 'run.mcap: recording stopped (File too large)' in ros.said('recorder')
    assert path.stat().st_size <= 32768
    assert len(bag.series(path, '/dewing/measurement')['time']) > 1


def test_outputs_that_cannot_be_written_are_named(tmp_path):
    with graph(tmp_path) as ros:
        assert ros.start('recorder', {'output': '/proc/none/run.mcap'}).wait(PATIENCE) != 0
        said = ros.said('recorder').strip()
        assert '/proc/none' in said and said.count('\n') == 0
        settings = {'run.plant': 'reduced', 'model': ros.model, 'save': '/proc/none/state.npz',
                    'run.subscribers': 0, 'run.discovery_timeout': 0.1}
        assert ros.start('simulator', settings).wait(PATIENCE) == 1
        assert 'its state could not be saved: ' in ros.said('simulator')


def test_two_domains_do_not_hear_each_other(tmp_path):
    folders = [tmp_path / 'a', tmp_path / 'b']
    with graph(folders[0]) as one, graph(folders[1]) as other:
        assert one.domain != other.domain
        paths = [ros.recorder() for ros in (one, other)]
        runs = [ros.simulator(duration=0.02, subscribers=2) for ros in (one, other)]
        for ros in (one, other):
            ros.controller()
        assert [run.wait(PATIENCE) for run in runs] == [0, 0]
    for path in paths:
        assert_as_offline(path, 200)


def test_a_run_needs_no_listener(tmp_path):
    with graph(tmp_path) as ros:
        assert ros.simulator(duration=0.01, subscribers=0, mode='free').wait(PATIENCE) == 0

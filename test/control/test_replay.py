# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A recording played to a controller gives the answers of the flight, bit for bit."""

import time

import numpy as np
import pytest
from bag_player import Player
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from ros_processes import PATIENCE, graph
from sensor_msgs.msg import JointState

from dewing_control.node import ControllerNode
from dewing_sim.machine.signals import end
from dewing_sim.records import bag
from dewing_sim.ros import harness, messages, qos

STEPS = 600
PLAYED = ('/dewing/case', '/dewing/measurement')


@pytest.fixture(scope='module')
def flight(tmp_path_factory):
    """Return the bag of a closed loop of `STEPS` steps and its answers by stamp."""
    folder = tmp_path_factory.mktemp('flight')
    with graph(folder) as ros:
        path = ros.recorder()
        simulator = ros.simulator(duration=1.0e-4 * STEPS, subscribers=2)
        ros.controller()
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
        end(ros.processes[0], PATIENCE)
    return path, bag.series(path, '/dewing/command')


class Answers(Node):
    """Keeps the commands by stamp, and what the controller says."""

    def __init__(self, _parameters=None, **options):
        super().__init__('answers', namespace='dewing', **options)
        self.commands, self.sentences = [], []
        self.create_subscription(JointState, 'command', self.commands.append, qos.LOOP)
        self.create_subscription(DiagnosticArray, '/diagnostics', lambda message:
                                 self.sentences.extend(each.message for each in message.status),
                                 qos.EVENTS)

    def series(self):
        """Return stamps and V^2; of repeated answers, to measurements sent again, the first."""
        stamps, first = np.unique([messages.from_stamp(each.header.stamp)
                                   for each in self.commands], return_index=True)
        return stamps, np.array([self.commands[k].effort[0] for k in first])


def assert_as_flown(answers, recorded):
    stamps, v_squared = answers.series()
    assert len(stamps) >= STEPS
    flown = np.rint(recorded['time'] * 1.0e9)
    assert np.array_equal(stamps[:len(flown)], flown[:len(stamps)])
    assert np.array_equal(v_squared[:len(flown)], recorded['v_squared'][:len(stamps)])


@pytest.fixture
def stage(tmp_path):
    """Return processes and a session of this process, in one domain."""
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        yield ros, session


def play(session, path, topics=PLAYED):
    """Play a bag to the end once everybody listens, and return who heard the answers."""
    answers = session.add(Answers)
    player = session.add(lambda _, **options: Player(path, topics, **options))
    session.spin_until(lambda: player.is_heard() and answers.count_publishers('command'),
                       PATIENCE)
    player.play()
    session.spin_until(lambda: len(answers.series()[0]) > STEPS, PATIENCE)
    return answers


def test_a_bag_played_to_a_controller_gives_the_answers_of_the_flight(flight, stage):
    path, recorded = flight
    ros, session = stage
    ros.start('controller')
    assert_as_flown(play(session, path), recorded)


class LateLaw(ControllerNode):
    """A controller whose law takes longer to design than the bag to be played."""

    def _on_case(self, message):
        time.sleep(0.5)
        super()._on_case(message)


def test_what_is_played_while_the_law_is_designed_waits_for_it(flight, stage):
    path, recorded = flight
    _, session = stage
    session.add(LateLaw)
    assert_as_flown(play(session, path), recorded)


def test_what_is_played_before_the_listener_of_answers_comes_waits_for_it(flight, stage):
    path, recorded = flight
    ros, session = stage
    ros.start('controller')
    player = session.add(lambda _, **options: Player(path, PLAYED, **options))
    session.spin_until(player.is_heard, PATIENCE)
    player.play()
    answers = session.add(Answers)
    session.spin_until(lambda: len(answers.series()[0]) > STEPS, PATIENCE)
    assert_as_flown(answers, recorded)


class Plant(Player):
    """A player that listens to commands, as a plant in the loop does."""

    def __init__(self, *given, **options):
        super().__init__(*given, **options)
        self.heard = []
        self.create_subscription(JointState, 'command', self.heard.append, qos.LOOP)


def test_a_plant_in_the_loop_gets_an_answer_to_its_last_measurement_only(flight, stage):
    path, recorded = flight
    _, session = stage
    session.add(LateLaw)
    plant = session.add(lambda _, **options: Plant(path, PLAYED, **options))
    session.spin_until(lambda: plant.is_heard() and plant.count_publishers('command'), PATIENCE)
    plant.play()
    session.spin_until(lambda: plant.heard, PATIENCE)
    stamps = [messages.from_stamp(each.header.stamp) for each in plant.heard]
    assert stamps[-1] == round(1.0e9 * recorded['time'][STEPS - 1]) + 100_000
    assert len(stamps) < STEPS

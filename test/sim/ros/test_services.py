# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the services of a running simulator answer is true when they answer."""

import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from ros_processes import PATIENCE, graph
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from dewing_sim.ros import harness, messages, qos


class Operator(Node):
    """Calls the simulator's services and sees its measurements."""

    def __init__(self, _parameters=None, **options):
        super().__init__('operator', namespace='dewing', **options)
        self.stamps, self.session = [], None
        self.create_subscription(JointState, 'measurement', lambda message: self.stamps.append(
            messages.from_stamp(message.header.stamp)), qos.LOOP)
        self.services_of = {name: self.create_client(kind, f'simulator/{name}') for name, kind in (
            ('pause', SetBool), ('step', Trigger), ('reset', Trigger), ('save', Trigger),
            ('restore', Trigger), ('set_parameters', SetParameters))}

    def ask(self, name, request=None):
        client = self.services_of[name]
        self.session.spin_until(client.service_is_ready, PATIENCE)
        return client.call_async(request or Trigger.Request())

    def call(self, name, request=None):
        future = self.ask(name, request)
        self.session.spin_until(future.done, PATIENCE)
        return future.result()

    def step_by(self, count):
        self.call('set_parameters', SetParameters.Request(
            parameters=[Parameter('run.step_count', value=count).to_parameter_msg()]))

    def paused_at(self):
        answer = self.call('pause', SetBool.Request(data=True))
        assert answer.success and answer.message.startswith('paused at ')
        return stamp_of(answer)


def stamp_of(answer):
    """Return the ns of the time that a sentence names."""
    seconds = answer.message.partition('at ')[2].removeprefix('rest at ').split()[0]
    return round(float(seconds) * 1.0e9)


@pytest.fixture
def flight(tmp_path):
    """Return processes of a run in lock-step without its controller, and one who operates it."""
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        simulator, operator = ros.simulator(subscribers=2), session.add(Operator)
        operator.session = session
        yield ros, session, simulator, operator


def test_steps_are_answered_when_all_are_made(flight):
    ros, session, _, operator = flight
    ros.start('controller')
    session.spin_until(lambda: len(operator.stamps) > 10, PATIENCE)
    paused = operator.paused_at()
    operator.step_by(5)
    for number in (1, 2):       # the second without waiting for the command it begins with
        answer = operator.call('step')
        assert answer.success and stamp_of(answer) == paused + number * 500_000
    session.spin_until(lambda: operator.stamps[-1] == paused + 1_000_000, PATIENCE)


def test_steps_that_will_not_be_made_are_answered_with_the_reason(flight):
    ros, session, simulator, operator = flight
    controller = ros.start('controller')
    session.spin_until(lambda: len(operator.stamps) > 10, PATIENCE)
    assert not operator.call('step').success        # not paused
    operator.paused_at()
    operator.step_by(1_000_000)
    waiting = operator.ask('step')
    session.spin_until(lambda: len(operator.stamps) > 20, PATIENCE)
    assert 'no other call is under way' in operator.call('step').message
    assert operator.call('reset').message == 'at rest at 0.000000000 s'
    session.spin_until(waiting.done, PATIENCE)
    assert not waiting.result().success and 'began anew' in waiting.result().message
    waiting = operator.ask('step')
    operator.call('pause', SetBool.Request(data=False))
    session.spin_until(waiting.done, PATIENCE)
    assert not waiting.result().success and 'let go on' in waiting.result().message
    assert simulator.poll() is None and controller.poll() is None


def test_reset_save_and_restore_say_at_which_time_the_run_stands(flight):
    ros, session, _, operator = flight
    ros.start('controller')
    session.spin_until(lambda: len(operator.stamps) > 10, PATIENCE)
    paused = operator.paused_at()
    saved = operator.call('save')
    assert saved.message.startswith('state saved in dewing_state.npz, at ')
    assert stamp_of(saved) == paused
    assert stamp_of(operator.call('reset')) == 0
    session.spin_until(lambda: operator.stamps[-1] == 0, PATIENCE)
    restored = operator.call('restore')
    assert restored.success and stamp_of(restored) == paused
    session.spin_until(lambda: operator.stamps[-1] == paused, PATIENCE)
    assert operator.call('pause', SetBool.Request(data=False)).message.startswith('running at ')
    session.spin_until(lambda: operator.stamps[-1] > paused, PATIENCE)

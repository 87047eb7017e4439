# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes in one executor: the loop in ten lines, faults injected, services, live parameters."""

import dataclasses
import math
import os
import signal
import time

import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from reduced_wing import CAMBER, first_mode
from ros_processes import PATIENCE, offline
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from dewing_control.node import ControllerNode
from dewing_sim.errors import RunFailed
from dewing_sim.identity import Identity
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.lockstep import Deadlines
from dewing_sim.ros import harness, messages, qos
from dewing_sim.ros.node import SimulatorNode


class Scripted(Node):
    """Keeps the measurements it gets; publishes commands only when told to."""

    def __init__(self, _parameters=None, **options):
        super().__init__('scripted', namespace='dewing', **options)
        self.measurements, self.commands = [], []
        self.out = self.create_publisher(JointState, 'command', 10)
        self.create_subscription(JointState, 'measurement', self.measurements.append, 10)

    def send(self, v_squared, stamp=None, name='v_squared'):
        message = messages.command(v_squared, stamp or self.measurements[-1].header.stamp)
        message.name = [name]
        self.out.publish(message)


class Commanded(Node):
    """Plays the simulator for a controller: publishes the case and single measurements."""

    def __init__(self, _parameters=None, **options):
        super().__init__('commanded', namespace='dewing', **options)
        self.commands = []
        plant = first_mode()
        identity = Identity.of('reduced', plant, plant.rest(), plant.v_squared_max, {})
        self.case = self.create_publisher(String, 'case', qos.LATCHED)
        self.out = self.create_publisher(JointState, 'measurement', 10)
        self.create_subscription(JointState, 'command', self.commands.append, 10)
        self.case.publish(String(data=identity.to_yaml()))

    def send(self, step, camber):
        message = JointState(name=messages.MEASURED,
                             position=[camber * CAMBER, CAMBER, 0.4, 0.0, 0.0])
        message.header.stamp = messages.to_stamp(step * 100_000)
        self.out.publish(message)


@pytest.fixture
def session():
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        yield session


@pytest.fixture
def settings(tmp_path):
    reduced.save(tmp_path / 'model.npz', first_mode(disturbance=0.05))
    return {'run.plant': 'reduced', 'model': str(tmp_path / 'model.npz'),
            'save': str(tmp_path / 'state.npz')}


@pytest.fixture
def scripted(session, settings):
    """Return a session with a simulator that waits for the scripted node's first command."""
    simulator = session.add(SimulatorNode, settings | {'run.resend_period': 1.0e3})
    script = session.add(Scripted)
    session.spin_until(lambda: script.measurements, PATIENCE)
    return session, simulator, script


def test_a_closed_loop_in_ten_lines_is_the_loop_offline(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.duration': 0.02})
    session.add(ControllerNode)
    session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert simulator.exit_status == 0 and simulator.reason.startswith('finished at 0.02 s')
    assert simulator.lockstep.outputs.camber_mean == offline(200)['camber_mean'][-1]


def test_spinning_ends_with_a_sentence_when_the_condition_does_not_come(session):
    with pytest.raises(RunFailed, match=r'did not hold within 0\.3 s'):
        session.spin_until(lambda: False, 0.3)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_is_not_lost_in_a_callback(session, number):
    session.watch_clock().create_timer(0.05, lambda: os.kill(os.getpid(), number))
    handler = signal.getsignal(number)
    with pytest.raises(KeyboardInterrupt):
        session.spin_until(lambda: False, PATIENCE)
    assert signal.getsignal(number) == handler


@pytest.mark.parametrize('v_squared', [math.nan, math.inf, -1.0, 1251.0**2])
def test_unusable_commands_are_counted_reported_and_not_obeyed(scripted, v_squared):
    session, simulator, script = scripted
    script.send(v_squared)
    session.spin_until(lambda: simulator.lockstep.rejected == 1, PATIENCE)
    assert simulator.lockstep.steps == 0
    assert 'is out of range, from 0 to 1.5625e+06 V^2' in simulator.reason
    script.send(1.0e5)
    session.spin_until(lambda: simulator.lockstep.steps == 1, PATIENCE)
    assert simulator.lockstep.v_squared == 1.0e5 and simulator.reason == 'running'


def test_a_caution_about_the_state_is_a_warning_until_a_step_is_made(scripted):
    session, simulator, script = scripted
    simulator.built = dataclasses.replace(
        simulator.built, caution=lambda state: f'beware of step {state.step}')
    session.spin_until(lambda: simulator.reason == 'beware of step 0', PATIENCE)
    assert simulator.status.level == messages.WARN
    script.send(1.0e5)
    session.spin_until(lambda: simulator.lockstep.steps == 1, PATIENCE)
    assert simulator.status.level == messages.OK and simulator.reason == 'running'


def test_stale_and_foreign_commands_are_dropped(scripted):
    session, simulator, script = scripted
    script.send(1.0e5, messages.to_stamp(5))
    session.spin_until(lambda: simulator.lockstep.stale == 1, PATIENCE)
    script.send(1.0e5, name='voltage')
    session.spin_until(lambda: 'named v_squared' in simulator.reason, PATIENCE)
    assert simulator.lockstep.rejected == 1 and simulator.lockstep.steps == 0


def test_a_duplicate_command_steps_once(scripted):
    session, simulator, script = scripted
    first = script.measurements[-1].header.stamp
    script.send(1.0e5, first)
    script.send(2.0e5, first)
    session.spin_until(lambda: simulator.lockstep.stale == 1, PATIENCE)
    assert simulator.lockstep.steps == 1 and simulator.lockstep.v_squared == 1.0e5


def test_an_unanswered_measurement_is_sent_again_unchanged(session, settings):
    session.add(SimulatorNode, settings | {'run.resend_period': 0.1})
    script = session.add(Scripted)
    session.spin_until(lambda: len(script.measurements) == 3, PATIENCE)
    assert script.measurements[0] == script.measurements[1] == script.measurements[2]


def test_no_controller_ends_the_run_after_the_stated_wait(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.discovery_timeout': 0.2})
    session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert simulator.exit_status == 1 and (
        'for a controller and 1 of 1 listeners of measurement' in simulator.reason)


def test_free_mode_needs_no_controller_and_takes_the_last_command(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'free'})
    script = session.add(Scripted)
    session.spin_until(lambda: simulator.lockstep.steps > 10, PATIENCE)
    script.send(3.0e5)
    session.spin_until(lambda: simulator.lockstep.v_squared == 3.0e5, PATIENCE)


def call(session, client, request):
    session.spin_until(client.service_is_ready, PATIENCE)
    future = client.call_async(request)
    session.spin_until(future.done, PATIENCE)
    return future.result()


def test_services_pause_step_reset_and_save(scripted, tmp_path):
    session, simulator, script = scripted
    services = {name: script.create_client(kind, f'simulator/{name}') for name, kind in (
        ('pause', SetBool), ('step', Trigger), ('reset', Trigger), ('save', Trigger))}
    assert call(session, services['pause'], SetBool.Request(data=True)).success
    script.send(1.0e5)
    session.spin_until(lambda: simulator.loop.pending is not None, PATIENCE)
    assert simulator.lockstep.steps == 0
    assert call(session, services['step'], Trigger.Request()).message == 'at 0.000100000 s'
    assert simulator.lockstep.steps == 1
    assert call(session, services['save'], Trigger.Request()).success
    assert simulator.built.load(str(tmp_path / 'state.npz')).step == 1
    assert call(session, services['reset'], Trigger.Request()).success
    assert simulator.lockstep.outputs.time == 0.0
    assert call(session, services['pause'], SetBool.Request(data=False)).success
    session.spin_until(lambda: messages.from_stamp(script.measurements[-1].header.stamp) == 0,
                       PATIENCE)
    script.send(2.0e5)
    session.spin_until(lambda: simulator.lockstep.v_squared == 2.0e5, PATIENCE)


def test_a_call_makes_as_many_steps_as_asked_for_and_goes_back_to_what_was_saved(
        session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'free', 'run.subscribers': 0})
    session.spin_until(lambda: simulator.lockstep.steps > 0, PATIENCE)
    simulator.loop.pause(True)
    client = simulator.create_client(Trigger, 'simulator/step')
    before = simulator.lockstep.steps
    answer, = simulator.set_parameters([Parameter('run.step_count', value=25)])
    assert answer.successful and call(session, client, Trigger.Request()).success
    assert simulator.lockstep.steps == before + 25 and simulator.reason == 'paused'
    answer, = simulator.set_parameters([Parameter('run.step_count', value=0)])
    assert not answer.successful and simulator.run.step_count == 25
    assert simulator.served.save()[0]
    call(session, client, Trigger.Request())
    restore = simulator.create_client(Trigger, 'simulator/restore')
    assert call(session, restore, Trigger.Request()).success
    assert simulator.lockstep.state.step == before + 25


def test_a_failed_restore_says_why_and_changes_nothing(scripted):
    session, simulator, script = scripted
    client = script.create_client(Trigger, 'simulator/restore')
    answer = call(session, client, Trigger.Request())
    assert not answer.success and 'state.npz' in answer.message
    assert simulator.lockstep.outputs.time == 0.0


def test_real_time_is_paced_and_late_steps_and_answers_are_counted(session, settings):
    simulator = session.add(SimulatorNode, settings | {
        'run.mode': 'realtime', 'run.rate': 0.01, 'run.subscribers': 0, 'run.duration': 0.002})
    began = time.monotonic()
    session.spin_until(lambda: simulator.lockstep.steps == 10, PATIENCE)
    assert simulator.loop.deadlines.missed < 10
    time.sleep(0.1)                 # ten periods in which nobody spins
    session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert time.monotonic() - began > 0.2
    assert simulator.loop.deadlines.missed > 0 and simulator.lockstep.unanswered == 20


class Late(Node):
    """Answers every measurement one step later than it should."""

    def __init__(self, _parameters=None, **options):
        super().__init__('late', namespace='dewing', **options)
        self.out, self.before = self.create_publisher(JointState, 'command', 10), None
        self.create_subscription(JointState, 'measurement', self.answer, 10)

    def answer(self, message):
        if self.before is not None:
            self.out.publish(messages.command(4.0e5, self.before))
        self.before = message.header.stamp


def test_late_answers_act_when_they_come_are_counted_and_warned_of(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'realtime', 'run.rate': 0.01})
    session.add(Late)
    session.spin_until(lambda: 'run.rate = 0.01 is not held' in simulator.reason, PATIENCE)
    assert simulator.lockstep.v_squared == 4.0e5 and simulator.lockstep.late > 40
    assert simulator.lockstep.unanswered >= simulator.lockstep.late
    found = simulator.loop.tempo.found
    assert found.lap_ms_p50 > 10.0 and 0.0 < found.largest_rate < 0.01


def test_in_real_time_an_answer_to_what_is_to_come_is_stale(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'realtime', 'run.rate': 0.01})
    script = session.add(Scripted)
    session.spin_until(lambda: script.measurements, PATIENCE)
    script.send(3.0e5, messages.to_stamp(10**9))
    session.spin_until(lambda: simulator.lockstep.stale == 1, PATIENCE)
    assert simulator.lockstep.v_squared == 0.0


def test_a_miss_counts_once_and_is_not_made_up_for():
    deadlines = Deadlines(1.0)
    deadlines.start(0.0)
    for now in (1.0, 2.5, 3.0, 9.0, 10.0, 11.9):
        deadlines.begin(now)
    assert deadlines.missed == 1 and deadlines.due == 12.0


def test_a_saved_state_is_restored_with_its_time_and_command(session, settings, tmp_path):
    plant = first_mode()
    plant.save(tmp_path / 'before.npz', plant.step(plant.rest(), Inputs(4.0e5)))
    session.add(SimulatorNode, settings | {'restore': str(tmp_path / 'before.npz')})
    script = session.add(Scripted)
    session.spin_until(lambda: script.measurements, PATIENCE)
    seen = messages.to_measurement(script.measurements[0])
    assert seen.time == pytest.approx(1.0e-4) and seen.v_squared == 4.0e5


def test_physics_is_described_and_read_only_at_run_time(scripted):
    _, simulator, _ = scripted
    assert 'free-stream speed [m/s]' in simulator.describe_parameter('flow.speed').description
    answer, = simulator.set_parameters([Parameter('flow.speed', value=2.0)])
    assert not answer.successful


def ask(session, controller, plant, step, camber):
    """Send one measurement, return V^2 of the answer."""
    before = len(plant.commands)
    plant.send(step, camber)
    session.spin_until(lambda: len(plant.commands) > before, PATIENCE)
    assert plant.commands[-1].header.stamp == messages.to_stamp(step * 100_000)
    return messages.to_v_squared(plant.commands[-1])


@pytest.fixture
def controlled(session):
    controller, plant = session.add(ControllerNode), session.add(Commanded)
    session.spin_until(lambda: controller.identity is not None
                       and plant.out.get_subscription_count() > 0, PATIENCE)
    return session, controller, plant


def test_the_controller_is_idempotent_and_starts_anew_with_time(controlled):
    session, controller, plant = controlled
    first = [ask(session, controller, plant, step, 0.999) for step in range(5)]
    assert ask(session, controller, plant, 4, 0.999) == first[-1]
    assert first[-1] > first[1] > 0.0
    assert [ask(session, controller, plant, step, 0.999) for step in range(5)] == first


def test_gains_change_live_and_bad_ones_are_refused_with_the_reason(session):
    controller = session.add(ControllerNode, {'pid.kp': 1.0})
    assert controller.settings.pid.kp == 1.0
    answer, = controller.set_parameters([Parameter('pid.kp', value=2.0)])
    assert answer.successful and controller.settings.pid.kp == 2.0
    answer, = controller.set_parameters([Parameter('pid.kp', value=-2.0)])
    assert not answer.successful and controller.settings.pid.kp == 2.0


def test_a_disabled_controller_answers_zero_and_begins_anew_when_enabled(controlled):
    session, controller, plant = controlled
    first = [ask(session, controller, plant, step, 0.99) for step in range(3)]
    client = plant.create_client(SetBool, 'controller/enable')
    assert call(session, client, SetBool.Request(data=False)).success
    assert controller.status.sentence == 'disabled: V^2 is zero'
    assert ask(session, controller, plant, 3, 0.99) == 0.0
    assert call(session, client, SetBool.Request(data=True)).success
    again = [ask(session, controller, plant, step, 0.99) for step in range(4, 7)]
    assert again == first and controller.status.sentence == 'running'


def test_a_controller_under_a_storm_of_parameters_answers_every_measurement(controlled):
    session, controller, plant = controlled
    client = plant.create_client(SetParameters, 'controller/set_parameters')

    def request(value):
        return SetParameters.Request(parameters=[
            Parameter('pid.kp', value=value).to_parameter_msg()])

    session.spin_until(client.service_is_ready, PATIENCE)
    for step in range(20):
        for k in range(50):         # more than the queue of a service holds
            client.call_async(request(float(k % 3) - 1.0))
        ask(session, controller, plant, step, 0.99)
    assert call(session, client, request(7.0)).results[0].successful
    assert controller.settings.pid.kp == 7.0

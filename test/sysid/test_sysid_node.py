# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The identification node in lock-step with a simulator, against the offline identification."""

import dataclasses
import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.task import Future
from ros_processes import PATIENCE
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import Trigger
from synthetic_plant import save_model
from trajectory_msgs.msg import JointTrajectory

from dewing_sim import parameters
from dewing_sim.build import build_reduced
from dewing_sim.errors import BadInput
from dewing_sim.linear.model import Model
from dewing_sim.records import bag_summary
from dewing_sim.ros import awake, harness, qos
from dewing_sim.ros import messages as common
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.recorder import RecorderNode
from dewing_sim.ros.watchdog import Watchdog
from dewing_sysid import messages, sources
from dewing_sysid.experiment import load_records
from dewing_sysid.identify import identify, identify_plant
from dewing_sysid.node import SysidNode
from dewing_sysid.settings import Settings

SHORT = {'experiment.record': 1.2, 'fresh.record': 1.2, 'realisation.window': 1.2,
         'realisation.order': 6}


@pytest.fixture
def model(tmp_path):
    """Return the file of a linear wing that says which case it is."""
    save_model(tmp_path / 'plant.npz')
    return str(tmp_path / 'plant.npz')


@pytest.fixture
def session():
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        yield session


def offline(model):
    built = build_reduced(model)
    return identify_plant(built.plant, built.rest, built.identity,
                          parameters.load('sysid', Settings, SHORT))


def start(session, model, tmp_path, **changes):
    simulator = session.add(SimulatorNode, {'run.plant': 'reduced', 'model': model,
                                            'save': str(tmp_path / 'state.npz')})
    node = session.add(SysidNode, {**SHORT, 'output': str(tmp_path / 'model.npz'),
                                   'records': str(tmp_path / 'records.npz'), **changes})
    return simulator, node


class Listener(Node):
    """Keeps what the identification node publishes."""

    def __init__(self, _parameters=None, **options):
        super().__init__('listener', namespace='dewing', **options)
        self.heard = {}
        for topic, kind in (('model/a', Float64MultiArray), ('model/b', Float64MultiArray),
                            ('model/c', Float64MultiArray), ('pulse', JointTrajectory)):
            self._listen(topic, kind, qos.LATCHED)
        self.progress = []
        self.create_subscription(Float64, 'sysid/progress',
                                 lambda message: self.progress.append(message.data), qos.EVENTS)

    def _listen(self, topic, kind, profile):
        self.create_subscription(
            kind, topic, lambda message: self.heard.__setitem__(topic, message), profile)


def test_matrices_over_ros_are_those_found_offline(session, model, tmp_path):
    expected = offline(model)
    simulator, node = start(session, model, tmp_path)
    early = session.add(Listener)
    session.spin_until(lambda: node.found is not None and len(early.heard) == 4, PATIENCE)
    late = session.add(Listener)
    session.spin_until(lambda: len(late.heard) == 4, PATIENCE)
    saved = Model.load(tmp_path / 'model.npz')
    for name in 'abc':
        matrix = getattr(expected.model, name)
        assert np.array_equal(messages.to_matrix(late.heard[f'model/{name}']), matrix)
        assert np.array_equal(getattr(saved, name), matrix)
    assert saved.fit == expected.model.fit
    assert early.progress[-1] == 1.0 and np.all(np.diff(early.progress) > 0.0)
    session.spin_until(lambda: simulator.lockstep.outputs.time == 0.0, PATIENCE)
    assert simulator.lockstep.rejected == 0
    assert node.reason.startswith('order 6 model: fit of camber_mean')


def test_the_pulse_is_published_as_it_was_recorded(session, model, tmp_path):
    _, node = start(session, model, tmp_path)
    listener = session.add(Listener)
    session.spin_until(lambda: 'pulse' in listener.heard, PATIENCE)
    record, pulse = node.found.records['experiment'], listener.heard['pulse']
    assert pulse.joint_names == ['v_squared', 'camber_mean', 'camber_max', 'cl']
    table = np.array([point.positions for point in pulse.points]).T
    assert np.array_equal(table, np.vstack([record.u, record.y]))
    assert pulse.points[3].time_from_start.nanosec == 300_000


def test_the_records_and_a_bag_of_the_runs_give_the_same_matrices(session, model, tmp_path):
    recorder = session.add(RecorderNode, {'output': str(tmp_path / 'run.mcap')})
    _, node = start(session, model, tmp_path, afterwards='exit')
    session.spin_until(lambda: node.exit_status == 0, PATIENCE)
    recorder.interrupt()
    runs = bag_summary.summary(tmp_path / 'run.mcap')['runs']
    assert len(runs) == 5 and all(run['steps_missing'] == 0 for run in runs)
    settings = parameters.load('sysid', Settings, SHORT)
    for path in (tmp_path / 'records.npz', tmp_path / 'run.mcap'):
        records, identity = sources.load(path)
        assert list(records) == ['experiment', 'half', 'prbs', 'chirp']
        again = identify(records, settings, identity)
        assert np.array_equal(again.model.a, node.found.model.a)
        assert again.model.fit == node.found.model.fit


def test_experiments_wait_for_the_service_and_can_be_stopped(session, model, tmp_path):
    simulator, node = start(session, model, tmp_path, begin='on_request')
    caller = session.add(Listener)
    begin = caller.create_client(Trigger, 'sysid/start')
    stop = caller.create_client(Trigger, 'sysid/stop')

    def call(client):
        session.spin_until(client.service_is_ready, PATIENCE)
        future = client.call_async(Trigger.Request())
        session.spin_until(future.done, PATIENCE)
        return future.result()

    assert not call(stop).success
    assert simulator.lockstep.steps == 0
    while not (answer := call(begin)).success:
        assert answer.message == 'the simulator is not there'
    session.spin_until(lambda: simulator.lockstep.steps > 20, PATIENCE)
    assert 'already' in call(begin).message
    assert 'stopped, the simulator is reset' in call(stop).message
    session.spin_until(lambda: simulator.lockstep.outputs.time == 0.0, PATIENCE)
    assert simulator.lockstep.v_squared == 0.0
    assert node.found is None and node.exit_status is None


def test_an_interrupted_experiment_restores_the_operating_point(session, model, tmp_path):
    simulator, node = start(session, model, tmp_path)
    session.spin_until(lambda: simulator.lockstep.steps > 400, PATIENCE)
    node.interrupt()
    session.spin_until(lambda: simulator.lockstep.outputs.time == 0.0, PATIENCE)
    assert simulator.lockstep.v_squared == 0.0
    assert 'interrupted in run' in node.reason


def test_a_second_controller_keeps_the_experiments_from_beginning(session, model, tmp_path):
    rival = session.add(Listener)
    rival.create_publisher(JointState, 'command', 10)
    session.spin_until(lambda: rival.count_publishers('command') == 1, PATIENCE)
    _, node = start(session, model, tmp_path)
    warnings = []
    rival.create_subscription(
        DiagnosticArray, '/diagnostics', lambda message: warnings.extend(
            status.message for status in message.status if 'sysid' in status.name), qos.EVENTS)
    session.spin_until(lambda: any('another controller' in text for text in warnings), PATIENCE)
    assert node.found is None


def test_a_pulse_the_plant_does_not_admit_ends_with_a_sentence(session, model, tmp_path):
    _, node = start(session, model, tmp_path, **{'experiment.amplitude': 1260.0})
    session.spin_until(lambda: node.exit_status is not None, PATIENCE)
    assert node.exit_status == 1
    assert '1260 V, above the admissible 1250 V' in node.reason


def test_a_silent_simulator_ends_with_a_sentence(session, model, tmp_path):
    simulator, node = start(session, model, tmp_path, patience=0.5)
    session.spin_until(lambda: simulator.lockstep.steps > 20, PATIENCE)
    session.executor.remove_node(simulator)
    session.spin_until(lambda: node.exit_status is not None, PATIENCE)
    assert node.exit_status == 1 and 'nothing heard from the simulator for 0.5 s' in node.reason


def test_a_reset_whose_reply_is_lost_is_asked_for_again(session, model, tmp_path):
    _, node = start(session, model, tmp_path)
    said = []
    node._watchdog = Watchdog(lambda sentence: (
        said.append(sentence), node.status.set(common.WARN, sentence)), 0.3)
    session.spin_until(lambda: node._rest.awaited, PATIENCE)
    node._rest._asked = Future()                    # the reply to the first one comes to nobody
    session.spin_until(lambda: node.found is not None, PATIENCE)
    assert "run 'baseline' at 0%, waiting for the simulator to be reset" in said[0]
    assert node.reason.startswith('order 6 model')


def test_measurements_that_nobody_tells_of_are_answered(session, model, tmp_path):
    """An executor of events hears of a message once; a notice that is lost holds nothing up."""
    simulator, node = start(session, model, tmp_path)
    session.spin_until(lambda: simulator.lockstep.steps > 20, PATIENCE)
    node._subscriptions.remove(node._measurement)           # the executor looks there
    session.executor.wake()
    held = simulator.lockstep.steps
    session.spin_until(lambda: simulator.lockstep.steps > held + 20, PATIENCE)
    assert node.status.level == common.OK


def test_experiments_outlast_a_suspended_machine(session, model, tmp_path, monkeypatch):
    monkeypatch.setattr(awake, 'LONGEST', 0.1)
    simulator, node = start(session, model, tmp_path, patience=0.5)
    session.spin_until(lambda: simulator.lockstep.steps > 20, PATIENCE)
    time.sleep(0.7)
    session.spin_until(lambda: node.found is not None or node.exit_status, PATIENCE)
    assert node.found is not None, node.reason


def test_model_and_records_in_one_file_are_refused(session, model, tmp_path):
    with pytest.raises(BadInput, match='output and records are both .*same.npz'):
        start(session, model, tmp_path, output=str(tmp_path / 'same.npz'),
              records=str(tmp_path / '.' / 'same.npz'))


def test_an_existing_model_is_not_written_over(session, model, tmp_path):
    (tmp_path / 'model.npz').write_text('precious')
    with pytest.raises(BadInput, match='exists'):
        start(session, model, tmp_path)


def test_a_plant_that_does_not_know_its_case_is_refused(session, model, tmp_path):
    dataclasses.replace(Model.load(model), case_yaml='').save(model, overwrite=True)
    _, node = start(session, model, tmp_path)
    session.spin_until(lambda: node.exit_status is not None, PATIENCE)
    assert 'does not say which case it is' in node.reason


def test_a_plant_that_lies_flat_ends_with_a_sentence_before_any_step(session, model, tmp_path):
    whole = Model.load(model)
    dataclasses.replace(whole, operating_outputs=0.0 * whole.operating_outputs).save(
        model, overwrite=True)
    simulator, node = start(session, model, tmp_path)
    session.spin_until(lambda: node.exit_status is not None, PATIENCE)
    assert node.exit_status == 1 and 'the passive camber is 0 m' in node.reason
    assert simulator.lockstep.steps == 0


def test_records_of_the_node_carry_the_identity(session, model, tmp_path):
    _, node = start(session, model, tmp_path)
    session.spin_until(lambda: node.found is not None, PATIENCE)
    assert load_records(tmp_path / 'records.npz')[1].case == parameters.to_mapping(
        parameters.load('paper'))

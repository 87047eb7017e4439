# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant from outside with outputs of its own flows through files, messages, bags and models."""

import dataclasses

import numpy as np
import pytest
from rclpy.node import Node
from ros_processes import PATIENCE
from sensor_msgs.msg import JointState
from sloped_plant import Plant, SlopedOutputs
from std_msgs.msg import Float64

from dewing_control.node import ControllerNode
from dewing_sim import parameters
from dewing_sim.build import build_foreign
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model
from dewing_sim.lockstep import LockStep
from dewing_sim.plant import Measurement, Outputs, measure, rollout
from dewing_sim.quantities import output, schema
from dewing_sim.records import bag
from dewing_sim.records.history import History, record
from dewing_sim.ros import harness, messages, qos
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.recorder import RecorderNode
from dewing_sysid import sources
from dewing_sysid.experiment import load_records, save_records
from dewing_sysid.identify import identify, identify_plant
from dewing_sysid.node import SysidNode
from dewing_sysid.settings import Settings

WORD = 'sloped_plant:Plant'
CASE = parameters.load('paper')
MEASURED = ['camber_mean', 'camber_max', 'v_squared', 'edge_slope']
NAMES = ('camber_mean', 'edge_slope', 'elastic_energy')
SHORT = {'experiment.record': 1.2, 'fresh.record': 1.2, 'realisation.window': 1.2,
         'realisation.order': 2}


def run(steps=7):
    plant = Plant(CASE)
    return [outputs for _, outputs in rollout(plant, plant.rest(), lambda _: Inputs(1.0e5),
                                              steps)]


def test_its_outputs_are_columns_and_shapes_of_a_history_and_of_its_file(tmp_path):
    """The file says units and kinds itself: the class is not needed to read it."""
    outputs = run()
    record(outputs, CASE, every=3).save(tmp_path / 'run.npz')
    history = History.load(tmp_path / 'run.npz')
    assert history.edge_slope.tolist() == [each.edge_slope for each in outputs]
    assert history.elastic_energy.shape == (7,) and history.units['elastic_energy'] == 'J/m'
    assert np.array_equal(history.slope, [outputs[k].slope for k in (0, 3, 6)])
    assert history.since(outputs[2].time).edge_slope.shape == (4,)
    assert 'cl' not in history and 'pressure_jump' not in history


def test_what_is_measured_goes_to_controllers_and_messages_behind_the_others():
    outputs = run(1)[0]
    message = messages.measurement(outputs)
    assert list(message.name) == MEASURED
    measured = messages.to_measurement(message)
    assert measured == Measurement.of(outputs) and measured.edge_slope == outputs.edge_slope
    assert not hasattr(measured, 'elastic_energy')


def test_a_plant_is_measured_by_itself_or_by_what_it_observes():
    plant = Plant(CASE)
    seen = measure(plant, plant.rest())
    assert seen == Measurement.of(plant.observe(plant.rest())) and seen.edge_slope > 0.0
    plant.measure = lambda state: seen._replace(edge_slope=-1.0)
    assert measure(plant, plant.rest()).edge_slope == -1.0


def test_the_lock_step_watches_its_numbers():
    plant = Plant(CASE)
    plant.observe = lambda state: dataclasses.replace(
        Plant.observe(plant, state), edge_slope=np.nan if state.step else 0.0)
    lockstep = LockStep(plant, plant.rest(), 1.0e6)
    with pytest.raises(Diverged, match='edge_slope = nan after step 1'):
        lockstep.advance(0.0)


def test_it_is_identified_with_its_units_and_flown_as_a_reduced_plant(tmp_path):
    built, settings = build_foreign(WORD, CASE), parameters.load('sysid', Settings, SHORT)
    found = identify_plant(built.plant, built.rest, built.identity, settings, NAMES)
    assert found.model.units == ('m', 'rad', 'J/m')
    assert found.model.fit['window']['edge_slope'] > 99.9
    found.model.save(tmp_path / 'model.npz')
    plant = reduced.load(tmp_path / 'model.npz')
    outputs = plant.observe(plant.rest())
    assert outputs.edge_slope == pytest.approx(built.plant.observe(built.rest).edge_slope)
    assert outputs.camber_max is None and outputs.cl is None
    save_records(tmp_path / 'records.npz', found.records, built.identity)
    records, identity = load_records(tmp_path / 'records.npz')
    assert identity == built.identity
    assert identify(records, settings, identity).model.units == found.model.units


def test_what_it_does_not_have_cannot_be_identified():
    built, settings = build_foreign(WORD, CASE), parameters.load('sysid', Settings, SHORT)
    with pytest.raises(BadInput, match="output 'cl' is unknown; known: camber_mean, camber_max"):
        identify_plant(built.plant, built.rest, built.identity, settings)


class Doublet(Node):
    """Answers measurements with one pulse of V^2, and hears what is published beside them."""

    def __init__(self, _parameters=None, **options):
        super().__init__('doublet', namespace='dewing', **options)
        self.slopes = []
        self.command = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(JointState, 'measurement', self.answer, qos.LATEST)
        self.create_subscription(Float64, 'edge_slope',
                                 lambda message: self.slopes.append(message.data), qos.LATEST)

    def answer(self, message):
        v_squared = 1.0e5 if messages.from_stamp(message.header.stamp) == 0 else 0.0
        qos.publish(self.command, messages.command(v_squared, message.header.stamp))


def test_the_simulator_runs_it_and_the_recorder_keeps_it(tmp_path):
    path = tmp_path / 'run.mcap'
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        recorder = session.add(RecorderNode, {'output': str(path)})
        simulator = session.add(SimulatorNode, {
            'run.plant': WORD, 'run.duration': 0.05, 'run.subscribers': 2})
        driver = session.add(Doublet)
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
        session.spin_until(lambda: len(driver.slopes) > 5, PATIENCE)
        recorder.interrupt()
    assert simulator.exit_status == 0
    assert [*bag.series(path, '/dewing/measurement')] == ['time', *MEASURED]
    records, identity = sources.from_bag(path)
    assert records['experiment'].names == ('camber_mean', 'camber_max', 'edge_slope')
    assert identity.units['edge_slope'] == 'rad' and identity.plant == WORD


def test_a_law_steers_it_by_its_camber():
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        simulator = session.add(SimulatorNode, {'run.plant': WORD, 'run.duration': 0.05})
        session.add(ControllerNode, {'reference.target': 1.02})
        session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert simulator.exit_status == 0 and simulator.lockstep.v_squared > 0.0


def test_the_identification_node_takes_its_outputs_by_name(tmp_path):
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        session.add(SimulatorNode, {'run.plant': WORD})
        node = session.add(SysidNode, SHORT | {
            'output': str(tmp_path / 'model.npz'), 'afterwards': 'exit',
            'realisation.outputs': 'camber_mean, edge_slope'})
        session.spin_until(lambda: node.exit_status is not None, PATIENCE)
    assert node.exit_status == 0, node.reason
    assert Model.load(tmp_path / 'model.npz').units == ('m', 'rad')


@pytest.mark.parametrize('word, message', [
    ('sloped_plant:Missing', 'has no Missing'), ('sloped_plant:State', 'cannot be built')])
def test_a_plant_that_cannot_be_made_is_bad_input(word, message):
    with pytest.raises(BadInput, match=message):
        build_foreign(word, CASE)


def test_a_plant_without_files_says_so():
    with pytest.raises(BadInput, match='does not keep its states'):
        build_foreign(WORD, CASE).save('state.npz', None)


def test_an_output_without_unit_and_meaning_is_refused():
    @dataclasses.dataclass(frozen=True, kw_only=True)
    class Bare(Outputs):
        wake: float = 0.0

    with pytest.raises(BadInput, match='Bare.wake is not declared: write .*output'):
        Measurement.of(Bare(time=0.0, v_squared=0.0))


@pytest.mark.parametrize('name, options, message', [
    ('case', {}, 'uses this name'), ('wake', {'kind': np.ndarray, 'measured': True}, 'shape')])
def test_an_output_that_no_file_or_message_can_hold_is_refused(name, options, message):
    bad = dataclasses.make_dataclass(
        'Bad', [(name, object, output('-', 'bad', **options))], bases=(Outputs,), frozen=True,
        kw_only=True)
    with pytest.raises(BadInput, match=message):
        schema(bad)


def test_every_output_says_unit_and_meaning():
    for kind in (Outputs, SlopedOutputs):
        assert all(each.unit and each.meaning for each in schema(kind).quantities)
    assert schema(Outputs).measured == ('camber_mean', 'camber_max', 'cl', 'cd', 'v_squared')

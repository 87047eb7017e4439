# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every control law over DDS is the same law offline, bit for bit, and may change in flight."""

import re
import sys

import numpy as np
import pytest
from outside_law import INTEGRATOR, KIND
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from reduced_wing import first_mode
from ros_processes import PATIENCE, graph, offline

from dewing_control.node import ControllerNode
from dewing_sim.linear import reduced
from dewing_sim.records import bag
from dewing_sim.ros import harness
from dewing_sim.ros.node import SimulatorNode

pytest.importorskip('osqp')


@pytest.mark.parametrize('kind, target', [('periodic', 1.10), ('lqg', 1.10), ('mpc', 0.97)])
def test_loop_over_dds_is_bit_identical_to_the_loop_offline(tmp_path, kind, target):
    with graph(tmp_path) as ros:
        settings = {'kind': kind, 'model': str(ros.model), 'reference.target': target}
        path = ros.recorder()
        simulator = ros.simulator(duration=0.12, subscribers=2)
        ros.controller(settings)
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator') + ros.said('controller')
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(1200, settings)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name
    assert np.ptp(recorded['v_squared']) > 0.0


def test_a_law_that_cannot_be_designed_is_named(tmp_path):
    with graph(tmp_path) as ros:
        simulator = ros.simulator(duration=0.1, subscribers=1, hold_timeout=2.0,
                                  command_timeout=0.5)
        ros.start('controller', {'kind': 'lqg'})
        assert simulator.wait(PATIENCE) == 1
        assert 'model is empty' in ros.said('controller')
        assert 'Traceback' not in ros.said('controller')


def test_a_law_from_outside_flies_over_dds_bit_for_bit(tmp_path, monkeypatch):
    """Its file lies where the controller is started; its parameters come from the command line."""
    (tmp_path / 'my_integrator.py').write_text(INTEGRATOR)
    monkeypatch.syspath_prepend(tmp_path)
    settings = {'kind': KIND, 'my_gain.rate': 30.0}
    with graph(tmp_path) as ros:
        path = ros.recorder()
        simulator = ros.simulator(duration=0.05, subscribers=2)
        ros.controller(settings)
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator') + ros.said('controller')
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(500, settings)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name
    assert recorded['v_squared'][-1] > 0.0
    del sys.modules['my_integrator']


class Flight:
    """A simulator of a linear wing and its controller, flying; parameters are set by service."""

    def __init__(self, session, tmp_path, settings, dt=1.0e-4):
        model = tmp_path / 'model.npz'
        reduced.save(model, first_mode(dt, disturbance=0.05))
        self.session, node = session, session.add(
            lambda _, **options: Node('operator', **options))
        self.client = AsyncParameterClient(node, '/dewing/controller')
        self.simulator = session.add(SimulatorNode, {
            'run.plant': 'reduced', 'model': str(model), 'run.duration': 4000 * dt})
        self.controller = session.add(ControllerNode, {'model': str(model), **settings})
        self.fly(100)

    def fly(self, steps):
        wanted = self.controller._answers + steps
        self.session.spin_until(lambda: self.controller._answers >= wanted, PATIENCE)

    def ask(self, future):
        self.session.spin_until(future.done, PATIENCE)
        return future.result()

    def set(self, **changes):
        changes = [Parameter(name.replace('__', '.'), value=value)
                   for name, value in changes.items()]
        return self.ask(self.client.set_parameters_atomically(changes)).result

    def end(self):
        """Return the camber at the end, in passive ones."""
        self.session.spin_until(lambda: self.simulator.exit_status is not None, PATIENCE)
        assert self.simulator.exit_status == 0 and self.controller.exit_status is None
        return (self.simulator.lockstep.outputs.camber_mean
                / self.simulator.identity.camber_mean)


@pytest.fixture
def session():
    with harness.reserved_domain() as domain, harness.Session(domain) as running:
        yield running


@pytest.mark.parametrize('refused, reason', [
    ({'disturbance_model__frequency': 2000.0}, 'it must stay below 1000 Hz, half the rate'),
    ({'estimator__load_noise': 0.0, 'estimator__drift': 1.0e3, 'estimator__oscillation': 1.0e-12,
      'disturbance_model__harmonics': 20}, 'kind = lqg cannot be designed with these settings'),
    ({'kind': 'fuzzy'}, 'one of pid, periodic, lqg, mpc or package.module:Name'),
    ({'kind': 'no_such.module:Law'}, 'no_such.module cannot be imported'),
    ({'model': 'no_such.npz'}, 'no_such.npz')])
def test_a_change_that_cannot_be_designed_is_refused_and_the_law_flies_on(
        session, tmp_path, refused, reason):
    flight = Flight(session, tmp_path, {'kind': 'lqg'}, dt=5.0e-4)
    before, law = flight.controller.settings, flight.controller._law
    answer = flight.set(**refused)
    assert not answer.successful and re.search(reason, answer.reason)
    assert '\n' not in answer.reason
    assert flight.controller.settings == before and flight.controller._law is law
    assert flight.set(disturbance_model__frequency=20.0).successful
    assert flight.set(disturbance_model__frequency=10.0).successful
    assert flight.end() == pytest.approx(1.10, abs=5.0e-3)
    assert flight.controller._begun == 1


def test_parameters_of_a_law_from_outside_are_declared_described_and_changed_live(
        session, tmp_path, monkeypatch):
    (tmp_path / 'my_integrator.py').write_text(INTEGRATOR)
    monkeypatch.syspath_prepend(tmp_path)
    flight = Flight(session, tmp_path, {'kind': 'pid'})
    assert not flight.controller.has_parameter('my_gain.rate')
    assert flight.set(kind=KIND).successful
    described, = flight.ask(flight.client.describe_parameters(['my_gain.rate'])).descriptors
    assert described.description.startswith('V^2/V_L^2 per second and passive camber [1/s]')
    assert described.floating_point_range[0].to_value == 1.0e6
    assert flight.set(my_gain__rate=20.0).successful
    assert flight.controller.settings.my_gain.rate == 20.0
    flight.fly(100)
    assert flight.set(my_gain__delay=2).successful          # a memory of another form
    flight.fly(100)
    assert not flight.set(my_gain__delay=10).successful
    assert flight.set(kind='pid').successful
    assert not flight.controller.has_parameter('my_gain.rate')
    assert flight.end() == pytest.approx(1.10, abs=5.0e-3)
    del sys.modules['my_integrator']


def test_a_law_that_fails_in_flight_ends_the_controller_with_one_sentence(tmp_path):
    (tmp_path / 'my_integrator.py').write_text(INTEGRATOR.replace(
        'v_squared, errors = memory', 'v_squared, errors = memory\n'
        '        1 / (measurement.time < 0.002)'))
    with graph(tmp_path) as ros:
        ros.simulator(duration=0.1, subscribers=1)
        assert ros.start('controller', {'kind': KIND}).wait(PATIENCE) == 1
        assert 'the control law failed at 0.002 s (ZeroDivisionError' in ros.said('controller')
        assert 'Traceback' not in ros.said('controller')

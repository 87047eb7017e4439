# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Identification and controller at one wing: who stands by holds nothing up, and ends nothing."""

import time

import pytest
from rclpy.node import Node
from ros_processes import PATIENCE
from std_srvs.srv import Trigger
from synthetic_plant import save_model

from dewing_control.node import RELEASED, ControllerNode
from dewing_sim.ros import harness
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.turn import ASKED, SETTLING
from dewing_sysid.node import SysidNode

SHORT = {'experiment.record': 1.2, 'fresh.record': 1.2, 'realisation.window': 1.2,
         'realisation.order': 6, 'output': '', 'begin': 'on_request'}
HASTY = {'run.discovery_timeout': 0.3, 'run.command_timeout': 0.2, 'run.hold_timeout': 2.0}


@pytest.fixture
def stage(tmp_path):
    """Return a session, a hasty simulator of a linear wing, and an idle identification."""
    save_model(tmp_path / 'plant.npz')
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        sysid = session.add(SysidNode, SHORT)
        settings = {'run.plant': 'reduced', 'model': str(tmp_path / 'plant.npz'),
                    'save': str(tmp_path / 'state.npz')}
        yield session, session.add(SimulatorNode, settings | HASTY), sysid


def start(session):
    """Ask for the experiments until they begin, and return the answer."""
    caller = session.add(lambda _, **options: Node('caller', namespace='dewing', **options))
    client = caller.create_client(Trigger, 'sysid/start')
    while True:
        session.spin_until(client.service_is_ready, PATIENCE)
        future = client.call_async(Trigger.Request())
        session.spin_until(future.done, PATIENCE)
        if future.result().success:
            return future.result().message


def let_pass(session, seconds):
    deadline = time.monotonic() + seconds
    session.spin_until(lambda: time.monotonic() > deadline, PATIENCE)


def test_an_idle_identification_neither_starts_nor_ends_a_run(stage):
    session, simulator, sysid = stage
    let_pass(session, 3.0)
    assert simulator.exit_status is None and simulator.lockstep.steps == 0
    assert start(session) == SETTLING
    session.spin_until(lambda: sysid.found is not None, PATIENCE)
    let_pass(session, 3.0)
    assert simulator.exit_status is None
    assert simulator.reason == 'waiting for a controller; a node stands by'
    session.add(ControllerNode)
    session.spin_until(lambda: simulator.lockstep.time > 0.01, PATIENCE)
    assert simulator.reason == 'running'


def test_a_controller_gives_the_wing_up_for_the_experiments_and_takes_it_again(stage):
    session, simulator, sysid = stage
    controller = session.add(ControllerNode)
    session.spin_until(lambda: simulator.lockstep.steps > 20, PATIENCE)
    assert start(session) in (ASKED, SETTLING)
    session.spin_until(lambda: controller.status.sentence == RELEASED, PATIENCE)
    session.spin_until(lambda: sysid.found is not None, PATIENCE)
    before = simulator.lockstep.steps
    session.spin_until(lambda: simulator.lockstep.steps > before + 20, PATIENCE)
    assert controller.status.sentence == 'running' and simulator.exit_status is None
    assert simulator.lockstep.rejected == 0

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Loops that make no progress say so, and go on by themselves where they can."""

import re
import signal
import time

import pytest
from reduced_wing import first_mode
from ros_processes import PATIENCE, graph, simulated_time

from dewing_control.node import ControllerNode
from dewing_sim.linear import reduced
from dewing_sim.ros import awake, harness, messages, watchdog
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.watchdog import Watchdog


@pytest.fixture
def session():
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        yield session


@pytest.fixture
def settings(tmp_path, monkeypatch):
    monkeypatch.setattr(watchdog, 'PATIENCE', 0.3)
    reduced.save(tmp_path / 'model.npz', first_mode(disturbance=0.05))
    return {'run.plant': 'reduced', 'model': str(tmp_path / 'model.npz'),
            'save': str(tmp_path / 'state.npz')}


def test_a_loop_without_progress_is_named_once_with_its_state():
    said = []
    dog = Watchdog(said.append, patience=0.02)
    assert not dog.look(1, 'running') and not dog.look(1, 'running')
    time.sleep(0.03)
    assert not dog.look(2, 'running') and said == []
    time.sleep(0.03)
    assert dog.look(2, 'run 3, waiting for a reply') and dog.look(2, 'run 3, waiting for a reply')
    assert said[0] == said[1] and said[0].startswith('no progress since ')
    assert said[0].endswith(': run 3, waiting for a reply')
    dog.rest()
    assert not dog.look(2, 'running')


def test_paced_steps_whose_timer_is_silent_are_reported_and_go_on(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'free', 'run.subscribers': 0})
    session.spin_until(lambda: simulator.lockstep.steps > 10, PATIENCE)
    simulator.loop.stop()                   # as if the timer were never called again
    held = simulator.lockstep.steps
    session.spin_until(lambda: 'no progress since' in simulator.reason, PATIENCE)
    assert simulator.status.level == messages.WARN
    assert 'mode free, the next step is overdue' in simulator.reason
    session.spin_until(lambda: simulator.lockstep.steps > held + 10, PATIENCE)
    assert simulator.reason == 'running'


def test_a_pause_is_no_stall(session, settings):
    simulator = session.add(SimulatorNode, settings | {'run.mode': 'free', 'run.subscribers': 0})
    session.spin_until(lambda: simulator.lockstep.steps > 10, PATIENCE)
    simulator.loop.pause(True)
    began = time.monotonic()
    session.spin_until(lambda: time.monotonic() > began + 0.6)
    assert simulator.reason == 'paused'
    simulator.loop.pause(False)
    held = simulator.lockstep.steps
    session.spin_until(lambda: simulator.lockstep.steps > held + 10, PATIENCE)
    assert simulator.reason == 'running'


def test_time_in_which_a_process_does_not_run_is_no_time_of_waiting(monkeypatch):
    monkeypatch.setattr(awake, 'LONGEST', 0.05)
    clock = awake.Awake()
    time.sleep(0.3)
    assert 0.0 < clock() <= 0.05
    before = clock()
    for _ in range(5):
        time.sleep(0.01)
        clock()
    assert before + 0.05 <= clock() < 0.4


def test_a_simulator_that_was_suspended_does_not_blame_the_others(session, settings, monkeypatch):
    """All processes stopped for longer than the time-outs, then continued: nobody is late."""
    monkeypatch.setattr(awake, 'LONGEST', 0.1)
    simulator = session.add(SimulatorNode, settings | {
        'run.command_timeout': 0.1, 'run.hold_timeout': 0.5, 'run.duration': 0.01})
    controller = session.add(ControllerNode)
    session.spin_until(lambda: simulator.lockstep.steps > 0, PATIENCE)
    session.executor.remove_node(controller)
    session.spin_until(lambda: simulator.status.level == messages.WARN, PATIENCE)
    time.sleep(1.0)
    session.executor.add_node(controller)
    session.spin_until(lambda: simulator.exit_status is not None, PATIENCE)
    assert simulator.exit_status == 0 and simulator.reason.startswith('finished at 0.01 s')


@pytest.mark.slow
def test_a_listener_that_blocks_a_paced_run_ends_it_in_the_end(tmp_path):
    with graph(tmp_path, patient=True) as ros:
        path = ros.recorder()
        simulator = ros.simulator(mode='free', subscribers=1, command_timeout=0.5,
                                  hold_timeout=1.0, delivery_timeout=0.1)
        ros.wait_until(lambda: simulated_time(path) > 0.001)
        ros.processes[0].send_signal(signal.SIGSTOP)
        assert simulator.wait(PATIENCE) == 1
        said = ros.said('simulator')
    assert 'a listener of measurement does not keep up: simulated time waits for it' in said
    assert re.search(r'a listener of measurement does not keep up for [\d.]+ s of wall time', said)

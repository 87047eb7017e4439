# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulator and controller as processes over DDS: lock-step, faults, ends."""

import dataclasses
import os
import signal
import sys

import numpy as np
import psutil
import pytest
from mcap.reader import make_reader
from reduced_wing import first_mode
from ros_processes import PATIENCE, graph, last_status, offline, simulated_time
from started import started, wait_until

from dewing_sim.linear import reduced
from dewing_sim.machine.signals import kill
from dewing_sim.records import bag
from dewing_sim.ros import harness


def run_closed_loop(folder, steps):
    """Run the loop of three processes to its end and return its bag."""
    with graph(folder) as ros:
        path = ros.recorder()
        simulator = ros.simulator(duration=1.0e-4 * steps, subscribers=2)
        ros.controller()
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
    return path


def assert_identical_to_offline(path, steps):
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(steps)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name
    commands = bag.series(path, '/dewing/command')
    assert np.array_equal(commands['v_squared'][:steps], expected['v_squared'][1:])
    status, values = last_status(path)
    assert int(values['steps']) == steps and status.message.startswith('finished at')
    assert values['rejected'] == '0'
    return values


def test_loop_over_dds_is_bit_identical_to_the_loop_offline(tmp_path):
    assert_identical_to_offline(run_closed_loop(tmp_path, 2000), 2000)


@pytest.mark.slow
def test_ten_thousand_steps_lose_and_mismatch_none(tmp_path):
    values = assert_identical_to_offline(run_closed_loop(tmp_path, 10000), 10000)
    assert int(values['stale']) <= int(values['resent'])      # answers to repeated questions only


def test_a_killed_controller_is_reported_and_the_state_saved(tmp_path):
    with graph(tmp_path) as ros:
        path = ros.recorder()
        simulator = ros.simulator(subscribers=2, command_timeout=0.5, hold_timeout=4.0,
                                  delivery_timeout=5.0)
        controller = ros.start('controller')
        ros.wait_until(lambda: simulated_time(path) > 0.02)
        kill(controller)
        assert simulator.wait(PATIENCE) == 1
    sentences = [status.message for _, _, message in bag.read(path, '/diagnostics')
                 for status in message.status if status.name == '/dewing/simulator']
    assert any('no valid command for' in text and 'are held' in text for text in sentences)
    assert 'state saved in dewing_state.npz' in sentences[-1]
    assert 'stopped; state saved in dewing_state.npz' in ros.said('simulator')
    recorded = bag.series(path, '/dewing/measurement')
    state = first_mode().load(tmp_path / 'dewing_state.npz')
    assert state.step * 1.0e-4 == pytest.approx(recorded['time'][-1])


def test_a_restarted_controller_carries_on_without_a_bump(tmp_path):
    with graph(tmp_path) as ros:
        path = ros.recorder()
        simulator = ros.simulator(subscribers=2, duration=0.3, delivery_timeout=5.0)
        controller = ros.controller()
        ros.wait_until(lambda: simulated_time(path) > 0.06)
        kill(controller)
        ros.controller()
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
    run = bag.series(path, '/dewing/measurement')
    assert len(run['time']) == 3001
    jumps = np.abs(np.diff(run['v_squared'][run['time'] > 0.06]))
    assert np.max(jumps) < 0.012 * 2.0 * 1300.0**2      # kd times the rate of the reference
    assert run['camber_mean'][-1] == pytest.approx(1.10 * 26.0e-6, rel=0.005)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_end_every_process_cleanly(tmp_path, number):
    with graph(tmp_path) as ros:
        path = ros.recorder()
        ros.simulator(subscribers=2)
        ros.controller()
        ros.wait_until(lambda: simulated_time(path) > 0.01)
        for process in reversed(ros.processes):
            process.send_signal(number)
            assert process.wait(PATIENCE) == 0
        assert 'Traceback' not in ros.said('simulator') + ros.said('controller')
    assert last_status(path)[0].message.startswith('interrupted at')


PARENT = """
import sys, time
from pathlib import Path
from dewing_sim.ros import harness
node = harness.start_node('dewing_sim.ros.recorder', {'output': 'run.mcap'},
                          harness.environment(int(sys.argv[1]), '.'))
Path('pid').write_text(str(node.pid))
time.sleep(1000)
"""


def test_a_node_ends_in_order_with_a_parent_that_is_killed(tmp_path):
    environment = os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}
    with harness.reserved_domain() as domain, started(
            [sys.executable, '-c', PARENT, str(domain)], cwd=tmp_path,
            env=environment) as parent:
        bag_file = tmp_path / 'run.mcap'        # its first flush is that of a node that spins
        wait_until(lambda: bag_file.exists() and bag_file.stat().st_size > 0, parent)
        kill(parent)
        node = int((tmp_path / 'pid').read_text())
        wait_until(lambda: not psutil.pid_exists(node))
    with open(tmp_path / 'run.mcap', 'rb') as file:
        assert make_reader(file).get_summary() is not None      # it was closed


@pytest.mark.parametrize('name, settings, sentence', [
    ('simulator', {'flow.sped': 1.0}, 'flow.sped is not a parameter'),
    ('simulator', {'flow.speed': 1}, 'flow.speed = 1 is not a floating-point number'),
    ('simulator', {'run.duration': -1.0}, 'run.duration = -1.0 is out of range'),
    ('simulator', {'case': 'papre'}, "'papre' is not a shipped configuration"),
    ('simulator', {'run.plant': 'reduced', 'model': 'none.npz'}, 'none.npz: no such file'),
    ('simulator', {'actuation.voltage_limit': 2000.0}, 'the membrane loses its tension at 13'),
    ('controller', {'pid.kp': -1.0}, 'pid.kp = -1.0 is out of range'),
    ('recorder', {'output': '.'}, '. is a folder, not a file'),
])
def test_bad_parameters_end_with_status_2_and_one_sentence(tmp_path, name, settings, sentence):
    with graph(tmp_path) as ros:
        assert ros.start(name, settings).wait(PATIENCE) == 2
        said = ros.said(name).strip()
    assert sentence in said and said.count('\n') == 0


def test_a_diverging_run_ends_with_its_last_good_state_and_no_nan(tmp_path):
    with graph(tmp_path) as ros:
        plant = first_mode()
        growing = dataclasses.replace(plant.model, a=1.5 * plant.model.a,
                                      operating_v_squared=1.0e5)
        reduced.save(ros.model, dataclasses.replace(plant, model=growing, rest_v_squared=0.0),
                     overwrite=True)
        path = ros.recorder()
        simulator = ros.simulator(subscribers=1, mode='free')
        assert simulator.wait(PATIENCE) == 1
        assert 'reduced model: the state is not finite' in ros.said('simulator')
    run = bag.series(path, '/dewing/measurement')
    assert all(np.all(np.isfinite(values)) for values in run.values())
    assert first_mode().load(tmp_path / 'dewing_state.npz').step == len(run['time']) - 1

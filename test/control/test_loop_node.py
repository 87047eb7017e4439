# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Several nodes in one process: the same run as in processes of their own, and the same ends."""

import signal

import numpy as np
import pytest
from outside_nodes import V_SQUARED
from ros_processes import PATIENCE, graph, last_status, offline, simulated_time

from dewing_control import loop_node
from dewing_sim.errors import BadInput
from dewing_sim.machine.signals import end
from dewing_sim.records import bag


@pytest.fixture
def ros(tmp_path):
    with graph(tmp_path) as ros:
        yield ros


def start(ros, *nodes, controller=None, **run):
    """Start ``nodes``, or those by default, with a reduced plant."""
    settings = {'simulator:run.plant': 'reduced', 'simulator:model': ros.model}
    settings |= {f'simulator:run.{name}': value for name, value in run.items()}
    settings |= {f'controller:{name}': value for name, value in (controller or {}).items()}
    return ros.start('loop', settings, arguments=['--', *nodes, '--ros-args'])


def test_the_run_is_that_of_two_processes_and_of_the_loop_offline(ros):
    path = ros.recorder()
    loop = start(ros, duration=0.05, subscribers=2, controller={'command.subscribers': 2})
    assert loop.wait(PATIENCE) == 0, ros.said('loop')
    assert end(ros.processes[0], PATIENCE) == 0
    recorded, expected = bag.series(path, '/dewing/measurement'), offline(500)
    for name, values in expected.items():
        assert np.array_equal(recorded[name], values), name
    commands = bag.series(path, '/dewing/command')
    assert np.array_equal(commands['v_squared'][:500], expected['v_squared'][1:])
    _, values = last_status(path, '/dewing/controller')
    assert int(values['answers']) >= 500


def test_a_recorder_in_the_same_process_keeps_the_whole_run(ros):
    settings = {'recorder:output': ros.folder / 'run.mcap', 'simulator:run.plant': 'reduced',
                'simulator:model': ros.model, 'simulator:run.duration': 0.05,
                'simulator:run.subscribers': 2, 'controller:command.subscribers': 2}
    loop = ros.start('loop', settings, arguments=[
        '--', 'simulator', 'controller', 'recorder', '--ros-args'])
    assert loop.wait(PATIENCE) == 0, ros.said('loop')
    recorded = bag.series(ros.folder / 'run.mcap', '/dewing/measurement')
    assert np.array_equal(recorded['cl'], offline(500)['cl'])
    assert last_status(ros.folder / 'run.mcap')[0].message.startswith('finished at')


def test_a_node_of_ones_own_beside_the_simulator(ros):
    path = ros.recorder()
    loop = start(ros, 'simulator', 'outside_nodes:Constant', duration=0.01, subscribers=2)
    assert loop.wait(PATIENCE) == 0, ros.said('loop')
    assert set(bag.series(path, '/dewing/measurement')['v_squared'][1:]) == {V_SQUARED}


def test_a_node_that_fails_is_taken_out_and_the_simulator_ends_as_without_it(ros):
    loop = start(ros, 'simulator', 'outside_nodes:Mortal', command_timeout=0.2, hold_timeout=0.3)
    assert loop.wait(PATIENCE) == 1
    said = ros.said('loop')
    assert 'dewing: that was all\n' in said and 'no valid command for' in said
    assert 'at 0.001000 s: stopped; state saved in dewing_state.npz' in said


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_all_nodes_cleanly(ros, number):
    path = ros.recorder()
    loop = start(ros, subscribers=2)
    ros.wait_until(lambda: simulated_time(path) > 0.0)
    loop.send_signal(number)
    assert loop.wait(PATIENCE) == 0 and 'Traceback' not in ros.said('loop')
    assert end(ros.processes[0], PATIENCE) == 0
    assert last_status(path)[0].message.startswith('interrupted at')
    assert last_status(path, '/dewing/controller')[0].message.endswith('asked to stop')


@pytest.mark.parametrize('word, sentence', [
    ('simulate', "'simulate' is none of simulator, controller, recorder, sysid, nor of the form"),
    ('outside_nodes:V_SQUARED', 'is no class of ROS nodes'),
    ('outside_nodes:Nobody', 'the module outside_nodes has no Nobody')])
def test_a_word_that_names_no_node_is_refused(word, sentence):
    with pytest.raises(BadInput, match=sentence):
        loop_node.node_of(word)


def test_bad_words_and_parameters_end_with_status_2_and_one_sentence(ros):
    assert start(ros, 'simulate').wait(PATIENCE) == 2
    assert start(ros, controller={'pid.kp': -1.0}).wait(PATIENCE) == 2
    said = ros.said('loop').strip().splitlines()
    assert len(said) == 2 and 'pid.kp = -1.0 is out of range' in said[1]

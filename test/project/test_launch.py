# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The launch files: what they give exists, and where ROS's launch is, what they start."""

import ast
import os
import re
import runpy
import shutil
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from reduced_wing import first_mode

from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.linear import reduced
from dewing_sim.settings import SimulatorSettings

PROJECT = Path(__file__).parents[2]
FILES = sorted((PROJECT / 'launch').glob('*.launch.py'))
PAGE = (PROJECT / 'docs' / 'ros.md').read_text()
NODES = {'simulator': SimulatorSettings, 'controller': ControllerSettings, 'recorder': None}


def tree(path):
    return ast.parse(path.read_text())


def arguments(path):
    """Return the default of each argument that a launch file declares by itself."""
    table = next(node.value for node in tree(path).body if isinstance(node, ast.Assign)
                 and node.targets[0].id == 'ARGUMENTS')
    return {name: default for name, default, _ in ast.literal_eval(table)}


# Without ROS's launch.

def test_there_are_files_for_one_wing_for_several_and_for_real_time():
    assert [path.name.partition('.')[0] for path in FILES] == ['dewing', 'realtime', 'wings']


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_every_argument_is_documented_and_passed_on_by_name(path):
    own, one = arguments(path), arguments(PROJECT / 'launch' / 'dewing.launch.py')
    section = PAGE.partition('## Launch\n')[2].partition('\n## ')[0]
    assert section
    for name in own:
        assert f'`{name}`' in section, name
    assert path.name in section
    if path.name != 'dewing.launch.py':
        assert own.keys() - {'count'} <= one.keys()


def test_they_give_parameters_that_exist_to_executables_that_exist():
    given = next(node.value for node in ast.walk(tree(FILES[0])) if isinstance(node, ast.Assign)
                 and getattr(node.targets[0], 'id', '') == 'given')
    assert {key.value for key in given.keys} == NODES.keys()
    for key, names in zip(given.keys, given.values):
        known = {'output'} if NODES[key.value] is None else {
            name for name, _ in parameters.fields(NODES[key.value])}
        assert {name.value for name in names.keys} <= known
    for name in [*NODES, 'loop']:
        assert (PROJECT / 'scripts' / name).is_file()


# With it.

needs_launch = pytest.mark.skipif(not find_spec('launch_ros'), reason='there is no launch_ros')
needs_ros2 = pytest.mark.skipif(not shutil.which('ros2') or not find_spec('rclpy'),
                                reason='there is no ros2 on this machine')


def started(**given):
    """Return the executables that dewing.launch.py starts and what it tells each."""
    from launch import LaunchContext
    file = runpy.run_path(str(PROJECT / 'launch' / 'dewing.launch.py'))
    context = LaunchContext()
    context.launch_configurations.update(arguments(FILES[0]) | given)
    found = [action for action in file['nodes'](context) if hasattr(action, 'node_executable')]
    return {action.node_executable: action for action in found}


def told(action):
    """Return the words of ROS in the command line of a node."""
    return [''.join(getattr(part, 'text', '') for part in word)
            for word in action.cmd][2:]


@needs_launch
@pytest.mark.parametrize('given, expected', [
    ({}, {'simulator', 'controller'}), ({'controller': 'false'}, {'simulator'}),
    ({'bag': 'x.mcap'}, {'simulator', 'controller', 'recorder'}),
    ({'composed': 'true', 'bag': 'x.mcap'}, {'loop', 'recorder'}),
    ({'composed': 'true', 'controller': 'false'}, {'simulator'})])
def test_the_arguments_choose_the_processes(given, expected):
    assert started(**given).keys() == expected


@needs_launch
def test_numbers_become_doubles_and_files_go_to_the_node_they_are_for():
    nodes = started(duration='1', params='all.yaml', gains='mine.yaml', bag='run.mcap')
    words = told(nodes['simulator'])
    assert 'run.duration:=1.000000000' in words and 'run.subscribers:=2' in words
    assert 'mine.yaml' not in words and words[words.index('all.yaml') - 1] == '--params-file'
    assert {'all.yaml', 'mine.yaml', 'command.subscribers:=2'} <= {*told(nodes['controller'])}
    words = told(started(composed='true', mode='free')['loop'])
    assert {"simulator:run.mode:='free'", 'controller:command.subscribers:=1'} <= {*words}
    with pytest.raises(ValueError, match='neither true nor false'):
        started(composed='maybe')


@pytest.fixture
def ros(tmp_path):
    """Return the environment of a sourced workspace with dewing, and a file of parameters."""
    from dewing_sim.ros import harness
    prefix = tmp_path / 'install'
    runpy.run_path(str(PROJECT / 'scripts' / 'environment.py'))['add_to_ament_index'](prefix)
    for path in (prefix / 'lib' / 'dewing').iterdir():
        path.unlink()
        path.write_text(f'#!/bin/sh\nexec {sys.executable} {PROJECT}/scripts/{path.name} "$@"\n')
        path.chmod(0o755)
    reduced.save(tmp_path / 'model.npz', first_mode())
    (tmp_path / 'p.yaml').write_text(
        '/**/simulator:\n  ros__parameters:\n'
        f'    model: {tmp_path}/model.npz\n    run:\n      plant: reduced\n')
    with harness.reserved_domain() as domain:
        env = harness.environment(domain, str(tmp_path))
        yield env | {'AMENT_PREFIX_PATH': f"{prefix}:{env['AMENT_PREFIX_PATH']}",
                     'PYTHONUNBUFFERED': '1'}, tmp_path / 'p.yaml'


def launch(ros, *words, **options):
    env, params = ros
    return subprocess.Popen(
        ['ros2', 'launch', 'dewing', *words, f'params:={params}'], env=env, cwd=params.parent,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        **options)


@needs_ros2
@pytest.mark.parametrize('words', [
    ('dewing.launch.py', 'duration:=0.02', 'bag:=run.mcap'),
    ('dewing.launch.py', 'duration:=0.02', 'bag:=run.mcap', 'composed:=true', 'namespace:=left'),
    ('dewing.launch.py', 'duration:=0.02', 'composed:=true'),
    ('realtime.launch.py', 'duration:=0.02', 'rate:=0.5', 'case:=paper', 'bag:=run.mcap')])
def test_all_processes_end_well_and_a_bag_holds_the_run(ros, words):
    from dewing_sim.records import bag
    process = launch(ros, *words)
    said, _ = process.communicate(timeout=300)
    assert process.returncode == 0 and 'process has died' not in said, said
    assert 'ERROR' not in said and 'finished at 0.02 s' in said, said
    if 'bag:=run.mcap' not in words:
        return
    namespace = 'left' if 'namespace:=left' in words else 'dewing'
    measured = bag.series(ros[1].parent / 'run.mcap', f'/{namespace}/measurement')
    assert len(measured['time']) == 201


@needs_ros2
def test_the_end_of_one_wing_leaves_the_others_alone(ros):
    process, pids, said = launch(ros, 'wings.launch.py', 'count:=2'), {}, ''
    try:
        for line in process.stdout:
            said += line
            found = re.search(r'\[(simulator)-\d+\]: process started with pid \[(\d+)\]', line)
            if found:
                pids[len(pids)] = int(found[2])
            if said.count('simulator]: running') == 2:
                break
        os.kill(pids[0], signal.SIGINT)
        ended = 0
        for line in process.stdout:
            said += line
            ended += 'process has finished cleanly' in line
            if ended == 2:              # simulator and controller of the first
                break
        os.kill(pids[1], 0)             # is there
        assert process.poll() is None and said.count('sending signal') == 1, said
    finally:
        os.killpg(process.pid, signal.SIGINT)
        process.communicate(timeout=120)

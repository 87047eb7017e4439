# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files for several nodes: each takes its own, and refuses only what it mistyped."""

import pytest
import yaml
from ros_processes import PATIENCE, graph

from dewing_sim import parameters
from dewing_sim.parameters import config_file
from dewing_sim.ros import given_parameters
from dewing_sim.settings import SimulatorSettings


def params_file(folder, tree):
    path = folder / 'all.yaml'
    path.write_text(yaml.safe_dump(
        {key: {'ros__parameters': below} for key, below in tree.items()}))
    return ['--params-file', str(path)]


def test_names_for_every_node_are_told_from_those_for_one(tmp_path):
    arguments = params_file(tmp_path, {
        '/**': {'a': {'b': 1, 'c': 2}, 'd': 1}, '/dewing/*': {'e': 1}, '/**/simulator': {'f': 1}})
    assert given_parameters.shared_names(['-p', *arguments]) == {'a.b', 'a.c', 'd', 'e'}
    assert given_parameters.shared_names(['-p', 'a:=1', '--params-file']) == set()


def test_a_file_offline_is_read_as_ros_reads_it(tmp_path):
    _, path = params_file(tmp_path, {
        '/**': {'run': {'rate': 0.5, 'step_count': 7}}, '/dewing/controller': {'kind': 'pid'},
        '/**/simulator': {'run': {'rate': 0.25}}})
    changes = {'case': 'soft'}
    text = parameters.to_yaml(parameters.load('simulator', SimulatorSettings, changes))
    assert parameters.from_yaml(text, SimulatorSettings).case == 'soft'
    above = yaml.safe_load(text) | yaml.safe_load(open(path))
    above = {'/**': yaml.safe_load(text)['/**'], '/*/simulator': above['/**/simulator']}
    merged = parameters.from_yaml(yaml.safe_dump(above, sort_keys=False), SimulatorSettings)
    assert (merged.run.rate, merged.case) == (0.25, 'soft')


@pytest.mark.parametrize('tree, complaint', [
    ({'/**': {'flow': {'sped': 1.0}}}, 'flow.sped is not a parameter'),
    ({'/**/simulator': {'pid': {'kp': 1.0}}}, 'pid.kp is not a parameter'),
    ({'/**': {'run': {'sped': 1.0}}}, 'run.sped is not a parameter; known here: plant, mode'),
])
def test_a_name_of_one_s_own_that_was_mistyped_is_refused(tmp_path, tree, complaint):
    with graph(tmp_path) as ros:
        process = ros.start('simulator', arguments=params_file(tmp_path, tree))
        assert process.wait(PATIENCE) == 2
        assert complaint in ros.said('simulator')


def test_nodes_share_a_file_and_take_no_harm_from_that_of_another(tmp_path):
    shared = {'/**': {'camera': {'gain': 2.0}, 'pid': {'kp': 2.0}, 'run': {'duration': 0.001}}}
    with graph(tmp_path) as ros:
        arguments = params_file(tmp_path, shared)
        controller = ros.start('controller', arguments=[
            *arguments, '--params-file', str(config_file('simulator')),
            '--params-file', str(config_file('paper'))])
        settings = {'run.plant': 'reduced', 'model': ros.model}
        simulator = ros.start('simulator', settings, arguments=[
            *arguments, '--params-file', str(config_file('controller'))])
        assert simulator.wait(PATIENCE) == 0, ros.said('simulator')
        assert controller.poll() is None, ros.said('controller')
    assert 'not parameters of simulator, ignored: camera.gain, pid.kp' in ros.said('simulator')
    assert ('not parameters of controller, ignored: camera.gain, run.duration'
            in ros.said('controller'))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""docs/ros.md, the layouts and the launch file say what the nodes do."""

import json
import re
import runpy
from pathlib import Path

import pytest
import yaml
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from reduced_wing import first_mode
from ros_processes import PATIENCE

from dewing_control.node import ControllerNode
from dewing_sim import parameters
from dewing_sim.linear import reduced
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema
from dewing_sim.ros import harness, messages
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.telemetry import Telemetry

PROJECT = Path(__file__).parents[2]
PAGE = (PROJECT / 'docs' / 'ros.md').read_text()
CONFIG = PROJECT / 'config'
# The transforms are there where ROS has tf2_msgs; the page says so beside its table.
STANDARD = ('/rosout', '/parameter_events', '/tf', '/tf_static')


def table(title):
    """Return the rows of the first table under a heading, cells without back quotes."""
    section = PAGE.partition(f'## {title}\n')[2].partition('\n## ')[0]
    rows = re.findall(r'^\| `(.*) \|$', section, re.M)
    return [[cell.strip().replace('`', '') for cell in row.split('|')] for row in rows]


TOPICS = {row[0]: row for row in table('Topics')}


@pytest.fixture
def nodes(tmp_path):
    """Return the nodes of a run, and one that advertises what only the wing has."""
    reduced.save(tmp_path / 'model.npz', first_mode())
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        simulator = session.add(SimulatorNode, {
            'run.plant': 'reduced', 'model': str(tmp_path / 'model.npz')})
        controller = session.add(ControllerNode)
        wing = session.add(lambda _, **options: Node('wing', namespace='dewing', **options))
        run = parameters.replace(simulator.run, {'plant': 'wing'})
        Telemetry(wing, parameters.load('paper'), run, 1.0e-4, Outputs(**{
            each.name: 0.0 for each in schema(Outputs).quantities}))
        yield session, simulator, controller, wing


def test_every_topic_has_the_type_and_quality_that_is_documented(nodes):
    session, simulator, controller, wing = nodes
    offered = {topic: kinds for node in (simulator, controller, wing)
               for topic, kinds in node.get_publisher_names_and_types_by_node(
                   node.get_name(), '/dewing') if topic not in STANDARD}
    assert {topic: [row[1]] for topic, row in TOPICS.items()} == offered
    for topic, (_, _, _, quality, _) in TOPICS.items():
        for info in simulator.get_publishers_info_by_topic(topic):
            profile = info.qos_profile
            assert profile.reliability is ReliabilityPolicy.RELIABLE
            assert (profile.durability is DurabilityPolicy.TRANSIENT_LOCAL) == (
                quality == 'latched'), topic


def test_every_service_is_documented(nodes):
    session, simulator, controller, _ = nodes
    session.spin_until(lambda: 'controller' in simulator.get_node_names(), PATIENCE)
    offered = {name: kinds[0] for node in (simulator, controller)
               for name, kinds in node.get_service_names_and_types_by_node(
                   node.get_name(), '/dewing') if kinds[0].startswith('std_srvs')}
    assert {row[0]: row[1] for row in table('Services')} == offered


def test_the_diagnostics_are_those_documented(nodes):
    _, simulator, controller, _ = nodes
    text = ' '.join(PAGE.partition('## Diagnostics')[2].split())
    for node in (simulator, controller):
        assert f"`{' '.join(node._values())}`" in text


def test_the_reference_is_what_the_nodes_offer(monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', '')        # set by the script, put back after it
    page = runpy.run_path(str(PROJECT / 'scripts' / 'ros_reference.py'))['page']()
    assert (PROJECT / 'docs' / 'ros-reference.md').read_text() == page, (
        'run: python scripts/ros_reference.py')


def test_rviz_and_foxglove_show_topics_that_exist():
    rviz = yaml.safe_load((CONFIG / 'dewing.rviz').read_text())['Visualization Manager']
    shown = {display['Topic']['Value'] for display in rviz['Displays'] if 'Topic' in display}
    foxglove = json.loads((CONFIG / 'foxglove.json').read_text())
    paths = re.findall(r'"(/(?:\w+/)*\w+)', json.dumps(foxglove))
    assert len(shown) == 3 and len(paths) > 10
    assert shown | set(paths) <= TOPICS.keys()
    panels = set(re.findall(r'"(?:first|second)": "(.*?)"', json.dumps(foxglove['layout'])))
    assert panels == foxglove['configById'].keys()
    for name, index in re.findall(r'measurement\.position\[(\d)\].*?"label": "(\w+)"',
                                  json.dumps(foxglove)):
        assert int(name) < len(messages.MEASURED), index

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Write docs/ros-reference.md from the nodes themselves: ``python scripts/ros_reference.py``.

Every node is started on a coarse wing and asked what it offers. Needs ROS.
"""

import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy

from dewing_control.node import ControllerNode
from dewing_sim import parameters
from dewing_sim.ros import harness
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.ros.recorder import RecorderNode
from dewing_sysid.node import SysidNode

PAGE = Path(__file__).parents[1] / 'docs' / 'ros-reference.md'
# Only to start quickly; the page shows the values of the case `paper`.
QUICK = {'numerics.grid': 'fast', 'numerics.trim_time': 0.1}
# The transforms are there where ROS has tf2_msgs, which the wheels lack.
OF_EVERY_NODE = ('/rosout', '/parameter_events', '/tf', '/tf_static')
TYPES = {1: 'bool', 2: 'integer', 3: 'double', 4: 'string'}
HEAD = """# ROS interface reference

Written by `python scripts/ros_reference.py` from the running nodes;
`test/project/test_ros_docs.py` compares it with them. [ROS](ros.md) explains what the interface
means. Names are those in the default namespace and can be remapped; each node also has the
parameter services of every ROS node.
"""


def page() -> str:
    """Return the text of the page."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ['XDG_CACHE_HOME'] = folder
        with harness.reserved_domain() as domain, harness.Session(domain) as session:
            nodes = [session.add(SimulatorNode, dict(QUICK)), session.add(ControllerNode),
                     session.add(SysidNode), session.add(RecorderNode, {'output': f'{folder}/x'})]
            sections = [line for node in nodes for line in section(node)]
    return '\n'.join([HEAD, *sections]).replace(f'{folder}/x', 'dewing.mcap')


def section(node: Node) -> Iterable[str]:
    """Yield the lines that describe one node."""
    yield f'## {node.get_name()}\n'
    yield from _topics('publishes', node.publishers)
    yield from _topics('subscribes', node.subscriptions)
    yield from _services('offers', node, (each.service_name for each in node.services))
    yield from _services('calls', node, (each.srv_name for each in node.clients))
    yield from _parameters(node)


def _topics(verb: str, endpoints: Iterable) -> Iterable[str]:
    found = sorted((e.topic_name, _type(e.msg_type), _quality(e.qos_profile)) for e in endpoints
                   if e.topic_name not in OF_EVERY_NODE)
    return _table([verb, 'type', 'quality of service'], found)


def _services(verb: str, node: Node, names: Iterable[str]) -> Iterable[str]:
    kinds = {each.service_name: each.srv_type for each in node.services}
    kinds |= {each.srv_name: each.srv_type for each in node.clients}
    found = sorted((node.resolve_service_name(name), _type(kinds[name])) for name in names)
    return _table([verb, 'type'], [pair for pair in found if 'std_srvs' in pair[1]])


def _type(kind: type) -> str:
    package, interface = kind.__module__.split('.')[:2]
    return f'{package}/{interface}/{kind.__name__}'


def _quality(profile) -> str:
    words = ['best effort' if profile.reliability is ReliabilityPolicy.BEST_EFFORT else 'reliable',
             'transient local' if profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
             else 'volatile',
             'keep all' if profile.history is HistoryPolicy.KEEP_ALL
             else f'keep last {profile.depth}']
    return ', '.join(words)


def _parameters(node: Node) -> Iterable[str]:
    shipped = {name: value for name, value, _ in parameters.leaves(parameters.load('paper'))}
    names = [name for name in node._parameters if not name.startswith(
        ('use_sim_time', 'start_type_description', 'qos_overrides'))]
    rows = []
    for name, descriptor in zip(names, node.describe_parameters(names)):
        value = node.get_parameter(name)
        value = shipped[name] if name in QUICK else parameter_value_to_python(
            value.get_parameter_value())
        rows.append((name, TYPES[descriptor.type], str(value), descriptor.description,
                     'start' if descriptor.read_only else 'any time'))
    return _table(['parameter', 'type', 'default', 'descriptor: meaning, unit, range', 'set at'],
                  rows)


def _table(head: list[str], rows: Iterable[tuple[str, ...]]) -> Iterable[str]:
    rows = list(rows)
    if not rows:
        return
    yield '| ' + ' | '.join(head) + ' |'
    yield '|---' * len(head) + '|'
    for first, *rest in rows:
        yield '| ' + ' | '.join([f'`{first}`', *rest]) + ' |'
    yield ''


if __name__ == '__main__':
    PAGE.write_text(page(), encoding='utf-8')
    print(PAGE)

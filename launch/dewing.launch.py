# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Start a simulator, with a controller and a recorder; its end is theirs, and nobody else's.

``ros2 launch dewing dewing.launch.py --show-args`` lists the arguments. What is left empty stays
as the nodes' parameters have it.
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.event_handlers import OnProcessExit
from launch.events import matches_action
from launch.events.process import ShutdownProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = (
    ('namespace', 'dewing', 'namespace of all nodes'),
    ('case', '', 'shipped case or YAML file'),
    ('mode', '', 'lockstep, realtime or free'),
    ('rate', '', 'simulated over wall time in mode realtime'),
    ('duration', '', 'simulated time in s, 0: endless'),
    ('controller', 'true', 'whether a controller is started'),
    ('gains', '', 'parameter file for the controller, as dewing tune writes it'),
    ('params', '', 'parameter file for all nodes'),
    ('bag', '', 'MCAP file to record into; empty: no recorder'),
    ('composed', 'false', 'whether simulator and controller share one process'),
    ('clock', '', 'topic of the clock: of several wings at most one may have /clock'),
)


def generate_launch_description() -> LaunchDescription:
    """Describe the nodes of one wing."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=about)
          for name, default, about in ARGUMENTS),
        OpaqueFunction(function=nodes)])


def nodes(context: LaunchContext) -> list:
    """Return the nodes for the arguments in ``context``."""
    value = {name: LaunchConfiguration(name).perform(context) for name, *_ in ARGUMENTS}
    flies, recorded = is_true(value['controller']), bool(value['bag'])
    given = {
        'simulator': {
            'case': quoted(value['case']), 'run.mode': quoted(value['mode']),
            'run.rate': number(value['rate']), 'run.duration': number(value['duration']),
            'run.clock_topic': quoted(value['clock']), 'run.subscribers': str(flies + recorded)},
        'controller': {'command.subscribers': str(1 + recorded)},
        'recorder': {'output': quoted(value['bag'])}}
    files = {name: [value['params'], value['gains'] if name == 'controller' else '']
             for name in given}
    own = ['simulator', *['controller'] * flies]
    groups = [own] if is_true(value['composed']) else [[name] for name in own]
    simulator, *others = [process(group, value['namespace'], given, files)
                          for group in [*groups, *[['recorder']] * recorded]]
    ends = [EmitEvent(event=ShutdownProcess(process_matcher=matches_action(each)))
            for each in others]
    if not others:                  # launch knows no handler that does nothing
        return [simulator]
    return [*others, simulator,
            RegisterEventHandler(OnProcessExit(target_action=simulator, on_exit=ends))]


def process(group: list[str], namespace: str, given: dict, files: dict) -> Node:
    """Return the process of one node, or of several in the executable ``loop``."""
    words = []
    for file in dict.fromkeys(file for name in group for file in files[name] if file):
        words += ['--params-file', file]
    for name in group:
        prefix = f'{name}:' if len(group) > 1 else ''
        for parameter, text in given[name].items():
            words += ['-p', f'{prefix}{parameter}:={text}'] if text else []
    return Node(package='dewing', executable='loop' if len(group) > 1 else group[0],
                namespace=namespace, output='screen', ros_arguments=words,
                arguments=group if len(group) > 1 else [])


def is_true(text: str) -> bool:
    """Return whether an argument says yes; raise ValueError if it says neither yes nor no."""
    if text.lower() not in ('true', 'false'):
        raise ValueError(f'{text!r} is neither true nor false')
    return text.lower() == 'true'


def quoted(text: str) -> str:
    """Return ``text`` as a word of YAML, nothing if it is empty."""
    return f"'{text}'" if text else ''


def number(text: str) -> str:
    """Return ``text`` as a number that ROS takes for a double, nothing if it is empty."""
    return f'{float(text):.9f}' if text else ''

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulator and controller, or nodes of one's own, in one process: the executable ``loop``.

    loop [NODE ...] [--ros-args ...]

A NODE is simulator, controller, recorder, sysid, or ``package.module:Class``; by default the
first two. They share an executor and find each other over DDS as in processes of their own, which
within a process costs a third of the time. Parameters of one are given under its name:
``-p simulator:run.mode:=realtime``. The end of the first ends them all, with its exit status.
"""

import re
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from dewing_sim.errors import BadInput
from dewing_sim.ros import harness
from dewing_sim.schema import plugins

KNOWN = {'simulator': 'dewing_sim.ros.node:SimulatorNode',
         'controller': 'dewing_control.node:ControllerNode',
         'recorder': 'dewing_sim.ros.recorder:RecorderNode',
         'sysid': 'dewing_sysid.node:SysidNode'}
DEFAULT = ('simulator', 'controller')
NAMED = re.compile(r'([A-Za-z_]\w*):([^:]+):=(.*)', re.DOTALL)


def node_of(word: str) -> Callable[[], Node]:
    """Return the class of nodes that ``word`` names; raise `BadInput` if it is none."""
    if word not in KNOWN and not plugins.is_plugin(word):
        raise BadInput(f'node = {word!r} is none of {", ".join(KNOWN)}, nor of the form '
                       'package.module:Class')
    found = plugins.load(KNOWN.get(word, word), 'node')
    if not (isinstance(found, type) and issubclass(found, Node)):
        raise BadInput(f'node = {word!r} is no class of ROS nodes')
    return found


def with_named(arguments: Sequence[str], folder: str) -> list[str]:
    """Return ``arguments`` with the parameters that are given by node in a file in ``folder``.

    ROS takes ``-p simulator:x:=1`` for a node of that name without a namespace only; in a file
    the namespace may be left open.
    """
    kept, files, words = [], [], iter(arguments)
    for word in words:
        rule = next(words, None) if word in ('-p', '--param') else None
        match = NAMED.fullmatch(rule or '')
        if match:
            node, name, value = match.groups()
            files.append(f'/**/{node}:\n  ros__parameters:\n    {name}: {value}\n')
        else:
            kept += [word] if rule is None else [word, rule]
    for number, text in enumerate(files):
        path = Path(folder, f'{number}.yaml')
        path.write_text(text, encoding='utf-8')
        kept += ['--ros-args', '--params-file', str(path)]
    return kept


def main(args: Sequence[str] | None = None) -> int:
    """Run the nodes until the first ends or a signal comes; return the exit status."""
    arguments = [*sys.argv] if args is None else ['loop', *args]
    with tempfile.TemporaryDirectory(prefix='dewing-') as folder:
        arguments = with_named(arguments, folder)
        words = remove_ros_args(arguments)[1:]
        if {'-h', '--help'} & {*words}:
            print(__doc__.partition('\n\n')[2].strip())
            return 0
        return harness.run(lambda: [node_of(word) for word in words or DEFAULT], arguments)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The documented commands of the real ``ros2``, where it is installed, beside a simulator."""

import re
import shutil
import subprocess

import pytest
from documented_commands import PAGES, blocks
from ros_processes import graph

COMMANDS = [line for page in PAGES for block in blocks(page)
            if block.language == 'sh' and block.where == 'nodes' for line in block.lines]


def test_each_stands_on_the_page_of_what_was_seen():
    """The page that shows their output; a bag is played by a tool that could not be had."""
    seen = next(page for page in PAGES if page.name == 'ros2-commands.md')
    shown = {line for block in blocks(seen) if block.language == 'sh' for line in block.lines}
    documented = {line.partition('  #')[0].strip() for page in PAGES for block in blocks(page)
                  if block.language == 'sh' for line in block.lines
                  if line.startswith(('ros2 topic', 'ros2 launch'))}
    assert documented == shown and len(shown) > 8
    followers = [block.language for block in blocks(seen)]
    assert followers == ['sh', 'text'] * len(shown)


def test_they_name_topics_and_types_of_the_reference():
    """Also where there is no ``ros2`` to try them."""
    reference = next(page for page in PAGES if page.name == 'ros-reference.md').read_text()
    assert len(COMMANDS) > 3
    for line in COMMANDS:
        for topic in re.findall(r'(/dewing(?:/\w+)+|/clock|/tf\w*)', line):
            assert f'| `{topic}` |' in reference, line
        for topic, kind in re.findall(r'(/dewing/\w+) (\w+/msg/\w+)', line):
            assert f'| `{topic}` | {kind} |' in reference, line


@pytest.mark.skipif(not shutil.which('ros2'), reason='there is no ros2 on this machine')
@pytest.mark.parametrize('line', dict.fromkeys(COMMANDS))
def test_the_real_tool_accepts_them(line, tmp_path):
    with graph(tmp_path) as processes:
        processes.simulator(plant='gusty_plant:Plant', mode='free', subscribers=0, rate=1.0)
        processes.controller({'command.subscribers': 1})
        done = subprocess.run(['bash', '-ec', line], env=processes.env, capture_output=True,
                              text=True, timeout=120, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert 'ERROR' not in done.stderr

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of docs/ros.md that need ``ros2`` print what the page shows, where it is there."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from ros_processes import PATIENCE, graph

PAGE = (Path(__file__).parents[3] / 'docs' / 'ros.md').read_text()
SESSION = re.search(r'```console\n(.*?)```', PAGE.partition('## Services')[2], re.S)[1]
SHOWN = re.findall(r'^\$ (ros2 .*)\n((?:(?!\$ ).*\n)+)', SESSION, re.M)


def pattern(text):
    """Return what matches ``text`` with other times in it."""
    return r'\d+\.\d{9}'.join(re.escape(part) for part in re.split(r'\d+\.\d{9}', text.strip()))


def test_the_page_shows_commands_with_their_output():
    assert len(SHOWN) == 4 and all(output.strip() for _, output in SHOWN)


@pytest.mark.skipif(shutil.which('ros2') is None, reason='the command line of ROS is not there')
def test_the_tool_prints_what_the_page_shows(tmp_path):
    with graph(tmp_path) as ros:
        ros.simulator()
        ros.start('controller')
        ros.wait_until(lambda: 'running' in ros.said('simulator'))
        for command, output in SHOWN:
            found = subprocess.run(command, shell=True, env=ros.env, capture_output=True,
                                   text=True, timeout=PATIENCE)
            assert re.search(pattern(output), found.stdout), (command, found)

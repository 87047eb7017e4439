# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Settings every test runs under: no graphics, one thread, ROS within this machine."""

import atexit
import os
import shutil
import sys
import tempfile
from importlib.util import find_spec

import pytest

# A repeatable count of threads, and ROS that neither leaves the machine nor writes to the home.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
os.environ.setdefault('NUMBA_NUM_THREADS', '1')
os.environ.setdefault('MPLBACKEND', 'Agg')
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
if 'ROS_LOG_DIR' not in os.environ:
    os.environ['ROS_LOG_DIR'] = tempfile.mkdtemp(prefix='dewing-ros-log-')
    atexit.register(shutil.rmtree, os.environ['ROS_LOG_DIR'], ignore_errors=True)
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
# The ROS wheels do not set it, and a sourced system ROS does not know this environment.
os.environ['AMENT_PREFIX_PATH'] = os.pathsep.join(
    [sys.prefix, *filter(None, [os.environ.get('AMENT_PREFIX_PATH')])])


# Where there is no ROS, everything offline is still tested.
ROS_TESTS = ['cli/test_demo.py', 'control/test_law_node.py',
             'control/test_laws_over_dds.py', 'project/test_ros2_commands.py',
             'project/test_ros_docs.py',
             'sim/ros/*.py', 'sysid/test_sysid_node.py']
collect_ignore_glob = [] if find_spec('rclpy') else ROS_TESTS


@pytest.fixture
def write(tmp_path):
    """Return a function that writes text to a file of the given name and returns its path."""
    def write(text: str, name: str = 'case.yaml') -> str:
        path = tmp_path / name
        path.write_text(text, encoding='utf-8')
        return str(path)
    return write


@pytest.fixture
def own_folder(tmp_path, monkeypatch):
    """Run in an empty folder with an empty cache."""
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    folder = tmp_path / 'work'
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder

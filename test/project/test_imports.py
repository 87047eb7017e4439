# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a start imports: nothing that costs time and is not used."""

import importlib.util
import subprocess
import sys

import pytest
from slow_imports import SLOW

CONFORMAL = ['--engine', 'conformal', '--grid', 'realtime', '--dt', '5e-4']
COMMANDS = {
    'simulate': ['simulate', *CONFORMAL, '--duration', '1e-3'],
    'finite volumes': ['simulate', '--engine', 'finite_volume', '--grid', 'fast',
                       '--duration', '2e-4'],
    'plate': ['plate', '--alpha', '4', '--grid', 'fast', '--duration', '0.02'],
}
NODES = {'dewing_sim.ros.node': {'numba', 'scipy'}, 'dewing_sim.ros.recorder': {'numba', 'scipy'},
         'dewing_control.node': {'numba'}, 'dewing_sysid.node': {'numba'}}
REPORT = 'print(*(name for name in {names} if name in sys.modules))'


def loaded(code: str, names: set[str]) -> list[str]:
    """Return which of the modules ``names`` there are after ``code``, in a process of its own."""
    made = subprocess.run([sys.executable, '-c', f'import sys\n{code}\n' + REPORT.format(
        names=sorted(names))], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    return made.stdout.splitlines()[-1].split()


@pytest.mark.parametrize('command', COMMANDS)
def test_a_run_imports_nothing_slow(command):
    code = f'from dewing_cli import main\nassert main.main({[*COMMANDS[command]]}) == 0'
    assert loaded(code, {'numba'}) == ['numba']
    assert not loaded(code, SLOW | {'rclpy', 'scipy.fft', 'scipy.special'})


@pytest.mark.skipif(importlib.util.find_spec('rclpy') is None, reason='no ROS here')
@pytest.mark.parametrize('node', NODES)
def test_a_node_is_up_before_anything_slow_is_imported(node):
    assert not loaded(f'import {node}', SLOW | NODES[node])

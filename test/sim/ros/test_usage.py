# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the executables say of themselves."""

import re

import pytest

from dewing_control import node as controller
from dewing_sim import parameters
from dewing_sim.ros import node as simulator
from dewing_sim.ros import recorder, usage
from dewing_sim.ros.simulator_parameters import shipped
from dewing_sysid import node as sysid

NODES = {'simulator': simulator, 'controller': controller, 'sysid': sysid, 'recorder': recorder}


@pytest.mark.parametrize('name', NODES)
def test_help_prints_every_parameter_with_examples_and_starts_nothing(name, capsys):
    assert NODES[name].main(['--help']) == 0
    page = capsys.readouterr().out
    assert page.startswith(f'usage: dewing_{name} ')
    assert all(example in page for example in usage.EXAMPLES[name])
    listed = set(re.findall(r'^  (\S+)  \(', page, re.M))
    for example in usage.EXAMPLES[name]:
        assert set(re.findall(r'-p (\S+?):=', example)) <= listed
    assert 'output' in listed or 'case' in listed or 'pid.kp' in listed


def test_help_lists_units_types_and_ranges(capsys):
    assert simulator.main(['--help']) == 0
    page = capsys.readouterr().out
    assert ('  run.rate  (double, 1.0)\n      simulated over wall time in mode realtime [-], '
            'from 1e-06 to 1000\n') in page
    names = [name for section in shipped() for name, _, _ in parameters.leaves(section)]
    assert re.findall(r'^  (\S+)  \(', page, re.M) == names


def test_a_word_that_is_not_understood_is_named(monkeypatch, capsys):
    monkeypatch.setattr('sys.argv', ['dewing_simulator', '--duration', '3'])
    assert simulator.main() == 2
    said = capsys.readouterr().err
    assert said.startswith('dewing: --duration is not understood') and said.count('\n') == 1

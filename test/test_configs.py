# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every shipped YAML file loads into the schema of its kind."""

from pathlib import Path

import pytest
import yaml

from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.parameters import Case
from dewing_sim.settings import SimulatorSettings
from dewing_sysid.settings import Settings

CONFIG = Path(__file__).parents[1] / 'config'
FILES = sorted(path.stem for path in CONFIG.glob('*.yaml'))
SCHEMAS = {'controller': ControllerSettings, 'simulator': SimulatorSettings, 'sysid': Settings}
CASES = [name for name in FILES if name not in SCHEMAS]


@pytest.mark.parametrize('name', FILES)
def test_a_shipped_file_loads(name):
    parameters.load(name, SCHEMAS.get(name, Case))


def test_the_paper_s_cases_are_shipped():
    assert {'paper', 'paper_alpha8', 'soft'} <= set(CASES)


@pytest.mark.parametrize('name', FILES)
def test_a_shipped_file_is_in_ros_format_and_says_what_it_is(name):
    text = (CONFIG / f'{name}.yaml').read_text()
    assert text.startswith('# ')
    assert list(yaml.safe_load(text)) == ['/**']


@pytest.mark.parametrize('name', CASES)
def test_a_shipped_case_respects_its_voltage_limit(name):
    case = parameters.load(name)
    assert case.actuation.voltage <= case.actuation.voltage_limit

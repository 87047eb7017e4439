# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every shipped YAML file loads into the schema of its kind, and every case is stepped."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import yaml

from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.inputs.base import Inputs
from dewing_sim.parameters import Case
from dewing_sim.plant import SCALARS, rollout
from dewing_sim.settings import SimulatorSettings
from dewing_sysid.settings import Settings

CONFIG = Path(__file__).parents[2] / 'config'
FILES = sorted(path.stem for path in CONFIG.glob('*.yaml'))
CONTROLLERS = [name for name in FILES if name.startswith('controller')]
SCHEMAS = {'simulator': SimulatorSettings, 'sysid': Settings,
           **dict.fromkeys(CONTROLLERS, ControllerSettings)}
CASES = [name for name in FILES if name not in SCHEMAS]


@pytest.mark.parametrize('name', FILES)
def test_a_shipped_file_loads(name):
    parameters.load(name, SCHEMAS.get(name, Case))


def test_a_word_is_enough_for_a_shipped_controller():
    for word in ('late', 'realtime'):
        assert (parameters.load(word, ControllerSettings)
                == parameters.load(f'controller_{word}', ControllerSettings))
    assert parameters.load('realtime') == parameters.load('realtime', Case)     # the case
    path = CONFIG / 'controller_late.yaml'
    assert parameters.load(path, ControllerSettings) == parameters.load('late', ControllerSettings)
    with pytest.raises(BadInput, match="'calm' is not a shipped configuration"):
        parameters.load('calm', ControllerSettings)


@pytest.mark.parametrize('name', ['controller_late', 'controller_realtime'])
def test_controllers_for_late_commands_differ_from_the_paper_s_in_the_law_alone(name):
    ours, paper = (dict(leaf[:2] for leaf in parameters.leaves(
        parameters.load(each, ControllerSettings))) for each in (name, 'controller'))
    changed = {key for key in ours if ours[key] != paper[key]}
    assert changed - {'kind', 'command.delay_steps'} == {
        f'pid.{gain}' for gain in ('kp', 'ki', 'kd', 'derivative_filter', 'tracking_time')}


def test_the_paper_s_cases_are_shipped():
    assert {'paper', 'paper_alpha8', 'soft'} <= set(CASES)


@pytest.mark.parametrize('name, paper', [
    ('realtime', 'paper'), ('realtime_alpha8', 'paper_alpha8')])
def test_a_case_for_real_time_is_the_paper_s_wing_with_other_numerics(name, paper):
    ours, theirs = parameters.load(name), parameters.load(paper)
    assert dataclasses.replace(ours, numerics=theirs.numerics) == theirs
    assert (ours.numerics.engine, ours.numerics.grid) == ('conformal', 'realtime')


@pytest.mark.parametrize('name', ['realtime', 'realtime_alpha8'])
def test_the_time_step_for_real_time_is_one_that_the_grid_bears(name):
    from dewing_sim.fluid.conformal.presets import PRESETS
    from dewing_sim.scales import Scales
    case = parameters.load(name)
    step = case.numerics.time_step / Scales.of(case.flow, case.membrane.chord).time
    assert 0.9 * PRESETS['realtime'].largest_step < step <= PRESETS['realtime'].largest_step


@pytest.mark.parametrize('name', FILES)
def test_a_shipped_file_is_in_ros_format_and_says_what_it_is(name):
    text = (CONFIG / f'{name}.yaml').read_text()
    assert text.startswith('# ')
    node = SCHEMAS.get(name, Case).ros_node
    assert list(yaml.safe_load(text)) == [f'/**/{node}'], 'a file is for one node'


@pytest.mark.parametrize('name', CASES)
def test_a_shipped_case_respects_its_voltage_limit(name):
    case = parameters.load(name)
    assert case.actuation.voltage <= case.actuation.voltage_limit


@pytest.mark.parametrize('name', CASES)
def test_a_shipped_case_steps_on_its_own_grid(name, tmp_path, monkeypatch):
    from dewing_sim.wing import Wing
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    wing = Wing(parameters.load(name, changes={'numerics.trim_time': 0.05}))
    outputs = [outputs for _, outputs in rollout(wing, wing.rest(), lambda _: Inputs(1.0e4), 5)]
    assert [instant.time for instant in outputs] == pytest.approx(wing.dt * np.arange(1, 6))
    for instant in outputs:
        assert np.isfinite([getattr(instant, scalar) for scalar in SCALARS]).all()
        assert instant.v_squared == 1.0e4 and instant.tension > 0.0


def test_the_shipped_controller_answers_the_paper_s_wing():
    from dewing_control.trial.closed_loop import controller
    from dewing_sim.identity import Identity
    from dewing_sim.plant import Measurement
    identity = Identity('wing', 1.0e-4, 2.0e-5, 3.0e-5, 1300.0**2, 1250.0**2, {}, '')
    law = controller(parameters.load('controller', ControllerSettings), identity)
    memory = law.start()
    answers = []
    for k in range(200):
        memory, v_squared = law.step(
            memory, Measurement(k * 1.0e-4, 2.0e-5, 3.0e-5, 0.39, 0.06, 0.0))
        answers.append(v_squared)
    assert answers[0] == 0.0 and 0.0 < answers[-1] <= 1250.0**2

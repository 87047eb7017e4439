# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Trials, their figures, and the comparison on the Navier-Stokes wing."""

import json
import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from identified_wing import identity, reduced_model

from dewing_cli.main import main
from dewing_control.figures.comparison import draw
from dewing_control.settings import ControllerSettings
from dewing_control.trial import comparison, scenarios, trial
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.identity import loss_of_tension
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.disturbance import wall_pressure
from dewing_sim.linear import reduced
from dewing_sim.parameters import Disturbance
from dewing_sim.plant import Outputs
from dewing_sim.wing import Wing

pytest.importorskip('osqp')
COARSE = {'numerics.trim_time': 0.05}


class Shape:
    """A plant whose camber and capacitance are known; it fails at a given step."""

    dt = 1.0e-3

    def __init__(self, failing=math.inf):
        self.failing = failing

    def step(self, state, inputs):
        if state + 1 >= self.failing:
            raise RunFailed('slack')
        return state + 1

    def observe(self, state):
        camber = 2.0e-5 * (1.0 + 0.1 * math.sin(2.0 * math.pi * 10.0 * state * self.dt))
        return Outputs(time=state * self.dt, v_squared=4.0e4 if state else 0.0, cl=0.4, cd=0.06,
                       camber_mean=camber, camber_max=camber, capacitance=2.1e-8)


def test_figures_of_a_known_run():
    run = trial.run(Shape(), 0, None, 400)
    figures = trial.figures(run, 1.05, 1.0e6, 0.2)
    assert figures['camber_mean'] == pytest.approx(1.0, abs=1.0e-9)
    assert figures['camber_amplitude'] == pytest.approx(0.1, rel=1.0e-3)
    assert figures['error_rms'] == pytest.approx(math.hypot(0.05, 0.1 / math.sqrt(2.0)), rel=1e-3)
    assert figures['v_max'] == pytest.approx(200.0) and figures['saturation_share'] == 0.0
    assert figures['power_w'] == pytest.approx(0.0, abs=1.0e-12)


def test_failing_plant_keeps_what_was_computed():
    run = trial.run(Shape(failing=50), 0, None, 400)
    assert run.camber.size == 49 and run.failure == 'slack'
    figures = trial.figures(run, 1.0, 1.0e6, 0.2)
    assert all(math.isfinite(value) for value in figures.values() if not isinstance(value, str))
    with pytest.raises(RunFailed, match='the first step failed: slack'):
        trial.run(Shape(failing=1), 0, None, 10)


def test_a_plant_without_lift_and_membrane_has_no_such_figures():
    """What is absent is left out: no zero and no NaN stands for it."""
    bare = Shape()
    bare.observe = lambda state: Outputs(time=state * bare.dt, v_squared=0.0, camber_mean=2.0e-5)
    figures = trial.figures(trial.run(bare, 0, None, 40, noise=0.01), 1.0, 1.0e6, 0.02)
    assert figures['camber_mean'] == 1.0
    assert not {'cl_mean', 'cd_mean', 'energy_j', 'power_w'} & figures.keys()
    bare.observe = lambda state: Outputs(time=state * bare.dt, v_squared=0.0)
    with pytest.raises(BadInput, match='mean camber: the plant does not have it'):
        trial.run(bare, 0, None, 40)


def test_noise_reaches_the_controller_only_and_repeats():
    seen = []
    watcher = SimpleNamespace(start=lambda v_squared: None,
                              step=lambda memory, measured: (seen.append(measured), 0.0))
    for _ in range(2):
        run = trial.run(Shape(), 0, watcher, 100, noise=0.01)
    cambers = np.array([measured.camber_mean for measured in seen]).reshape(2, 100)
    assert np.array_equal(cambers[0], cambers[1])
    clean = 2.0e-5 * np.concatenate([[1.0], run.camber[:-1]])
    assert np.std(cambers[0] - clean) == pytest.approx(0.01 * 2.0e-5, rel=0.2)


def plan(folder, duration=0.004):
    path = folder / 'model.npz'
    reduced.save(path, reduced_model())
    settings = parameters.load('controller', ControllerSettings, {'model': str(path)})
    return comparison.Plan(parameters.load('paper', changes=COARSE), settings, identity(),
                           duration, 0.5 * duration)


def test_controllers_differ_only_as_named_and_know_the_nominal_wing(tmp_path):
    setup, scenario = plan(tmp_path), scenarios.SCENARIOS['hz20']
    other = identity()
    assert comparison.controller('open_loop', setup, scenario, other) is None
    laws = {name: comparison.controller(name, setup, scenario, other).controller
            for name in comparison.CONTROLLERS[1:]}
    assert laws['pid_paper'].gains.ki == pytest.approx(2.3e15 * other.camber_mean
                                                       / other.v_squared_slack)
    assert laws['pid_tuned'].gains == setup.settings.pid
    assert np.angle(laws['periodic'].rotations[0]) == pytest.approx(2.0 * math.pi * 20.0e-4)


@pytest.mark.parametrize('name', scenarios.SCENARIOS)
def test_every_scenario_changes_a_case_that_is_valid(name):
    scenario = scenarios.SCENARIOS[name]
    case = parameters.load(scenario.case or 'paper', changes=scenario.changes)
    assert case.actuation.voltage == 0.0
    assert case.actuation.voltage_limit**2 < loss_of_tension(case)


def test_second_tone_adds_to_the_first(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    pair = Wing(
        parameters.load('paper', changes={**COARSE, 'disturbance.pressure': 0.01}),
        wall_pressure=partial(wall_pressure, Disturbance(0.01, 10.0)))
    single = Wing(parameters.load('paper', changes={**COARSE, 'disturbance.pressure': 0.02}))
    states = [wing.rest() for wing in (pair, single)]
    for _ in range(5):
        states = [wing.step(state, Inputs(0.0)) for wing, state in zip((pair, single), states)]
    assert np.array_equal(states[0].motion.position, states[1].motion.position)


@pytest.mark.slow
def test_command_writes_table_figure_and_metrics(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    setup = plan(tmp_path)
    out = tmp_path / 'out'
    arguments = ['compare', '--scenarios', 'fig5,step', '--controllers', 'open_loop,lqg,mpc',
                 '--set', 'numerics.trim_time=10.0', '--grid', 'fast', '--duration', '0.03',
                 '--jobs', '1',
                 '--model', setup.settings.model, '--out', str(out)]
    assert main(arguments) == 0
    metrics = json.loads((out / 'metrics.json').read_text())
    wanted = {'camber_mean', 'camber_amplitude', 'v_max', 'v_rms', 'saturation_share',
              'energy_j', 'compute_ms'}
    assert set(metrics) == {'fig5', 'step'}
    assert wanted <= set(metrics['fig5']['mpc'])
    assert metrics['fig5']['open_loop']['v_max'] == 0.0 < metrics['fig5']['lqg']['v_max']
    assert (out / 'compare.png').stat().st_size > 10000
    assert '| lqg |' in (out / 'table.md').read_text() and '**fig5**' in capsys.readouterr().out
    assert main(arguments) == 2


def test_unknown_names_are_bad_input(capsys):
    assert main(['compare', '--scenarios', 'gale']) == 2
    assert main(['compare', '--controllers', 'fuzzy']) == 2
    said = capsys.readouterr().err
    assert '--scenarios gale is not known' in said and '--controllers fuzzy is not known' in said


def test_figure_has_a_row_for_each_scenario():
    run = trial.run(Shape(), 0, None, 50)
    figure = draw({'fig5': {'open_loop': ({}, run)}, 'step': {'open_loop': ({}, run)}})
    assert len(figure.axes) == 4
    drawn = figure.axes[0].lines[0].get_ydata()
    np.testing.assert_allclose(drawn, 100.0 * (run.camber - 1.10))

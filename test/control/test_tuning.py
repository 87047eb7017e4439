# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Tuning within its bounds, the measures it uses, and the command."""

import json
import math

import numpy as np
import pytest
from identified_wing import design_model, identity, reduced_model
from loops import mode, pid

from dewing_cli.main import main
from dewing_control.model.loop import Loop
from dewing_control.settings import ControllerSettings
from dewing_control.tuning import on_wing as verification
from dewing_control.tuning.bounds import Bounds
from dewing_control.tuning.judge import LOAD, _saturation, judge, step_error
from dewing_control.tuning.printed import pi_limit
from dewing_control.tuning.tuning import tune
from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.linear import reduced


def settings(kind='pid', **changes):
    return parameters.load('controller', ControllerSettings, {'kind': kind, **changes})


@pytest.mark.parametrize('kind', ['pid', 'periodic', 'lqg'])
def test_shipped_settings_are_within_the_bounds_they_were_tuned_to(kind):
    model = design_model()
    judged = judge(settings(kind), identity(), model, model.at_tension(Bounds.tension))
    assert judged.stable and judged.peak < 2.1
    assert judged.saturation == 0.0


def test_tuning_improves_within_the_bounds():
    model, bounds = design_model(), Bounds()
    start = settings(**{'pid.kp': 1.0, 'pid.ki': 1.0e3, 'pid.kd': 0.008})
    before = judge(start, identity(), model, model.at_tension(bounds.tension))
    best = tune(start, identity(), model, bounds, generations=6)
    assert best.cost < before.cost
    assert best.stable and best.peak <= 2.0 and best.loop.noise_gain <= bounds.noise_gain
    assert best.settings.pid.tracking_time == pytest.approx(
        best.settings.pid.kp / best.settings.pid.ki)


def test_impossible_bounds_are_said_so():
    with pytest.raises(RunFailed, match='no pid meets Ms <= 1.01'):
        tune(settings(), identity(), design_model(), Bounds(sensitivity=1.01), generations=1)


def test_step_error_is_the_loop_on_the_plant():
    """The linear step response equals that of the controller that is shipped, without bounds."""
    model, compensator = design_model(), pid(2.5, 9.7e3, 0.016, 1.15e-4).compensator()
    x, z, by_hand = np.zeros(model.order), np.zeros(3), []
    for _ in range(200):
        error = 1.0 - model.c @ x
        by_hand.append(error)
        w = compensator.c[0] @ z + compensator.d[0, 0] * error
        x, z = model.a @ x + model.b * w, compensator.a @ z + compensator.b[:, 0] * error
    np.testing.assert_allclose(step_error(model, compensator)[:200], by_hand, atol=1.0e-10)


def test_saturation_share_is_that_of_a_sine():
    """A command 0.05 (r' + 1 + cos) with r' = -1 is negative half the time."""
    share = _saturation(design_model(), 0j, -0.05)
    assert share == pytest.approx(0.5, abs=0.02)
    assert _saturation(design_model(), 0j, 0.10) == 0.0


def test_pi_limit_is_where_the_loop_turns_unstable():
    model = mode(gain=1.3)
    limit = pi_limit(model, 0.5)
    assert limit == pytest.approx(
        2.0 * 0.02 * 2.0 * math.pi * 72.0 * (1.0 + 0.5 * 1.3) / 1.3, rel=1.0e-6)
    for share, stable in ((0.97, True), (1.03, False)):
        loop = Loop.of(model, pid(0.5, share * limit, dt=model.dt).compensator())
        assert loop.stable is stable


def test_linear_loop_predicts_the_amplitude_on_the_model():
    chosen, model = settings(), design_model()
    camber = verification.on_model(chosen, identity(), reduced_model().model, model, 0.3)
    expected = LOAD * abs(judge(chosen, identity(), model, model).sensitivity)
    assert 0.5 * np.ptp(camber[-1000:]) == pytest.approx(expected, rel=0.02)
    found = verification.difference(camber, camber, 1.0e-4)
    assert found['rms'] == 0.0 and found['amplitude_wing'] == found['amplitude_model']


@pytest.mark.slow
def test_command_writes_settings_figures_and_metrics(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    model, out = tmp_path / 'model.npz', tmp_path / 'out'
    reduced.save(model, reduced_model())
    arguments = ['tune', '--kind', 'periodic', '--model', str(model), '--out', str(out),
                 '--set', 'numerics.trim_time=10.0', '--grid', 'fast', '--duration', '0.03']
    assert main(arguments) == 0
    metrics = json.loads((out / 'metrics.json').read_text())
    assert {'gains', 'ms_peak', 'gain_margin_db', 'phase_margin_deg',
            'disturbance_rejection_10hz'} <= set(metrics)
    assert metrics['printed']['as_printed']['stable'] is False
    tuned = parameters.load(str(out / 'controller.yaml'), ControllerSettings)
    assert tuned.periodic.learning_rate == metrics['gains']['periodic.learning_rate']
    for name in ('bode', 'nyquist', 'response'):
        assert (out / f'{name}.png').stat().st_size > 5000
    assert 'wing.camber_amplitude' in capsys.readouterr().out
    assert main(arguments) == 2
    assert main(['tune', '--ms', '0.5', '--out', str(tmp_path / 'new')]) == 2

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The coupled wing: targets of the paper's case, restart bit for bit, refusals."""

import subprocess
import sys

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Slack
from dewing_sim.inputs.base import Inputs
from dewing_sim.lockstep import LockStep
from dewing_sim.plant import SCALARS, Measurement, rollout
from dewing_sim.rest import checkpoint, trim
from dewing_sim.wing import Wing

FAST = {'numerics.grid': 'fast', 'numerics.trim_time': 2.0, 'numerics.time_step': 2.0e-4}


@pytest.fixture(scope='module')
def fast() -> Wing:
    return Wing(parameters.load('paper', changes=FAST))


@pytest.fixture(scope='module')
def fast_rest(fast):
    return trim.march(fast)


@pytest.fixture(scope='module')
def paper() -> Wing:
    return Wing(parameters.load('paper'))


def test_paper_wing_at_rest_meets_its_targets(paper):
    outputs = paper.observe(paper.rest())
    assert paper.measure(paper.rest()) == Measurement.of(outputs)
    assert outputs.time == 0.0
    assert outputs.cl == pytest.approx(0.395, rel=0.015)
    assert outputs.camber_max / paper.reference_deflection == pytest.approx(0.325, rel=0.04)
    assert outputs.camber_max_position == pytest.approx(0.394, abs=0.015)
    assert outputs.tension == pytest.approx(1.2121, rel=1.0e-3)
    assert 25.0e-6 < outputs.camber_max < 29.0e-6


def test_disturbance_moves_the_camber_as_the_paper_says():
    case = parameters.load('paper', changes={'disturbance.pressure': 0.015})
    wing = Wing(case)
    rest = wing.rest()
    passive = wing.observe(rest).camber_mean
    camber = [outputs.camber_mean
              for _, outputs in rollout(wing, rest, lambda _: Inputs(0.0), 2000)]
    relative = np.array(camber[1000:]) / passive - 1.0      # the second period of 10 Hz
    assert relative.mean() == pytest.approx(-0.050, abs=0.005)
    assert 0.5 * np.ptp(relative) == pytest.approx(0.050, abs=0.005)


def test_a_membrane_without_tension_is_named_by_its_prestretch():
    with pytest.raises(BadInput, match='membrane.prestretch = 1 leaves the flat membrane'):
        Wing(parameters.load('paper', changes={'membrane.prestretch': 1.0}))


def test_voltage_lowers_the_tension_and_raises_mean_camber_and_lift(fast, fast_rest):
    def mean(name, v_squared):          # over three periods of the first mode, 72 Hz
        run = rollout(fast, fast_rest, lambda _: Inputs(v_squared), 210)
        return np.mean([getattr(outputs, name) for _, outputs in run])
    assert mean('tension', 500.0**2) < mean('tension', 0.0)
    assert mean('camber_mean', 500.0**2) > 1.1 * mean('camber_mean', 0.0)
    assert mean('cl', 500.0**2) > mean('cl', 0.0)


RESTART = """
import sys
from dewing_sim.inputs.base import Inputs
from dewing_sim.lockstep import LockStep
from dewing_sim.rest import checkpoint
from dewing_sim.wing import Wing
path, out = sys.argv[1:]
wing, state = Wing(checkpoint.load_case(path)), checkpoint.load(path)
for _ in range(20):
    state = wing.step(state, Inputs(90000.0))
checkpoint.save(out, state, wing.case)
"""


def test_twenty_steps_saved_and_continued_elsewhere_equal_forty_bit_for_bit(
        fast, fast_rest, tmp_path):
    states = [state for state, _ in rollout(fast, fast_rest, lambda _: Inputs(90000.0), 40)]
    checkpoint.save(tmp_path / 'half.npz', states[19], fast.case)
    subprocess.run([sys.executable, '-c', RESTART, tmp_path / 'half.npz', tmp_path / 'end.npz'],
                   check=True, cwd=tmp_path.parent)
    continued = checkpoint.load(tmp_path / 'end.npz')
    assert continued.step == states[-1].step == 40
    for part in ('flow', 'motion'):
        ours, theirs = vars(getattr(states[-1], part)), vars(getattr(continued, part))
        for name, value in ours.items():
            assert np.array_equal(value, theirs[name]), (part, name)
    direct, restarted = fast.observe(states[-1]), fast.observe(continued)
    assert all(getattr(direct, name) == getattr(restarted, name) for name in SCALARS)


@pytest.mark.parametrize('v_squared', [-1.0, np.nan, np.inf])
def test_unusable_commands_are_refused(fast, fast_rest, v_squared):
    with pytest.raises(BadInput, match='v_squared'):
        fast.step(fast_rest, Inputs(v_squared))


def test_voltages_beyond_the_loss_of_tension_are_refused():
    limit = {'actuation.voltage_limit': 1400.0}
    for name, changes in (('voltage_limit', limit),
                          ('voltage', {**limit, 'actuation.voltage': 1400.0})):
        with pytest.raises(BadInput, match=f'actuation.{name} = 1400 V.*its tension at 1300 V'):
            Wing(parameters.load('paper', changes=changes))


def test_a_limit_within_the_margin_of_the_loss_of_tension_is_refused():
    with pytest.raises(BadInput, match='actuation.voltage_limit = 1280 V is out of range: at most'
                                       ' 1267 V with actuation.slack_margin = 0.05'):
        Wing(parameters.load('paper', changes={'actuation.voltage_limit': 1280.0}))


def test_a_membrane_gone_slack_stops_with_the_last_good_state(fast_rest):
    unclipped = Wing(parameters.load('paper', changes=FAST | {'actuation.slack_margin': 0.0}))
    with pytest.raises(Slack, match='slack membrane') as caught:
        list(rollout(unclipped, fast_rest, lambda _: Inputs(1500.0**2), 100))
    assert caught.value.state.step < 100


def test_v_squared_is_clipped_before_the_membrane_goes_slack(fast, fast_rest):
    run = [outputs for _, outputs in rollout(
        fast, fast_rest, lambda outputs: Inputs(1500.0**2 * (outputs.clipped < 7)), 10)]
    assert [outputs.clipped for outputs in run] == [1, 2, 3, 4, 5, 6, 7, 7, 7, 7]
    held = np.array([outputs.v_squared for outputs in run])
    assert held[:7] == pytest.approx(0.95 * fast.v_squared_slack, rel=1.0e-3)
    assert np.all(held[7:] == 0.0) and min(outputs.tension for outputs in run) > 0.0


def test_clipped_steps_are_counted_for_the_diagnostics(fast, fast_rest):
    lockstep = LockStep(fast, fast_rest, 1500.0**2)
    for _ in range(3):
        lockstep.advance(1500.0**2)
    lockstep.advance(0.0)
    assert lockstep.figures(1.0)['clipped'] == 3


def test_the_full_limit_in_a_strong_disturbance_does_not_slacken_the_membrane():
    def limit_on_and_off(margin: float):
        wing = Wing(parameters.load('realtime', changes={
            'numerics.time_step': 1.0e-4, 'numerics.trim_time': 5.0,
            'disturbance.pressure': 0.5, 'disturbance.frequency': 40.0,
            'actuation.slack_margin': margin}))
        limit, state = wing.case.actuation.voltage_limit**2, wing.rest()
        for step in range(520):
            before = state
            state = wing.step(state, Inputs(limit * (step // 35 % 2 == 0)))
            yield before, state
    with pytest.raises(Slack, match='at 1250 V and loses it at 124'):
        assert not any(after.clipped for _, after in limit_on_and_off(0.0))
    clips = [after.v_squared for before, after in limit_on_and_off(0.05)
             if after.clipped > before.clipped]
    assert len(clips) > 10 and max(clips) < 1250.0**2


def test_a_file_that_is_no_state_is_refused(tmp_path):
    path = tmp_path / 'junk.npz'
    with pytest.raises(BadInput, match='no such file'):
        checkpoint.load(path)
    np.savez(path, a=1)
    with pytest.raises(BadInput, match='not a saved wing state'):
        checkpoint.load(path)

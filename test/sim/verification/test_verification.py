# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The quick verification, its record, and the numbers that it draws from signals."""

import json
from pathlib import Path

import numpy as np
import pytest

from dewing_cli.main import main
from dewing_sim.fluid.engines import NAMES
from dewing_sim.machine.jobs import Workers
from dewing_sim.verification import report, suite
from dewing_sim.verification.closed_forms import (
    frequencies_in_air,
    plate_drag,
    sail_deflection,
    sail_divergence,
    strip_added_mass,
)
from dewing_sim.verification.fluid.rigid_flow import PlateRun
from dewing_sim.verification.signals import block_mean, harmonics, limit, richardson, ringing
from dewing_sim.verification.study import Check, Study

PAGE = Path(__file__).parents[3] / 'docs' / report.PAGE


@pytest.fixture(scope='module')
def quick() -> suite.Verification:
    return suite.verify(list(NAMES), quick=True)


@pytest.mark.slow
def test_quick_gates_are_met_but_for_the_misses_that_the_page_lists(quick):
    listed = report.known_misses(PAGE.read_text(encoding='utf-8'))
    judged = {(check.name, check.engine) for check in quick.all_checks if check.gate is not None}
    assert len(judged) > 25
    assert {(check.name, check.engine) for check in quick.missed} == listed & judged


@pytest.mark.slow
def test_every_engine_is_verified(quick):
    for engine in NAMES:
        assert len([check for check in quick.all_checks if check.engine == engine]) > 20


def offset(value: float) -> Study:
    """Return a study whose only value lies 1 % gated ``value`` from its reference 2."""
    return Study('offset', 'Offset', 'Text.', lambda engine, quick: {},
                 lambda engine, results: [Check('two', engine, 2.0 + value, 2.0, 'sum', 0.01)])


@pytest.mark.parametrize('value, status', [(0.01, 0), (0.03, 1)])
def test_command_records_gates_and_fails_when_one_is_missed(
        value, status, tmp_path, monkeypatch, capsys):
    check = Check('two', 'finite_volume', 2.0 + value, 2.0, 'sum', 0.01)
    made = suite.Verification((offset(value),), {'offset': [check]}, {'offset': {}}, True, 1.0)
    monkeypatch.setattr(suite, 'verify', lambda *_: made)
    arguments = ['verify', '--quick', '--json', str(tmp_path / 'v.json'), '--out', str(tmp_path)]
    assert main(arguments) == status
    record, = json.loads((tmp_path / 'v.json').read_text())['cases']
    assert record['passed'] is not bool(status)
    assert record['difference'] == pytest.approx(0.5 * value)
    assert {'name', 'engine', 'value', 'reference', 'source', 'gate'} <= record.keys()
    page = (tmp_path / report.PAGE).read_text()
    assert report.known_misses(page) == ({('two', 'finite_volume')} if status else set())
    assert ('MISSED' in capsys.readouterr().out) is bool(status)
    assert main(arguments) == 2         # nothing is written over


@pytest.mark.parametrize('option', [['--engine', 'spectral'], ['--jobs', '0']])
def test_unusable_options_are_refused(option, capsys):
    assert main(['verify', *option]) == 2
    assert option[0] in capsys.readouterr().err


def test_a_run_that_fails_is_a_missed_gate(monkeypatch):
    coarse = PlateRun('finite_volume', 'fast', 12.0, 10.0, dt=0.1)
    study = Study('broken', 'Broken', 'Text.', lambda engine, quick: {'too coarse': coarse},
                  lambda engine, results: [])
    monkeypatch.setattr(suite, 'STUDIES', (study,))
    verification = suite.verify(['finite_volume'], workers=Workers(1))
    missed, = verification.missed
    assert missed.name == 'Broken: failed runs'
    assert missed.source.startswith('too coarse: the flow')


def test_a_second_engine_is_compared_with_the_first():
    ours = [Check('Cl', 'a', 1.0, None, 's'), Check('Cl', 'b', 1.1, None, 's'),
            Check('Cd', 'b', 0.1, None, 's')]
    pair, = suite.between_engines(ours)
    assert (pair.name, pair.engine) == ('Cl', 'b - a')
    assert pair.difference == pytest.approx(0.1)


def test_closed_forms_meet_published_values():
    assert plate_drag(2500.0) == pytest.approx(0.0588, abs=5.0e-5)
    assert 2.0 * np.diag(strip_added_mass(3)) == pytest.approx([0.8546, 0.3592, 0.2356], abs=1e-4)
    assert sail_divergence() == pytest.approx(1.727453, rel=1.0e-4)
    stiff = 1.0e5
    deflection, place = sail_deflection(stiff)
    assert 8.0 * stiff * deflection == pytest.approx(4.739, rel=1.0e-3)
    assert place == pytest.approx(0.4028, abs=2.0e-3)
    in_vacuo = frequencies_in_air(1.0, 1.0e6, 3)
    assert in_vacuo == pytest.approx(0.5e-3 * np.arange(1, 4), rel=1.0e-5)


def test_harmonics_of_a_known_signal():
    time = 0.01 * np.arange(3000)
    signal = 1.0 + np.sin(2.0 * np.pi * 0.683 * time) + 0.3 * np.cos(4.0 * np.pi * 0.683 * time)
    found = harmonics(signal, 0.01)
    assert found.frequency == pytest.approx(0.683, abs=1.0e-5)
    assert found.amplitude[:3] == pytest.approx([1.0, 0.3, 0.0], abs=1.0e-3)


def test_ringing_of_three_damped_modes():
    time = 1.0e-4 * np.arange(600)
    exact = np.array([-5.0 + 450.0j, -9.0 + 1080.0j, -12.0 + 1700.0j])
    modes = np.exp(np.outer(time, exact)).real @ np.array(
        [[1.0, 0.1, 0.2], [0.1, 1.0, 0.1], [0.3, 0.1, 1.0]])
    assert ringing(modes[::2], 2.0e-4) == pytest.approx(exact, rel=1.0e-6)


def test_error_bar_of_a_mean_covers_independent_noise():
    noise = np.random.default_rng(3).normal(5.0, 1.0, 8000)
    mean = block_mean(noise)
    assert mean.error == pytest.approx(1.0 / np.sqrt(8000), rel=0.6)
    assert abs(mean.value - 5.0) < 4.0 * mean.error


def test_extrapolations_are_exact_on_their_models():
    size = np.array([2.0, 1.0, 0.5])
    found = richardson(*(3.0 + 0.1 * size**1.5), 2.0)
    assert found.value == pytest.approx(3.0)
    assert found.order == pytest.approx(1.5)
    assert richardson(1.0, 1.1, 1.3, 2.0) == (1.3, 0.0)
    assert limit(size, 4.0 - size + 0.3 * size**2) == pytest.approx(4.0)

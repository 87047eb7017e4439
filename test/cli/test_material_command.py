# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command that shows the material."""

import json

import pytest

from dewing_cli import main as cli

COARSE = ('material', '--set', 'membrane.elements=32', '--quiet')


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_the_paper_s_material_in_numbers_and_figures(tmp_path):
    assert cli.main([*COARSE, '--json', 'm.json', '--out', 'figures']) == 0
    found = json.loads((tmp_path / 'm.json').read_text())
    assert found['tension'] == pytest.approx(1.2121, abs=1e-4)
    assert found['slack_voltage'] == pytest.approx(1300.0, abs=0.5)
    assert found['pull_in_stretch'] == pytest.approx(1.26380, abs=1e-5)
    assert found['largest_difference_solid'] < 4e-2
    assert found['largest_difference_solid_middle'] < 5e-4
    names = sorted(path.name for path in (tmp_path / 'figures').iterdir())
    assert names == ['camber.png', 'free_sheet.png', 'stress.png', 'tension.png']


def test_existing_figures_are_kept(tmp_path):
    (tmp_path / 'camber.png').touch()
    assert cli.main([*COARSE, '--out', '.']) == 2


def test_a_stiff_gent_limit_has_no_pull_in(capsys, tmp_path):
    assert cli.main(['material', '--set', 'membrane.elements=16', '--set',
                     'membrane.gent_limit=5.0', '--json', 'm.json']) == 0
    assert 'pull_in' not in capsys.readouterr().out


@pytest.mark.parametrize('lift', ['-1', 'nan'])
def test_an_impossible_lift_is_refused(lift):
    assert cli.main([*COARSE, f'--lift={lift}']) == 2


def test_both_elements_are_compared_in_the_coupled_wing(capsys, tmp_path):
    coarse = ('--set', 'numerics.grid=fast', '--set', 'numerics.trim_time=0.05')
    assert cli.main(['material', '--set', 'membrane.elements=16', *coarse, '--coupled',
                     '--voltages', '400', '--json', 'm.json']) == 0
    lower, middle = json.loads((tmp_path / 'm.json').read_text())['coupled']
    assert (lower['support'], middle['support']) == ('lower', 'middle')
    assert abs(middle['camber_mean']) < abs(lower['camber_mean'])
    assert 'pinned middle, 400 V' in capsys.readouterr().out


def test_voltages_beyond_the_limit_are_refused():
    assert cli.main([*COARSE, '--coupled', '--voltages', '5000']) == 2

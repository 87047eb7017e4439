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


@pytest.mark.parametrize('prestretch', [2.0, 2.4, 3.0, 5.0, 7.0])
def test_solid_elements_find_their_equilibria_at_common_prestretches(prestretch, tmp_path):
    assert cli.main(['material', '--set', 'membrane.elements=64', '--quiet', '--json', 'm.json',
                     '--set', f'membrane.prestretch={prestretch}']) == 0
    found = json.loads((tmp_path / 'm.json').read_text())
    assert found['largest_difference_solid_middle'] < 1e-4
    assert found['largest_difference_solid'] < 0.01
    assert found['camber_solid_highest'] > found['camber_solid_passive'] > 1e-5


def test_a_curve_that_fails_is_named_and_the_others_are_delivered(tmp_path, capsys):
    """Near its limit the law locks up at the corners of solid elements, not in a flat sheet."""
    near = [f'--set=membrane.{name}' for name in (
        'elements=16', 'prestretch=7.5', 'gent_limit=55.0')]
    assert cli.main(['material', *near, '--json', 'm.json', '--out', 'figures']) == 1
    said = capsys.readouterr().err
    assert said.startswith('dewing: not computed: loss of tension (no voltage takes the tension ')
    assert '; camber of solid (element 0 ' in said
    assert 'Gent limit 55' in said and said.count('\n') == 1
    found = json.loads((tmp_path / 'm.json').read_text())
    assert found['camber_membrane_passive'] > 0.0 and found['camber_solid_middle_passive'] > 0.0
    assert 'camber_solid_passive' not in found and 'largest_difference_solid' not in found
    assert found['tension'] > 0.0
    assert len(list((tmp_path / 'figures').iterdir())) == 4


def test_without_a_load_there_is_no_difference_to_report(tmp_path):
    assert cli.main([*COARSE, '--lift', '0', '--json', 'm.json']) == 0
    found = json.loads((tmp_path / 'm.json').read_text())
    assert found['camber_membrane_passive'] == 0.0 and 'largest_difference_solid' not in found


def test_elements_are_not_compared_in_a_wing_without_camber(capsys):
    assert cli.main(['material', '--coupled', '--quiet', '--voltages', '0', *(
        f'--set={value}' for value in (
            'membrane.elements=16', 'numerics.grid=fast', 'numerics.trim_time=0.05',
            'flow.angle_of_attack_deg=0.0'))]) == 2
    assert 'camber of the membrane: the passive camber is' in capsys.readouterr().err

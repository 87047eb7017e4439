# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command that finds modes."""

import json

import numpy as np
import pytest

from dewing_cli import main as cli

COARSE = ('modes', '--engine', 'conformal', '--grid', 'realtime', '--dt', '5e-4',
          '--set', 'numerics.trim_time=40.0')


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_table_figures_and_files(tmp_path, capsys):
    assert cli.main([*COARSE, '--count', '2', '--vectors', '60', '--period', '2e-3',
                     '--voltage', '400', '--out', 'm', '--json', 'm.json']) == 0
    found = json.loads((tmp_path / 'm.json').read_text())
    assert found['base']['voltage'] == 400.0 and found['base']['residual'] < 0.01
    assert found['vectors'] == 60 and 1 <= len(found['modes']) <= 2
    assert all(row['growth_per_s'] < 0.0 < row['damping'] for row in found['modes'])
    with np.load(tmp_path / 'm' / 'modes.npz') as kept:
        assert len(kept['vectors']) == len(found['modes']) == len(kept['frequency_hz'])
    assert (tmp_path / 'm' / 'mode_1.png').stat().st_size > 10_000
    assert 'steady wing: Cl' in capsys.readouterr().out


@pytest.mark.parametrize('given, words', [
    (('--vectors', '5'), '--vectors'), (('--period', '1e-5'), '--period'),
    (('--voltage', '5000'), '--voltage'), (('--count', '0'), '--count'),
    (('--duration', '1'), '--settle and --period')])
def test_what_makes_no_sense_is_refused(given, words, capsys):
    assert cli.main([*COARSE, *given]) == 2
    assert words in capsys.readouterr().err


def test_a_wing_that_does_not_settle_is_told_so(capsys):
    assert cli.main([*COARSE, '--set', 'numerics.trim_time=1.0', '--settle', '2']) == 1
    assert 'not steady' in capsys.readouterr().err

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command that times steps and laps: that its figures are of what it says, not how large."""

import json

import pytest

from dewing_cli import main as cli
from dewing_cli.bench import timing
from dewing_cli.bench.graph import Watched

COARSE = ('--set', 'numerics.engine=conformal', '--set', 'numerics.grid=realtime',
          '--set', 'numerics.time_step=5.0e-4', '--set', 'numerics.trim_time=1.0')


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_the_loop_is_timed_offline_composed_and_between_processes(capfd):
    assert cli.main(['bench', '--graph', '--case', 'paper', *COARSE, '--steps', '220',
                     '--json', 'b.json']) == 0
    with open('b.json', encoding='utf-8') as file:
        found = json.load(file)
    assert set(found['graph']) == {'composed', 'two_processes', 'two_processes_alpha8'}
    for row in (*found['graph'].values(), found['offline']['alpha4'], found['offline']['alpha8']):
        assert row['lap_ms_median'] > row['plant_ms_median'] > 0.0
        assert row['overhead_ms_p99'] >= row['overhead_ms_median'] > 0.0
    assert found['offline']['rtf_alpha4'] == found['offline']['alpha4']['rtf']
    assert found['floor']['raw_dds_ms'] > found['floor']['socket_pair_ms'] > 0.0
    assert 'two processes, 8 degrees' in capfd.readouterr().out


def test_a_grid_preset_is_timed(tmp_path):
    assert cli.main(['bench', '--engine', 'conformal', '--presets', 'realtime', '--steps', '20',
                     '--set', 'numerics.time_step=5.0e-4', '--set', 'numerics.trim_time=0.1',
                     '--quiet', '--json', 'b.json']) == 0
    row = json.loads((tmp_path / 'b.json').read_text())['presets']['realtime']
    assert row['cells'] == 96 * 48
    assert row['ms_per_step'] >= max(row['parts']['predict_ms'], row['parts']['correct_ms'])


@pytest.mark.parametrize('given', [
    ('--steps', '19'), ('--graph', '--steps', '200'), ('--presets', 'tiny'),
    ('--graph', '--presets', 'realtime'), ('--engine', 'none')])
def test_what_cannot_be_timed_is_refused(given, capfd):
    assert cli.main(['bench', *given]) == 2
    assert len(capfd.readouterr().err.splitlines()) == 1


def test_a_lap_is_shared_between_plant_and_overhead():
    class Plant:
        dt = 5.0e-4
        step = measure = staticmethod(lambda *_: None)

    watched = Watched(Plant())
    watched.began = [k * 1.0e-3 for k in range(300)]
    watched.spent = [0.4e-3] * 300
    figures = watched.figures()
    assert figures['lap_ms_median'] == pytest.approx(1.0)
    assert figures['overhead_ms_median'] == pytest.approx(0.6)
    assert figures['rtf'] == pytest.approx(0.5)


def test_the_datagram_comes_back():
    assert timing.socket_time(20) > 0.0

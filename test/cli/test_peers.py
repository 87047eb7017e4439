# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
import importlib
import re
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[2] / 'benchmarks' / 'peers'


@pytest.fixture
def peers(monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    return importlib.import_module


def test_cells_grow_from_the_smallest_to_the_length_of_the_block(peers):
    case = peers('openfoam_case')
    for cells, smallest, _, length in case.ALONG:
        ratio = case.expansion(cells, smallest, length)**(1.0 / (cells - 1))
        assert np.sum(smallest * ratio**np.arange(cells)) == pytest.approx(length)


def test_blocks_are_turned_the_right_way_and_split_along_the_plate(peers):
    case = peers('openfoam_case')
    text = case.block_mesh()
    vertices = text.split('blocks')[0]
    places = np.array(re.findall(r'\(([^()\s]+) ([^()\s]+) ([^()\s]+)\)', vertices), float)
    blocks = [np.array(found.split(), int) for found in re.findall(r'hex \(([^)]*)\)', text)]
    for block in blocks:
        a, b, _, d, e = places[block[:5]]
        assert np.linalg.det([b - a, d - a, e - a]) > 0.0
    wing = re.search(r'wing \{ type wall; faces \((.*?)\); \}', text).group(1)
    faces = [tuple(map(int, face.split())) for face in re.findall(r'\(([^)]*)\)', wing)]
    assert len(faces) == 4 == len({frozenset(face) for face in faces})
    assert np.ptp(places[np.ravel(faces)], axis=0)[:2] == pytest.approx([1.0, 0.0])


def test_the_shapes_of_the_bending_plate_start_at_rest(peers):
    plate = peers('plate')
    time = np.linspace(0.0, 0.5, 2001)
    rate = np.gradient(plate.camber(time), time)
    assert plate.camber(0.0) == plate.camber_rate(0.0) == 0.0
    assert np.abs(rate - plate.camber_rate(time))[1:-1].max() < 1.0e-6


def test_the_first_accurate_step_is_taken_and_failures_are_kept(peers):
    compare = peers('compare')
    time = np.linspace(0.0, 0.4, 41)
    exact = {'time': time, 'cl': np.ones(41), 'wall': 2.0 * time, 'cpu': time}

    def fails():
        raise peers('openfoam').Failed('icoFoam failed: exit status 1')

    found = compare.first_accurate(
        [(0.8, lambda: exact | {'cl': np.full(41, np.nan)}), (0.4, fails),
         (0.2, lambda: exact | {'cl': np.full(41, 1.02)}),
         (0.1, lambda: exact | {'cl': np.full(41, 1.005)}), (0.05, lambda: exact)], exact)
    assert found['dt'] == 0.1
    assert found['cl_error'] == pytest.approx(0.005)
    assert (found['wall_s'], found['cpu_s']) == pytest.approx((2.0, 1.0))
    assert [set(attempt) for attempt in found['tried'][:3]] == [
        {'dt', 'failed'}, {'dt', 'failed'}, {'dt', 'cl_error', 'wall_s', 'cpu_s'}]


def test_an_absent_peer_is_skipped_and_named(peers, monkeypatch, capsys):
    compare = peers('compare')
    monkeypatch.setattr('sys.argv', ['compare.py', '--peers', 'openfoam'])
    monkeypatch.setitem(compare.PEERS, 'openfoam', (lambda: False, *compare.PEERS['openfoam'][1:]))
    monkeypatch.setattr(compare, 'rows', lambda found: [])
    monkeypatch.setattr(compare, 'machine', dict)
    monkeypatch.setattr(compare, 'measure', lambda names, case: {})
    compare.main()
    assert 'apt-get install openfoam' in capsys.readouterr().out

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bags across a reset: every reader of stamps tells the runs apart."""

import json

import bags
import numpy as np
import pytest

from dewing_cli import main as cli
from dewing_sim.errors import BadInput
from dewing_sim.records import bag

STEP = 100_000
IDENTITY = ('{plant: reduced, dt: 1.0e-4, camber_mean: 2.0e-5, camber_max: 3.0e-5, '
            'v_squared_slack: 1.0e+6, v_squared_max: 1.0e+6, case: {}, version: test}')


@pytest.fixture
def path(tmp_path):
    """Return a bag of three runs: of 51 steps less two, of 31 and of 41 from a restored state."""
    steps = [*range(20), *range(22, 51)], [*range(31)], [*range(10, 51)]
    return bags.write(
        tmp_path / 'run.mcap', ('/dewing/case', bags.TEXT, bags.text(IDENTITY)),
        *(bags.measured(step * STEP, 2.0**-16 * (number + 1), 100.0 * (number + 1))
          for number, run in enumerate(steps) for step in run))


def stamps(*numbers):
    return [('/dewing/command', bags.JOINTS, bags.joints(number, ['v_squared'], (), [number]))
            for number in numbers]


def test_info_lists_the_runs_and_what_each_lacks(path, tmp_path, capsys):
    assert cli.main(['bag', 'info', str(path), '--json', str(tmp_path / 'info.json')]) == 0
    found = json.loads((tmp_path / 'info.json').read_text())
    assert [(run['from_s'], run['samples'], run['steps_missing']) for run in found['runs']] == [
        (0.0, 49, 2), (0.0, 31, 0), (pytest.approx(1.0e-3), 41, 0)]
    assert found['steps_missing'] == 2 and found['simulated_s'] == pytest.approx(12.0e-3)
    said = capsys.readouterr().out
    assert 'run 3 of /dewing/measurement: 0.001 to 0.005 s, 41 samples, 0 steps missing' in said


def test_a_run_is_chosen_by_its_number(path):
    for number, count in [(1, 49), (2, 31), (3, 41)]:
        series = bag.series(path, '/dewing/measurement', number)
        assert len(series['time']) == count and set(series['camber_mean']) == {number * 2.0**-16}
        assert np.all(np.diff(series['time']) > 0.0)
    with pytest.raises(BadInput, match=r'3 runs, of which one is to be chosen: 1 \(0 to 0.005 s'):
        bag.series(path, '/dewing/measurement')
    with pytest.raises(BadInput, match=r'has no run 4; it has 1 \(0 to 0.005 s\), 2'):
        bag.series(path, '/dewing/measurement', 4)


def test_plot_takes_a_run(path, tmp_path, capsys):
    plot = ['bag', 'plot', str(path), '--json', str(tmp_path / 'plot.json')]
    assert cli.main(plot) == 2 and 'one is to be chosen' in capsys.readouterr().err
    assert cli.main([*plot, '--run', '0']) == 2 and 'has no run 0' in capsys.readouterr().err
    assert cli.main([*plot, '--run', '2']) == 0
    assert json.loads((tmp_path / 'plot.json').read_text())['camber_mean_max'] == 2.0**-15
    assert cli.main(['bag', 'info', str(path), '--run', '2']) == 2
    assert '--run is for plot' in capsys.readouterr().err


@pytest.mark.parametrize('numbers, expected', [
    ([1, 2, 2, 3], [[1, 2, 3]]),
    ([0, 1, 2, 0, 1, 2, 3, 4], [[0, 1, 2], [0, 1, 2, 3, 4]]),
    ([*range(50), 0, 1, 0, 1, 2], [[*range(50)], [0, 1], [0, 1, 2]]),
    ([*range(50), *range(20, 60)], [[*range(50)], [*range(20, 60)]]),
    ([*range(50), 47, 48, 49], [[*range(50)]]),
    ([0, 1, 0, 2, 1, 3, 4, 5, 2, 3, 6], [[0, 1, 2, 3, 4, 5, 6]]),
    ([0, 0, 1, 1, 0, 0], [[0, 1], [0]])])
def test_a_reset_is_told_from_a_second_controller_that_is_slower(numbers, expected, tmp_path):
    path = bags.write(tmp_path / 'run.mcap', *stamps(*numbers))
    assert [run.stamps for run in bag.runs(path, '/dewing/command')] == expected
    assert [run.series()['v_squared'].tolist() for run in bag.runs(path, '/dewing/command')
            ] == expected

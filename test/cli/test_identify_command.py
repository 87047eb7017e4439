# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""``dewing identify``: the promised keys, recorded experiments, one sentence for each mistake."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy import io
from synthetic_plant import SyntheticPlant

from dewing_cli import main as cli
from dewing_sim import parameters
from dewing_sim.identity import Identity
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model
from dewing_sysid import experiment, plan
from dewing_sysid.settings import Settings

KEYS = {'fit', 'fit_fresh', 'poles_hz', 'poles_damping', 'singular_values', 'spectral_radius',
        'order', 'dt', 'seconds'}


pytestmark = pytest.mark.usefixtures('own_folder')


@pytest.fixture
def recorded():
    """Write the experiments of a wing-like plant to records.npz."""
    plant, case = SyntheticPlant(), parameters.load('paper')
    identity = Identity.of('synthetic', plant, plant.rest(), 1250.0**2,
                           parameters.to_mapping(case))
    planned = plan.make(parameters.load('sysid', Settings), identity)
    runs = experiment.run_all(plant, plant.rest(), planned.names, list(planned.inputs.values()))
    experiment.save_records('records.npz', planned.records(dict(zip(planned.inputs, runs))),
                            identity)


def fails(capsys, *arguments) -> str:
    """Return the only line on standard error of a command that must end with status 2."""
    assert cli.main(['identify', *arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == ''
    assert captured.err.count('\n') == 1 and captured.err.startswith('dewing: ')
    return captured.err


def test_recorded_experiments_give_model_metrics_and_figures(recorded):
    assert cli.main(['identify', '--from', 'records.npz', '--order', '8', '--out', 'model.npz',
                     '--mat', 'model.mat',
                     '--json', 'metrics.json', '--figures', 'figures', '--quiet']) == 0
    metrics = json.loads(Path('metrics.json').read_text())
    assert set(metrics) >= KEYS
    assert metrics['order'] == 8
    assert metrics['fit']['camber_mean'] > 99.9 and metrics['fit_fresh']['cl'] > 99.9
    assert Model.load('model.npz').fit['window'] == metrics['fit']
    assert np.array_equal(io.loadmat('model.mat')['A'], Model.load('model.npz').a)
    assert reduced.load('model.npz').dt == metrics['dt'] == 1.0e-4
    assert len(list(Path('figures').glob('*.png'))) == 5


def test_the_wing_itself_is_identified():
    assert cli.main(['identify', '--grid', 'fast', '--set', 'numerics.trim_time=0.1',
                     '--set', 'fresh.record=0.5', '--duration', '0.02', '--window', '0.6',
                     '--experiment', 'prbs', '--order', '4', '--outputs', 'camber_mean,mode_1',
                     '--set', 'realisation.lags=20', '--set', 'experiment.amplitude=100.0',
                     '--records', 'records.npz', '--json', 'metrics.json', '--quiet']) == 0
    records, identity = experiment.load_records('records.npz')
    assert records['experiment'].names == ('camber_mean', 'mode_1')
    assert records['experiment'].u.shape == (201,)
    assert np.ptp(records['experiment'].u) == pytest.approx(1.0e4)
    assert identity.case['numerics']['grid'] == 'fast'
    # The first sine carries most of the mean: 2/pi of its amplitude.
    camber, sine = np.linalg.norm(records['prbs'].y, axis=1)
    assert camber / sine == pytest.approx(2.0 / np.pi, rel=0.1)


@pytest.mark.parametrize('arguments, complaint', [
    (['--order', '1'], 'realisation.order = 1 is out of range'),
    (['--experiment', 'bang'], "experiment.kind = 'bang' is out of range"),
    (['--experiment', 'pulse', '--set', 'experiment.hold=0'], 'experiment.hold = 0 is out of'),
    (['--set', 'realisation.windows=1.0'], 'realisation.windows is not a parameter'),
    (['--set', 'flow.wind=1.0'], 'flow.wind is not a parameter'),
    (['--window', '-1'], 'realisation.window = -1.0 is out of range'),
    (['--jobs', '0'], '--jobs 0 is out of range'),
    (['--duration', '0'], '--duration 0 s is out of range'),
    (['--from', 'missing.npz'], 'missing.npz: no such file'),
    (['--from', 'missing.mcap'], 'missing.mcap: cannot be read'),
    (['--from', 'x.npz', '--outputs', 'cl'], 'leave out --outputs or --from'),
    (['--settings', 'paper'], 'parameters are expected below'),
    (['--out', '.'], '. is a folder'),
])
def test_bad_input_ends_with_status_2_and_one_sentence(capsys, arguments, complaint):
    assert complaint in fails(capsys, *arguments)


@pytest.mark.parametrize('arguments, complaint', [
    (['--window', '9'], 'the record holds 1184 samples'),
    (['--window', '0.02', '--order', '10'], 'order = 10 cannot be realised'),
])
def test_too_short_a_record_is_refused_with_numbers(capsys, recorded, arguments, complaint):
    assert complaint in fails(capsys, '--from', 'records.npz', *arguments)


def test_a_file_that_is_no_record_is_refused(capsys):
    np.savez('other.npz', x=1.0)
    assert 'not a record of an experiment' in fails(capsys, '--from', 'other.npz')


def test_an_existing_model_is_kept_without_force(capsys, recorded):
    Path('model.npz').write_text('precious')
    assert '--force' in fails(capsys, '--from', 'records.npz', '--out', 'model.npz')
    assert Path('model.npz').read_text() == 'precious'

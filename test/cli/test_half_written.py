# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Files of every kind that are read back, cut short: one sentence, or computed anew."""

import numpy as np
import pytest
from reduced_wing import first_mode

from dewing_cli.paper.runs import result as paper
from dewing_cli.sweep.file import Table, resume
from dewing_cli.sweep.sweep import DONE, METRICS, Result, Sweep, parse_axes
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model
from dewing_sim.machine import caches
from dewing_sim.records.history import History
from dewing_sim.rest import checkpoint, passive, trim
from dewing_sim.wing import Wing
from dewing_sysid.experiment import Record, load_records, save_records

CASE = parameters.load('paper', changes={
    'numerics.engine': 'conformal', 'numerics.grid': 'realtime', 'numerics.time_step': 5.0e-4,
    'numerics.trim_time': 0.1})
SWEEP = Sweep(CASE, parse_axes(['flow.angle_of_attack_deg=2.0,4.0']), 0.003, 0.0)
PLANT = first_mode(disturbance=0.05)


def write_history(path):
    time = np.linspace(0.0, 1.0, 50)
    History({'time': time, 'cl': time**2}, time[::10], {'y': np.ones((5, 20))},
            {'cl': '-', 'y': 'm'}, parameters.to_yaml(CASE)).save(path)


def write_records(path):
    identity = Identity.of('reduced', PLANT, PLANT.rest(), 1250.0**2, {})
    rows = np.ones((1, 40))
    save_records(path, {'pulse': Record(1.0e-4, rows[0], rows, rows, 0.0, ('cl',))}, identity)


def write_sweep(path):
    table = Table(SWEEP)
    for point in SWEEP.points:
        table.put(point.index, SWEEP.fingerprint(point),
                  Result(DONE, '', dict.fromkeys(METRICS, 1.0 + point.index[0])))
    table.save(path)


KINDS = {
    'wing.npz': (lambda path: checkpoint.save(path, trim.start(Wing(CASE)), CASE),
                 checkpoint.load),
    'state.npz': (lambda path: PLANT.save(path, PLANT.rest()), PLANT.load),
    'model.npz': (PLANT.model.save, Model.load),
    'plant.npz': (lambda path: reduced.save(path, PLANT), reduced.load),
    'history.npz': (write_history, History.load),
    'records.npz': (write_records, load_records),
    'passive.npz': (lambda path: passive._save(path, (2.0e-5, 3.0e-5)), passive._read),
    'sweep.nc': (write_sweep, lambda path: resume(SWEEP, path)),
}


def cuts(whole):
    """Return the file cut at many places, one of them within its last bytes."""
    return [whole[:size] for size in {*np.linspace(0, len(whole) - 1, 25, dtype=int).tolist(),
                                      len(whole) - 2}]


@pytest.mark.parametrize('name', KINDS)
def test_a_file_cut_short_is_refused_in_one_sentence(name, tmp_path):
    write, read = KINDS[name]
    path = tmp_path / name
    write(path)
    read(path)
    for part in cuts(path.read_bytes()):
        path.write_bytes(part)
        with pytest.raises(BadInput) as error:
            read(path)
        assert str(error.value).startswith(f'{path}: not ') and '\n' not in str(error.value)


def test_a_run_of_the_paper_cut_short_is_computed_again(tmp_path):
    path = tmp_path / 'run.npz'
    paper.keep(path, paper.Result({'cl': 0.4}, {'time': np.arange(90.0)}), 'mark')
    assert paper.recall(path, 'mark').values == {'cl': 0.4}
    for part in cuts(path.read_bytes()):
        path.write_bytes(part)
        assert paper.recall(path, 'mark') is None


@pytest.mark.parametrize('name, compute', [
    ('rest', lambda wing: trim.rest(wing).motion.position.tobytes()),
    ('passive', lambda wing: passive.camber(wing, trim.start(wing)))])
def test_a_kept_result_cut_short_is_computed_and_kept_again(name, compute, own_folder):
    wing = Wing(CASE)
    expected = compute(wing)
    kept, = caches.folder().glob(f'{name}-*')
    size = kept.stat().st_size
    for part in cuts(kept.read_bytes())[::4]:
        kept.write_bytes(part)
        assert compute(wing) == expected and kept.stat().st_size == size

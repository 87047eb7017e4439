# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Histories survive a file bit for bit, refuse NaN and never overwrite by accident."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.plant import SCALARS, Outputs
from dewing_sim.quantities import schema
from dewing_sim.records.history import History, Recorder, record


def outputs(k: int, **changes) -> Outputs:
    """Return made-up outputs that differ in every number."""
    numbers = {name: 0.1 * k + i for i, name in enumerate(SCALARS)}
    numbers |= {'time': 0.1 * k, 'v_squared': 100.0 * k, 'coupling_iterations': k}
    x = np.linspace(0.0, 1.0, 5)
    return Outputs(**(numbers | changes), x=x, y=k * x, pressure_jump=x - k)


def run(steps: int = 7, every: int = 3) -> History:
    return record(map(outputs, range(steps)), parameters.load('soft'), every)


def same(one: History, other: History) -> bool:
    return one.columns.keys() == other.columns.keys() and one.shapes.keys() == other.shapes.keys(
        ) and all(np.array_equal(getattr(one, name), getattr(other, name)) for name in (
            *one.columns, 'shape_time', *one.shapes, 'case', 'units'))


def test_scalars_are_kept_at_each_step_and_shapes_at_every_third():
    history = run()
    assert len(history) == 7 and history.cl.shape == (7,)
    assert np.allclose(history.voltage, 10.0 * np.sqrt(np.arange(7)), rtol=1e-15)
    assert np.allclose(history.shape_time, [0.0, 0.3, 0.6]) and history.y.shape == (3, 5)
    assert np.array_equal(history.y[2], 6 * np.linspace(0.0, 1.0, 5))
    assert history.coupling_iterations.dtype.kind == 'i'


def test_a_history_survives_its_file_bit_for_bit_with_its_case(tmp_path):
    history = run()
    history.save(tmp_path / 'deep' / 'run.npz')
    loaded = History.load(tmp_path / 'deep' / 'run.npz')
    assert same(loaded, history)
    assert parameters.from_yaml(loaded.case) == parameters.load('soft')
    assert [path.name for path in (tmp_path / 'deep').iterdir()] == ['run.npz']


def test_an_empty_history_survives_its_file(tmp_path):
    Recorder().history().save(tmp_path / 'run.npz')
    assert len(History.load(tmp_path / 'run.npz')) == 0


def test_a_file_is_not_overwritten_unless_told(tmp_path):
    path = tmp_path / 'run.npz'
    run(3).save(path)
    with pytest.raises(BadInput, match='exists; --force'):
        run(5).save(path)
    assert len(History.load(path)) == 3
    run(5).save(path, overwrite=True)
    assert len(History.load(path)) == 5


def test_a_folder_is_not_a_file(tmp_path):
    with pytest.raises(BadInput, match='is a folder'):
        run().save(tmp_path, overwrite=True)


@pytest.mark.parametrize('name', ['cl', 'v_squared', 'time'])
@pytest.mark.parametrize('value', [np.nan, np.inf])
def test_what_is_not_finite_is_refused_and_the_past_is_kept(name, value):
    recorder = Recorder()
    recorder.add(outputs(0))
    with pytest.raises(Diverged, match='not finite'):
        recorder.add(outputs(1, **{name: value}))
    assert len(recorder) == len(recorder.history()) == 1


def test_a_shape_that_is_not_finite_is_refused():
    broken = dataclasses.replace(outputs(1), y=np.array([0.0, np.nan]))
    with pytest.raises(Diverged):
        Recorder().add(broken)


def test_a_file_with_nan_is_refused(tmp_path):
    history = run()
    history.cl[2] = np.nan
    history.save(tmp_path / 'run.npz')
    with pytest.raises(BadInput, match='cl holds'):
        History.load(tmp_path / 'run.npz')


@pytest.mark.parametrize('content', [b'', b'words', b'PK\x03\x04 cut short'])
def test_another_file_is_refused(tmp_path, content):
    path = tmp_path / 'run.npz'
    path.write_bytes(content)
    with pytest.raises(BadInput, match='not the history'):
        History.load(path)


def test_an_array_file_without_the_fields_is_refused(tmp_path):
    np.savez(tmp_path / 'other.npz', time=np.zeros(3))
    np.save(tmp_path / 'other.npy', np.zeros(3))
    for name in ('other.npz', 'other.npy'):
        with pytest.raises(BadInput, match='not the history'):
            History.load(tmp_path / name)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(BadInput, match='no such file'):
        History.load(tmp_path / 'run.npz')


def test_the_late_part_of_a_run():
    late = run().since(0.25)
    assert np.allclose(late.time, [0.3, 0.4, 0.5, 0.6]) and late.y.shape == (2, 5)


def test_the_columns_are_those_of_the_schema_with_their_units():
    history, known = run(), schema(Outputs)
    assert tuple(history.columns) == known.columns and tuple(history.shapes) == known.shapes
    assert history.units == {each.name: each.unit for each in known.quantities}
    assert history.electric_field.shape == history.capacitance.shape == (7,)


def test_what_a_plant_does_not_have_is_absent_before_and_after_the_file(tmp_path):
    """Neither zeros nor NaN: there is no such column, and asking for it is an error."""
    history = record(Outputs(time=0.1 * k, v_squared=0.0, cl=0.4) for k in range(3))
    history.save(tmp_path / 'run.npz')
    for found in (history, History.load(tmp_path / 'run.npz'), history.since(0.1)):
        assert [*found.columns] == ['time', 'cl', 'v_squared'] and not found.shapes
        assert 'cl' in found and 'camber_mean' not in found and not hasattr(found, 'y')
        with pytest.raises(BadInput, match='does not hold camber_mean; it has time, cl, v_squ'):
            assert found.camber_mean


def test_outputs_that_come_and_go_are_refused():
    recorder = Recorder()
    recorder.add(Outputs(time=0.0, v_squared=0.0, cl=0.4))
    with pytest.raises(BadInput, match='does not have cl at every instant'):
        recorder.add(Outputs(time=0.1, v_squared=0.0))
    assert recorder.history().cl.tolist() == [0.4]


def test_a_file_of_version_0_1_loads_and_says_by_absence_what_it_lacks():
    """Written by 0.1: six steps at 300 V, eight elements, shapes of steps 1 and 4."""
    old = History.load(Path(__file__).parents[2] / 'reference' / 'history_0.1.npz')
    assert len(old) == 6 and np.allclose(old.voltage, 300.0) and old.y.shape == (2, 9)
    assert np.all(old.camber_max > old.camber_mean) and old.units['tension'] == 'N/m'
    assert parameters.from_yaml(old.case).membrane.elements == 8
    assert old.coupling_iterations.dtype.kind == 'i'
    for name in ('electric_field', 'capacitance'):
        assert name not in old
        with pytest.raises(BadInput, match=f'does not hold {name}'):
            getattr(old, name)

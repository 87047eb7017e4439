# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Reading npz files back: what is wrong with one is said in a sentence."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dewing_sim.errors import BadInput
from dewing_sim.files import read_npz

ARRAYS = {'a': np.arange(40.0), 'b': np.array('text'), 'c': np.array(['x', 'yy'])}


@pytest.fixture(scope='module', params=[np.savez, np.savez_compressed])
def sound(request, tmp_path_factory):
    path = tmp_path_factory.mktemp('files') / 'sound.npz'
    request.param(path, **ARRAYS)
    return path.read_bytes()


@pytest.fixture(scope='module')
def path(tmp_path_factory):
    return tmp_path_factory.mktemp('spoilt') / 'spoilt.npz'


def read(path):
    with read_npz(path, 'a thing') as arrays:
        return arrays


def test_arrays_come_back(sound, path):
    path.write_bytes(sound)
    found = read(path)
    assert found.keys() == ARRAYS.keys()
    assert all(np.array_equal(found[name], ARRAYS[name]) for name in ARRAYS)


@settings(max_examples=200, deadline=None)
@given(data=st.data())
def test_every_file_cut_short_is_refused(sound, path, data):
    path.write_bytes(sound[:data.draw(st.integers(0, len(sound) - 1))])
    with pytest.raises(BadInput, match='not a thing'):
        read(path)


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_a_wrong_byte_is_refused_or_without_effect_on_numbers(sound, path, data):
    spoilt = bytearray(sound)
    spoilt[data.draw(st.integers(0, len(sound) - 1))] ^= data.draw(st.integers(1, 255))
    path.write_bytes(spoilt)
    try:
        found = read(path)
    except BadInput as error:
        assert 'not a thing' in str(error)
    else:
        assert all(np.array_equal(array, ARRAYS[name]) for name, array in found.items()
                   if name in ARRAYS)


def test_a_missing_file_and_a_single_array_are_told_apart(tmp_path):
    with pytest.raises(BadInput, match='no such file'):
        read(tmp_path / 'missing.npz')
    np.save(tmp_path / 'single.npy', ARRAYS['a'])
    with pytest.raises(BadInput, match='not a thing'):
        read(tmp_path / 'single.npy')
    with pytest.raises(BadInput, match='not a thing'):
        read(tmp_path)


@pytest.mark.parametrize('use, words', [
    (lambda arrays: arrays['d'], "it holds no 'd'"),
    (lambda arrays: float(arrays['b']), 'could not convert'),
    (lambda arrays: arrays['a'].nothing, 'nothing'),
])
def test_arrays_that_do_not_make_the_thing_are_refused(use, words, tmp_path):
    np.savez(tmp_path / 'file.npz', **ARRAYS)
    with pytest.raises(BadInput, match=f'not a thing .*{words}'):
        with read_npz(tmp_path / 'file.npz', 'a thing') as arrays:
            use(arrays)

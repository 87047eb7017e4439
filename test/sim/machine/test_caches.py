# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The cache folder: where it is, that it heals, that nothing needs it."""

import pytest

from dewing_sim.errors import BadInput
from dewing_sim.machine import caches


def read(path):
    if path.read_text() == 'broken':
        raise BadInput('broken')
    return path.read_text()


def test_the_folder_is_where_xdg_says_else_in_the_home(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    assert caches.folder() == tmp_path / 'dewing'
    monkeypatch.setenv('HOME', str(tmp_path / 'home'))
    for ignored in ('', 'relative'):
        monkeypatch.setenv('XDG_CACHE_HOME', ignored)
        assert caches.folder() == tmp_path / 'home' / '.cache' / 'dewing'
    monkeypatch.delenv('XDG_CACHE_HOME')
    assert caches.folder() == tmp_path / 'home' / '.cache' / 'dewing'


def test_what_is_kept_is_recalled_and_a_broken_file_goes(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    assert caches.recall('a', read) is None
    caches.keep('a', lambda draft: draft.write_text('sound'))
    assert caches.recall('a', read) == 'sound'
    caches.keep('a', lambda draft: draft.write_text('broken'))
    assert caches.recall('a', read) is None
    assert not list((tmp_path / 'dewing').iterdir())


def test_a_write_that_fails_leaves_what_was_there(tmp_path, monkeypatch):
    def fill(draft):
        draft.write_text('half')
        raise OSError('no space left')

    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    caches.keep('a', lambda draft: draft.write_text('sound'))
    caches.keep('a', fill)
    assert caches.recall('a', read) == 'sound'
    assert len(list((tmp_path / 'dewing').iterdir())) == 1


def test_a_user_without_a_home_has_no_cache(monkeypatch):
    def no_home():
        raise RuntimeError('Could not determine home directory.')

    monkeypatch.delenv('XDG_CACHE_HOME', raising=False)
    monkeypatch.setattr(caches.Path, 'home', no_home)
    assert caches.folder() is None
    caches.keep('a', lambda draft: draft.write_text('sound'))
    assert caches.recall('a', read) is None


@pytest.mark.parametrize('place', ['/proc', '/dev/null'])
def test_a_folder_that_cannot_be_written_keeps_nothing(place, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', place)
    caches.keep('a', lambda draft: draft.write_text('sound'))
    assert caches.recall('a', read) is None

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The fingerprint of a result follows the imports of what computed it, and nothing else."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from dewing_sim.machine import fingerprint as machine

PROJECT = Path(__file__).parents[3]
FILES = [path for folder in ('dewing_*', 'test', 'benchmarks', 'scripts', 'docs')
         for top in PROJECT.glob(folder) for path in top.rglob('*.py')]
SOURCES = {
    '__init__': '', 'start': 'from .near import value\nimport own.far\n',
    'near': 'from . import beside\nfrom .deep.inside import (\n    one,  # (why)\n    two)\n',
    'beside': '', 'far': 'def late():\n    from own import later\n', 'later': '',
    'unrelated': 'import os\n', 'deep/__init__': '', 'deep/inside': 'from .. import above\n',
    'above': 'import numpy, other_top\n'}


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write a package outside dewing; return a function that gives its fingerprint anew."""
    monkeypatch.syspath_prepend(str(tmp_path))
    for name, text in SOURCES.items():
        path = tmp_path / 'own' / f'{name}.py'
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (tmp_path / 'other_top.py').write_text('')

    def forget():
        machine._source.cache_clear()
        machine._folders.cache_clear()

    def mark():
        forget()
        return machine.fingerprint('own.start')

    yield tmp_path / 'own', mark
    forget()


@pytest.mark.parametrize('path', FILES, ids=lambda path: str(path.relative_to(PROJECT)))
def test_imports_are_found_as_by_the_parser(path):
    text = path.read_text()
    package = '.'.join(path.relative_to(PROJECT).parent.parts)
    parsed = set(machine.imported_by_parser(text, package))
    found = set(machine.imported(text, package))
    assert parsed <= found
    if 'test' not in path.relative_to(PROJECT).parts:       # these hold sources in strings
        assert found == parsed


@pytest.mark.parametrize('text', [
    'import a; import b.c', 'if True: import a', 'if True: from a import b', 'from .. import(b)',
    'from a import \\\n    b', 'import a, \\\n    b', 'import a.b as c, d', 'from . a import b',
    'from a import (b,  # (why)\n    c as d)', 'from a import (  # )\n    b)', 'from ... import a',
    'try:\n    import a\nexcept ImportError:\n\tfrom b.c import d, e as f  # one',
    'x = 1;import a', 'from a import b; c = 1', 'from\\\n a import b', 'import\ta',
    'from a import*',
])
def test_unusual_imports_are_found(text):
    assert set(machine.imported(text, 'p.q.r')) == set(
        machine.imported_by_parser(text, 'p.q.r'))


def test_a_package_outside_is_followed_within_itself(own):
    assert set(machine.sources('own.start')) == {
        'own', *(f'own.{name}' for name in (
            'start', 'near', 'beside', 'far', 'later', 'deep', 'deep.inside', 'above'))}


@pytest.mark.parametrize('name', sorted(set(SOURCES) - {'unrelated'}))
def test_a_change_of_any_source_that_takes_part_changes_it(own, name):
    folder, mark = own
    before = mark()
    (folder / f'{name}.py').write_text(SOURCES[name] + 'more = 1\n')
    assert mark() != before


def test_unrelated_sources_do_not_count(own):
    folder, mark = own
    before = mark()
    (folder / 'unrelated.py').write_text('# A comment.\n')
    (folder / 'new.py').write_text('')
    assert mark() == before


def test_moved_and_added_files_are_followed(own):
    folder, mark = own
    before = mark()
    (folder / 'far.py').rename(folder / 'moved.py')
    assert mark() != before
    (folder / 'start.py').write_text(SOURCES['start'].replace('far', 'moved'))
    before = mark()
    (folder / 'moved.py').write_text('# changed')
    assert mark() != before
    before = mark()
    (folder / 'beside').mkdir()         # a package takes the place of the module
    (folder / 'beside' / '__init__.py').write_text('added = 1\n')
    assert mark() != before


def test_no_module_is_run_for_it():
    program = ('import sys\nfrom dewing_sim.machine.fingerprint import sources\n'
               'found = sources("dewing_sim.wing")\n'
               'print(len(found), [name for name in found if name in sys.modules])')
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True,
                          check=True, env={'PYTHONPATH': str(PROJECT)})
    count, loaded = done.stdout.split(maxsplit=1)
    assert int(count) > 50
    assert set(ast.literal_eval(loaded)) == {'dewing_sim', 'dewing_sim.machine',
                                             'dewing_sim.machine.fingerprint'}


def test_what_is_no_module_is_left_out():
    assert machine.sources('nowhere.at_all', 'dewing_sim.errors.BadInput') == {}

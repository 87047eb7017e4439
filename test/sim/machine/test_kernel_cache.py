# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled functions are taken from disk when, and only when, all they are made of is the same."""

import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numba
import pytest

PROJECT = Path(__file__).parents[3]
TOP = """
from pile import middle
from pile.middle import share
from pile.values import Pair, pair
from dewing_sim.machine.kernels import kernel


@kernel
def run(x):
    '''Return a number.'''
    return middle.sum_up(x) + share(x) + Pair(x, pair.second).second + middle.OFFSET


@kernel
def first(pair):
    return pair.first
"""
MIDDLE = """
import numpy as np
from pile import bottom
from dewing_sim.machine.kernels import checked_kernel, formula, part, stage

OFFSET = 1000.0
WEIGHTS = np.array([1.0, 2.0])


@checked_kernel
def sum_up(x):
    return WEIGHTS[0] * staged(x) + WEIGHTS[1] * bottom.scaled(x)


@stage
def staged(x):
    return x + 10.0


@formula
def share(x):
    return x + 100.0
"""
BOTTOM = """
from dewing_sim.machine.kernels import part

FACTOR = 3.0


@part
def scaled(x):
    return FACTOR * x
"""
VALUES = """
from typing import NamedTuple


class Pair(NamedTuple):
    first: float
    second: float


pair = Pair(5.0, 7.0)
"""
SOURCES = {'top': TOP, 'middle': MIDDLE, 'bottom': BOTTOM, 'values': VALUES, '__init__': ''}
RESULT = (1.0 + 10.0) + 2.0 * 3.0 + 101.0 + 7.0 + 1000.0
LONG_AGO, YET_TO_COME = 1.0e8, 4.0e9


class Pile:
    """A package of kernels, imported anew each time as by a new process."""

    def __init__(self, folder, monkeypatch):
        self.folder, self._monkeypatch = folder / 'pile', monkeypatch
        self.folder.mkdir(parents=True)
        for name, text in SOURCES.items():
            self.path(name).write_text(text)

    def path(self, name):
        return self.folder / f'{name}.py'

    def edit(self, name, old, new, time=LONG_AGO):
        text = self.path(name).read_text()
        assert old in text
        self.path(name).write_text(text.replace(old, new))
        os.utime(self.path(name), (time, time))

    def load(self):
        for name in [name for name in sys.modules if name.partition('.')[0] == 'pile']:
            del sys.modules[name]
        self._monkeypatch.setattr(sys, 'path', [str(self.folder.parent), *sys.path])
        importlib.invalidate_caches()
        return importlib.import_module('pile.top')

    def run(self):
        """Return the kernel's result at 1 and whether it was compiled for that."""
        run = self.load().run
        return run(1.0), sum(run.stats.cache_misses.values()) > 0

    def files(self, kind):
        return sorted(self.folder.parent.parent.rglob(f'*.run.*.{kind}'))


@pytest.fixture(params=['beside the source', 'NUMBA_CACHE_DIR'])
def pile(request, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, 'dont_write_bytecode', True)     # Python's own go by time stamps
    if request.param == 'NUMBA_CACHE_DIR':
        monkeypatch.setattr(numba.config, 'CACHE_DIR', str(tmp_path / 'kernels'))
    yield Pile(tmp_path / 'install', monkeypatch)
    for name in [name for name in sys.modules if name.partition('.')[0] == 'pile']:
        del sys.modules[name]


@pytest.mark.parametrize('name, old, new, difference', [
    pytest.param('top', 'share(x) + ', '', -101.0, id='the kernel itself'),
    pytest.param('middle', 'WEIGHTS[0] * ', '', 0.0, id='a kernel that it calls'),
    pytest.param('middle', '+ 10.0', '+ 20.0', 10.0, id='a stage of a kernel that it calls'),
    pytest.param('middle', '+ 100.0', '+ 200.0', 100.0, id='a formula'),
    pytest.param('bottom', 'FACTOR * x', 'FACTOR + x', 2.0, id='a part of a module of a module'),
    pytest.param('bottom', 'FACTOR = 3.0', 'FACTOR = 4.0', 2.0, id='a number far below'),
    pytest.param('bottom', 'FACTOR = 3.0', 'FACTOR = 3', 0.0, id='the type of a number'),
    pytest.param('middle', 'OFFSET = 1000.0', 'OFFSET = 2000.0', 1000.0, id='a module attribute'),
    pytest.param('middle', '[1.0, 2.0]', '[1.0, 3.0]', 3.0, id='an array'),
    pytest.param('values', 'Pair(5.0, 7.0)', 'Pair(5.0, 8.0)', 1.0, id='a tuple'),
    pytest.param('middle', '@checked_kernel', '@part', 0.0, id='an option of the compiler'),
])
def test_a_change_takes_effect_whatever_the_time_stamps(pile, name, old, new, difference):
    assert pile.run() == (RESULT, True)
    assert pile.run() == (RESULT, False)
    pile.edit(name, old, new)
    assert pile.run() == (RESULT + difference, True)
    assert pile.run() == (RESULT + difference, False)
    assert len(pile.files('nbc')) == 1          # what is out of date does not stay


def test_the_fields_of_an_argument_count_as_well(pile):
    top = pile.load()
    assert top.first(top.Pair(5.0, 7.0)) == 5.0
    pile.edit('values', 'first: float\n    second: float', 'second: float\n    first: float')
    top = pile.load()
    assert top.first(top.Pair(5.0, 7.0)) == 7.0


def test_comments_lines_docstrings_and_stamps_compile_nothing(pile):
    pile.run()
    pile.edit('top', 'from pile import middle', '# A comment.\n\n\nfrom pile import middle')
    pile.edit('top', 'Return a number.', 'Return a sum.')
    pile.edit('bottom', 'FACTOR = 3.0', 'FACTOR = 3.0    # of three', YET_TO_COME)
    assert pile.run() == (RESULT, False)
    assert pile.run() == (RESULT, False)


def test_a_moved_folder_compiles_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, 'dont_write_bytecode', True)
    before = Pile(tmp_path / 'here', monkeypatch)
    before.run()
    after = Pile(tmp_path / 'there', monkeypatch)       # sources written anew, with new stamps
    shutil.copytree(before.folder / '__pycache__', after.folder / '__pycache__')
    shutil.rmtree(tmp_path / 'here')
    assert after.run() == (RESULT, False)


def gone_module():
    """Return an index as the version of numba leaves it, of a module that is not there."""
    return b'\x80\x04\x8c' + bytes([len(numba.__version__)]) + numba.__version__.encode() + (
        b'.cgone.module\nName\n.')


@pytest.mark.parametrize('kind', ['nbi', 'nbc'])
@pytest.mark.parametrize('spoil', [
    pytest.param(lambda content: b'', id='empty'),
    pytest.param(lambda content: content[:len(content) // 2], id='cut off'),
    pytest.param(lambda content: gone_module(), id='naming a module that is gone'),
])
def test_files_that_cannot_be_read_are_replaced(pile, kind, spoil):
    pile.run()
    for path in pile.files(kind):
        path.write_bytes(spoil(path.read_bytes()))
    assert pile.run() == (RESULT, True)
    assert pile.run() == (RESULT, False)


def test_functions_of_one_name_are_kept_side_by_side(pile):
    maker = """
def scaler(factor):
    @kernel
    def run(x):
        return factor * x
    return run
"""
    pile.path('top').write_text(TOP + maker)

    def misses():
        scalers = [pile.load().scaler(factor) for factor in (2.0, 3.0)]
        assert [scaler(5.0) for scaler in scalers] == [10.0, 15.0]
        return [sum(scaler.stats.cache_misses.values()) for scaler in scalers]

    assert misses() == [1, 1]
    assert misses() == [0, 0]


@pytest.mark.parametrize('home', ['/proc', 'relative'])
def test_without_a_folder_to_write_to_functions_are_compiled_each_time(home, tmp_path):
    pile = tmp_path / 'pile'
    pile.mkdir()
    for name, text in SOURCES.items():
        (pile / f'{name}.py').write_text(text)
    (pile / '__pycache__').write_text('a file where the folder should be')
    started = tmp_path / 'started'
    started.mkdir()
    environment = {'PYTHONPATH': f'{tmp_path}:{PROJECT}', 'PYTHONDONTWRITEBYTECODE': '1',
                   'XDG_CACHE_HOME': home}
    program = 'from pile.top import run; print(run(1.0)); print(run.stats.cache_path)'
    done = subprocess.run([sys.executable, '-c', program], env=environment, cwd=started,
                          capture_output=True, text=True, check=True)
    assert done.stdout.split() == [str(RESULT), 'None']
    assert done.stderr == ''
    assert not list(started.iterdir())


def test_contents_do_not_depend_on_the_process():
    program = ('from dewing_sim.machine.content import digest\n'
               'from dewing_sim.fluid.conformal.step import advance as a\n'
               'print(digest(a.py_func, a.targetoptions))')
    texts = {subprocess.run([sys.executable, '-c', program], text=True, check=True,
                            env={**os.environ, 'PYTHONHASHSEED': seed, 'PYTHONPATH': str(PROJECT)},
                            capture_output=True).stdout for seed in ('1', '2')}
    assert len(texts) == 1
    assert len(texts.pop().strip()) == 64


def test_all_that_is_compiled_is_kept_by_its_content():
    words = ('numba.njit', 'numba.jit', 'numba.cfunc', 'cache=True', 'register_jitable')
    found = [path for package in PROJECT.glob('dewing_*') for path in package.rglob('*.py')
             if any(word in path.read_text() for word in words)]
    assert [path.relative_to(PROJECT).as_posix() for path in found] == [
        'dewing_sim/machine/kernels.py']

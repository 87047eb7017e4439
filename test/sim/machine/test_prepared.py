# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels compiled beforehand are used where they fit, and only there."""

import json
import os
import shutil
import subprocess
import sys
import zipfile

import kernels_wheel
import numba
import pytest

from dewing_sim import prepare
from dewing_sim.errors import BadInput
from dewing_sim.machine import prepared

MODULE = """
import sys
from numba.core import event
from dewing_sim.machine import kernel_cache
from dewing_sim.machine.kernels import c_function, kernel, part
from numba import types

class Count(event.Listener):
    compiled = 0
    def on_start(self, compilation):
        Count.compiled += 1
    def on_end(self, compilation):
        pass

@part
def half(x):
    return 0.5 * x

@kernel
def mean(values):
    total = 0.0
    for value in values:
        total += half(value)
    return 2.0 * total / values.size

def twice(x):
    return 2.0 * x
"""
RUN = """
import sys
import numpy as np
from pile import module
from dewing_sim.machine import kernel_cache
module.event.register('numba:compile', module.Count())
if len(sys.argv) > 1:
    kernel_cache.write_prepared()
result = module.mean(np.arange(5.0))
twice = module.c_function(module.twice, module.types.float64(module.types.float64))
print(result + twice.ctypes(1.0), module.Count.compiled + (not twice.cache_hits))
"""
RESULT = 4.0


class Pile:
    """A package of two kernels, run in processes without a cache of their own."""

    def __init__(self, folder):
        self._folder, self._homes = folder, 0
        (folder / 'code' / 'pile').mkdir(parents=True)
        (folder / 'code' / 'pile' / 'module.py').write_text(MODULE)

    def run(self, kernels, *arguments, **environment):
        """Return the number of functions that were compiled."""
        self._homes += 1
        home = self._folder / f'home{self._homes}'
        inherited = {name: value for name, value in os.environ.items()
                     if not name.startswith(('NUMBA', 'DEWING'))}
        made = subprocess.run([sys.executable, '-c', RUN, *arguments], text=True,
                              capture_output=True, env=inherited | {
            'PYTHONPATH': os.pathsep.join([str(self._folder / 'code'), *sys.path]),
            'HOME': str(home), 'NUMBA_CACHE_DIR': str(home / 'numba'),
            prepared.VARIABLE: str(kernels), **environment})
        assert made.returncode == 0, made.stderr
        result, compiled = made.stdout.split()
        assert float(result) == RESULT
        return int(compiled)


@pytest.fixture(scope='module')
def pile(tmp_path_factory):
    return Pile(tmp_path_factory.mktemp('pile'))


@pytest.fixture(scope='module')
def filled(pile, tmp_path_factory):
    """Return a folder of prepared kernels."""
    folder = tmp_path_factory.mktemp('made')
    assert pile.run(folder, 'write', **prepared.baseline()) == 3
    prepared.write_target(folder, (prepared.host()[0], prepared.BASELINE, prepared.FEATURES))
    return folder


@pytest.fixture
def kernels(filled, tmp_path):
    """Return the same in another place, with other times of files."""
    return shutil.copytree(filled, tmp_path / 'moved', copy_function=shutil.copyfile)


@pytest.mark.skipif('avx2' not in str(prepared.host()), reason='an older processor')
def test_nothing_is_compiled_that_is_prepared(pile, kernels):
    before = {path: path.read_bytes() for path in kernels.rglob('*') if path.is_file()}
    for path in [kernels, *kernels.rglob('*')]:
        path.chmod(0o555 if path.is_dir() else 0o444)
    assert pile.run(kernels) == 0
    assert before == {path: path.read_bytes() for path in kernels.rglob('*') if path.is_file()}
    for path in [kernels, *kernels.rglob('*')]:
        path.chmod(0o755)


@pytest.mark.parametrize('name, value', [
    ('features', prepared.FEATURES + ',+no-such-feature'), ('triple', 'riscv64-unknown-linux'),
    ('features', None), (None, None)])
def test_what_does_not_fit_this_processor_is_compiled(pile, kernels, name, value):
    target = json.loads((kernels / prepared.TARGET).read_text())
    text = json.dumps(target | {name: value}) if name else '{'
    (kernels / prepared.TARGET).write_text(text)
    assert pile.run(kernels) == 3


@pytest.mark.parametrize('old', ['numba', 'the kernel', 'the data'])
def test_what_another_version_compiled_is_compiled_anew(pile, kernels, old):
    for path in kernels.rglob('*.nbc' if old == 'the data' else '*.nbi'):
        data = path.read_bytes()
        version = numba.__version__.encode()
        changed = {'numba': data.replace(version, b'9' * len(version), 1),
                   'the kernel': data[:40] + b'?' * 20 + data[60:], 'the data': data[:100]}[old]
        assert changed != data
        path.write_bytes(changed)
    assert pile.run(kernels) == 3


def test_a_folder_of_something_else_is_not_overwritten(tmp_path):
    (tmp_path / 'precious').touch()
    with pytest.raises(BadInput, match='is in the way'):
        prepare.prepare_baseline(1, tmp_path)
    assert (tmp_path / 'precious').exists()


def test_the_wheel_installs_the_package_that_is_looked_for(tmp_path, kernels, monkeypatch):
    wheel = kernels_wheel.pack(kernels, tmp_path / 'dist')
    with zipfile.ZipFile(wheel) as file:
        file.extractall(tmp_path / 'site')
    monkeypatch.syspath_prepend(tmp_path / 'site')
    monkeypatch.delenv(prepared.VARIABLE, raising=False)
    place = prepared.folder()
    assert place == str(tmp_path / 'site' / prepared.PACKAGE)
    assert prepared.target(prepared.host()) == prepared._target(str(kernels))
    record = (tmp_path / 'site').glob('*.dist-info/RECORD')
    files = [line.split(',')[0] for line in next(record).read_text().splitlines()]
    assert sorted(files) == sorted(str(path.relative_to(tmp_path / 'site'))
                                   for path in (tmp_path / 'site').rglob('*') if path.is_file())

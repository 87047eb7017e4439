# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Targets of make for real: beside foreign folders, under another VENV, in any order, twice.

The tree is a part of the sources, enough to be linted and tested, in a path with spaces. Its
environment is one of its own that looks into the one that runs this, so that nothing is
installed, and that one is safe whatever a target does.
"""

import os
import runpy
import shutil
import site
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
KEPT = ('Makefile', 'pyproject.toml', 'setup.cfg', 'setup.py', 'package.xml',
        'docs/requirements.txt', 'scripts/environment.py', 'scripts/find_python')
FOLDERS = ('benchmarks', 'config', 'dewing_cli', 'dewing_control', 'dewing_sim', 'dewing_sysid',
           'docs', 'examples', 'launch', 'scripts', 'test')
SOUND = '# Copyright 2026 The dewing authors\n# SPDX-License-Identifier: Apache-2.0\n'
FOREIGN = 'import os, sys\nlist = [ 1,2 ]\ndef test_of_others(): assert False\n'
TEST = SOUND + '"""Is collected."""\n\n\ndef test_of_ours():\n    assert True\n'


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """Return a checkout in a path with spaces, with what others may have put beside it."""
    monkeypatch.delenv('AMENT_PREFIX_PATH')     # no system ROS: find_python takes any Python
    tree = tmp_path / 'a path with spaces'
    for name in KEPT:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(PROJECT / name, tree / name)
    for name in FOLDERS:
        (tree / name).mkdir(exist_ok=True)
        (tree / name / 'module.py').write_text(SOUND)
    (tree / 'test' / 'support').mkdir()
    (tree / 'test' / 'test_one.py').write_text(TEST)
    for name in ('.venv-docs', 'env2/lib', 'build', 'notes', 'out'):
        (tree / name).mkdir(parents=True)
        (tree / name / 'test_others.py').write_text(FOREIGN)
    return tree


def environment(tree: Path, name: str) -> None:
    """Make the environment that make finds current."""
    folder, here = tree / name, site.getsitepackages()[0]
    subprocess.run([sys.executable, '-m', 'venv', '--without-pip', folder], check=True)
    inside = next(folder.glob('lib/python3.*/site-packages'))
    (inside / 'others.pth').write_text(f'import site; site.addsitedir({here!r})\n')
    for tool in ('ruff', 'flake8'):
        (folder / 'bin' / tool).symlink_to(Path(sys.prefix, 'bin', tool))
    own = runpy.run_path(str(tree / 'scripts' / 'environment.py'))
    (folder / 'dewing.stamp').write_text(own['recipe'](folder, own['ros_source'](), None))


def environment_of_docs(tree: Path, name: str) -> None:
    """Make a folder that make takes for the environment of the documentation."""
    (tree / name).mkdir(exist_ok=True)
    own = runpy.run_path(str(tree / 'scripts' / 'environment.py'))
    (tree / name / 'dewing.stamp').write_text(own['recipe'](
        tree / name, 'tools', tree / 'docs' / 'requirements.txt'))


def make(tree: Path, *words: str) -> subprocess.CompletedProcess:
    env = {name: value for name, value in os.environ.items()
           if name not in ('PYTHONPATH', 'MAKEFLAGS', 'MAKELEVEL', 'VENV', 'VIRTUAL_ENV')}
    return subprocess.run(['make', *words], cwd=tree, capture_output=True, text=True,
                          env=env | {'PYTHON': sys.executable, 'PIP_NO_INDEX': '1'})


@pytest.mark.parametrize('venv, targets', [
    ('.venv', ('docs-venv', 'test', 'test')),
    ('env', ('lint', 'docs-venv', 'venv', 'lint'))])
def test_targets_in_any_order_and_twice_beside_what_others_put_there(tree, venv, targets):
    environment(tree, venv)
    environment_of_docs(tree, f'{venv}-docs')
    for target in targets:
        done = make(tree, f'VENV={venv}', target)
        assert done.returncode == 0, (target, done.stdout, done.stderr)
        assert 'environment' not in done.stdout and 'others' not in done.stdout
        assert ('. ' in done.stdout) == (target == 'test'), done.stdout       # one test, ours
    (tree / 'dewing_sim' / 'module.py').write_text(FOREIGN)
    for target in ('lint', 'test'):
        assert make(tree, f'VENV={venv}', target).returncode != 0


def test_clean_leaves_results_and_what_is_not_ours(tree):
    environment(tree, 'env')
    assert make(tree, 'VENV=env', 'clean').returncode == 0
    assert make(tree, 'VENV=env', 'clean').returncode == 0
    left = {path.name for path in tree.iterdir()}
    assert {'out', 'notes', 'env2', '.venv-docs', *FOLDERS} <= left
    assert not {'env', 'build'} & left


def test_every_target_says_what_it_would_do(tree):
    text = (tree / 'Makefile').read_text()
    targets = next(line for line in text.splitlines() if line.startswith('.PHONY:')).split()[1:]
    for target in targets:
        done = make(tree, '-n', 'VENV=env', target)
        assert done.returncode == 0 and 'env' in done.stdout + 'env' * (target == 'help')

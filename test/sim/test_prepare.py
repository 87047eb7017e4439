# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What is compiled beforehand is what runs call, and a run loads no kernel of another engine."""

import json
import subprocess
import sys

import pytest

from dewing_sim import prepare

CALLED = """
import json, sys
from numba.core.dispatcher import Dispatcher
from dewing_sim.machine.kernel_cache import KernelCache
print(json.dumps(sorted({f'{kernel.py_func.__module__}.{kernel.__name__}{signature}'
    for name, module in list(sys.modules.items()) if name.startswith('dewing_')
    for kernel in vars(module).values()
    if isinstance(kernel, Dispatcher) and isinstance(kernel._cache, KernelCache)
    for signature in kernel.signatures})))
"""
SHORT = ['--set', 'numerics.trim_time=0.3', '--quiet']
COMMANDS = {
    'conformal': [
        ['simulate', '--case', 'realtime_alpha8', '--duration', '1e-3', *SHORT],
        ['simulate', '--case', 'realtime', '--duration', '1e-3', *SHORT, '--disturbance', 'fig5',
         '--set', 'gust.shape=one_minus_cosine', '--set', 'gust.vertical=0.1'],
        ['plate', '--alpha', '4', '--engine', 'conformal', '--grid', 'realtime',
         '--duration', '0.05', '--quiet']],
    'finite volumes': [
        ['simulate', '--case', 'soft', '--duration', '2e-5', *SHORT],
        ['plate', '--alpha', '4', '--camber', '0.02', '--duration', '0.05', '--quiet']],
}
OTHER = {'conformal': 'finite_volume', 'finite volumes': 'conformal'}


def called(code: str) -> set[str]:
    """Return the kernels, with the types of their arguments, that ``code`` calls from Python."""
    made = subprocess.run([sys.executable, '-c', code + CALLED], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    return set(json.loads(made.stdout.splitlines()[-1]))


@pytest.mark.parametrize('kind', prepare.KINDS)
def test_runs_call_what_is_prepared_and_nothing_of_the_other_engine(kind):
    known = called(f'from dewing_sim import prepare\nprepare.walk({kind!r})')
    assert len(known) > 10
    for command in COMMANDS[kind]:
        needed = called(f'from dewing_cli import main\nassert main.main({command}) == 0')
        assert needed and needed <= known, needed - known
        assert not [name for name in needed if OTHER[kind] in name]

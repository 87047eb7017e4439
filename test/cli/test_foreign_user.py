# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A user whom the machine does not know, without a home: as in a container with any uid."""

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from reduced_wing import first_mode

from dewing_sim.linear import reduced

PROJECT = Path(__file__).parents[2]
UID = 54321
# Of root: another uid that may read everything, as the interpreter may lie in root's home. Of
# anybody: a name space in which the own uid has another number. Else no home, under the own uid.
WAYS = (['setpriv', f'--reuid={UID}', f'--regid={UID}', '--clear-groups',
         '--inh-caps=+dac_read_search', '--ambient-caps=+dac_read_search'],
        ['unshare', '--user', f'--map-user={UID}', f'--map-group={UID}'],
        ['env'])
PLACE = """
import os
from dewing_sim import parameters
from dewing_sim.machine import caches
from dewing_sim.structure.sheet import Sheet
caches.keep('a', lambda draft: draft.write_text('sound'))
print(os.getuid(), caches.folder(), caches.recall('a', lambda path: path.read_text()))
sheet = Sheet.from_parameters(parameters.load('paper').membrane)
print(round(sheet.loss_of_tension_v_squared(1.5) ** 0.5))
"""


@pytest.fixture(scope='module')
def way():
    """Return the words that make a command one of a foreign user."""
    for words in WAYS:
        if shutil.which(words[0]) and not subprocess.run(
                [*words, sys.executable, '-c', 'import numpy'], capture_output=True).returncode:
            return words
    raise AssertionError('not even env runs this Python')


@pytest.fixture
def run(way, tmp_path):
    """Return a function that runs Python as a foreign user, in a folder that is his to write."""
    tmp_path.chmod(0o777)
    for parent in tmp_path.parents:         # pytest's own are for nobody else
        if parent.name.startswith('pytest-'):
            parent.chmod(0o755)

    def run(*words):
        given = {'PATH': os.environ['PATH'], 'PYTHONPATH': str(PROJECT), 'MPLBACKEND': 'Agg',
                 'AMENT_PREFIX_PATH': os.environ['AMENT_PREFIX_PATH'],
                 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}
        if way == ['env']:                  # the own home is not for tests
            given['XDG_CACHE_HOME'] = str(tmp_path / 'cache')
        return subprocess.run([*way, sys.executable, *map(str, words)], env=given, cwd=tmp_path,
                              capture_output=True, text=True)
    return run


def test_nothing_is_kept_and_kernels_are_compiled_anew(run, way):
    done = run('-c', PLACE)
    assert (done.returncode, done.stderr) == (0, '')
    (uid, folder, recalled), (volts,) = map(str.split, done.stdout.splitlines())
    assert int(uid) == (UID if way[0] != 'env' else os.getuid())
    assert volts == '1300'
    if way[0] != 'env':                     # who has an entry in the table of users has a home
        assert (folder, recalled) == ('None', 'None')


def test_commands_read_compute_and_write_where_they_may(run, tmp_path):
    done = run('-m', 'dewing_cli', 'bag', 'info', PROJECT / 'test/reference/flight_0.1.mcap')
    assert (done.returncode, done.stderr) == (0, '') and 'plant ' in done.stdout
    done = run('-m', 'dewing_cli', 'bag', 'plot', PROJECT / 'test/reference/flight_0.1.mcap',
               '--out', 'flight.png')
    assert done.returncode == 0, done.stderr
    assert 'Traceback' not in done.stderr and (tmp_path / 'flight.png').stat().st_size > 1000


@pytest.mark.skipif(find_spec('rclpy') is None, reason='there is no ROS')
def test_a_node_logs_where_it_may(run, tmp_path):
    reduced.save(tmp_path / 'model.npz', first_mode())
    main = 'from dewing_sim.ros.node import main; import sys; sys.exit(main())'
    settings = {'run.plant': 'reduced', 'model': 'model.npz', 'run.mode': 'free',
                'run.subscribers': 0, 'run.duration': 0.001}
    given = [word for name, value in settings.items() for word in ('-p', f'{name}:={value}')]
    done = run('-c', main, '--ros-args', *given)
    assert done.returncode == 0 and 'Traceback' not in done.stderr, done.stderr

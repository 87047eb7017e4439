# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What SIGKILL at any moment leaves behind: everything that had been kept, readable."""

import os
import random
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from started import started, wait_until

from dewing_cli import main as cli
from dewing_sim.machine.signals import kill
from dewing_sim.records.history import History

MOMENTS = random.Random(14)         # s after there is something to keep
SMALL = ['--set', 'numerics.grid=fast', '--set', 'numerics.trim_time=0.1', '--quiet']
OFTEN = """
import sys
from dewing_sim.records import partial
partial.Partial.__init__.__defaults__ = (0.05,)
from dewing_cli.main import main
sys.exit(main(sys.argv[1:]))
"""

TINY = """
import sys
from dewing_cli.main import main
from dewing_cli.paper import plan
from paper_runs import TINY
plan.QUICK = TINY
sys.exit(main(sys.argv[1:]))
"""

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures('own_folder')]


def killed(pattern, *arguments, code=OFTEN):
    """Kill the command at a random moment after a file of ``pattern`` has appeared."""
    with started([sys.executable, '-c', code, *arguments],
                 env=os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}) as process:
        wait_until(lambda: list(Path().glob(pattern)), process)
        time.sleep(MOMENTS.uniform(0.0, 0.5))
        kill(process)


def test_a_killed_simulation_leaves_what_it_had_and_is_not_written_over(capsys):
    arguments = ['simulate', *SMALL, '--duration', '50.0', '--out', 'run.npz']
    killed('run.npz.partial', *arguments)
    run = History.load('run.npz.partial')
    assert len(run) > 0 and np.all(np.diff(run.time) > 0.0) and not Path('run.npz').exists()
    assert cli.main(arguments) == 2
    assert 'run.npz.partial exists; --force writes over it' in capsys.readouterr().err
    short = ['simulate', *SMALL, '--duration', '0.002', '--out', 'run.npz', '--force']
    assert cli.main(short) == 0
    assert Path('run.npz').exists() and not Path('run.npz.partial').exists()


def test_a_killed_sweep_leaves_its_points(capsys):
    import xarray
    points = ['--vary', 'numerics.trim_time=0.1,40.0', '--jobs', '1', '--out', 'sweep.nc']
    killed('sweep.nc', 'sweep', *SMALL, '--duration', '0.003', *points)
    assert xarray.load_dataset('sweep.nc').status.values.tolist()[0] == 1


def test_a_killed_paper_leaves_its_finished_runs():
    killed('out/runs/*.npz', 'paper', '--quick', '--quiet', '--jobs', '1', '--out', 'out',
           code=TINY)
    kept = list(Path('out/runs').glob('[!.]*.npz'))
    assert kept
    for path in kept:
        with np.load(path, allow_pickle=False) as file:
            assert all(file[name] is not None for name in file.files)
    assert not Path('out/report.html').exists()

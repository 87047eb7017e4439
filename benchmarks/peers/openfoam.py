# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The plate in OpenFOAM: icoFoam about the rigid one, pimpleFoam about the bending one."""

import os
import shutil
import subprocess
from pathlib import Path
from time import perf_counter

import numpy as np
from openfoam_case import write_case

HOME = Path('/usr/share/openfoam')
HINT = 'OpenFOAM is not installed; on Debian: apt-get install openfoam'


class Failed(RuntimeError):
    """A program of OpenFOAM stopped with an error."""


def available() -> bool:
    """Return whether the solvers are on the path."""
    return all(shutil.which(name) for name in ('blockMesh', 'icoFoam', 'pimpleFoam'))


def run(folder: Path, moving: bool, dt: float, steps: int) -> dict[str, np.ndarray]:
    """March the plate by ``steps`` of ``dt`` (c/U) in ``folder``.

    Returns, all of shape (steps,): time and Cl, and the wall and CPU seconds at the end of steps.
    """
    write_case(folder, moving, dt, steps)
    _run(['blockMesh'], folder)
    clocks = _run(['pimpleFoam' if moving else 'icoFoam'], folder)
    table = next(folder.glob('postProcessing/lift/*/coefficient*.dat'))
    names = next(line for line in table.read_text(encoding='utf-8').splitlines()
                 if line.startswith('# Time')).lstrip('# ').split()
    rows = np.loadtxt(table)
    return {'time': rows[:, 0], 'cl': rows[:, names.index('Cl')],
            'wall': clocks[:, 0], 'cpu': clocks[:, 1]}


def _run(command: list[str], folder: Path) -> np.ndarray:
    """Run a command; return wall and CPU seconds (steps, 2) at its reports of execution time."""
    environment = os.environ | ({} if 'WM_PROJECT_DIR' in os.environ
                                else {'WM_PROJECT_DIR': str(HOME)})
    clocks = []
    with (folder / f'{command[0]}.log').open('w', encoding='utf-8') as log, subprocess.Popen(
            command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT) as process:
        for line in process.stdout:
            log.write(line)
            if line.startswith('ExecutionTime'):
                clocks.append((perf_counter(), float(line.split()[2])))
    if process.returncode:
        raise Failed(f'{" ".join(command)} failed: exit status {process.returncode}')
    return np.array(clocks)

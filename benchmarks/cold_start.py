# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Time to the first result of a process: warm, with prepared kernels only, and with nothing.

Every command makes one or a few steps. `prepared` stands for a fresh machine with the wheel of
`make kernels-wheel`: no home, no cache, kernels compiled for every processor with AVX2. `nothing`
compiles what the command needs. The first line is the floor: what numba and scipy take to import.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from dewing_sim import prepare
from dewing_sim.files import check_free
from dewing_sim.machine import jobs, prepared

DEWING = [sys.executable, '-m', 'dewing_cli']
SHORT = ['--set', 'numerics.trim_time=0.3', '--quiet']
COMMANDS = {
    'import numba, scipy.linalg': [sys.executable, '-c', 'import numba, scipy.linalg'],
    'dewing --help': [*DEWING, '--help'],
    'dewing plate': [*DEWING, 'plate', '--alpha', '4', '--duration', '0.02', '--quiet'],
    'dewing simulate': [*DEWING, 'simulate', '--duration', '1e-4', *SHORT],
    'dewing simulate --case realtime': [
        *DEWING, 'simulate', '--case', 'realtime', '--duration', '5e-4', *SHORT],
}
COMPILING = [name for name in COMMANDS if name.startswith(('dewing plate', 'dewing sim'))]


def seconds(command: list[str], home: Path, kernels: Path | None) -> float:
    """Run a command as a user whose caches are in ``home``; return the seconds that it took."""
    environment = os.environ | {
        'HOME': str(home), 'XDG_CACHE_HOME': str(home), 'NUMBA_CACHE_DIR': str(home / 'numba'),
        prepared.VARIABLE: str(kernels or '')}
    began = perf_counter()
    made = subprocess.run(command, env=environment, capture_output=True, text=True)
    if made.returncode:
        raise SystemExit(f"{' '.join(command)}: {made.stderr}")
    return perf_counter() - began


def measure(kernels: Path, folder: Path, repeats: int) -> dict[str, dict[str, float]]:
    """Return the seconds of each command by what is there, for warm ones the least of some."""
    found = {}
    for number, (name, command) in enumerate(COMMANDS.items()):
        row = {}
        home = folder / f'home{number}'
        if name in COMPILING:
            row['nothing'] = seconds(command, home, None)
            row['prepared'] = seconds(command, folder / f'fresh{number}', kernels)
        row['warm'] = min(seconds(command, home, None) for _ in range(repeats))
        found[name] = row
    return found


def main() -> None:
    """Measure, print and write what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--kernels', type=Path, metavar='FOLDER', help='prepared kernels of '
                        'python -m dewing_sim.prepare --into FOLDER (default: compiled now)')
    parser.add_argument('--repeats', type=int, default=5, help='of warm commands (default: 5)')
    parser.add_argument('--json', metavar='FILE', help='write the seconds as JSON')
    parser.add_argument('--force', action='store_true', help='write over an existing file')
    arguments = parser.parse_args()
    if arguments.json:
        check_free(arguments.json, arguments.force)
    with tempfile.TemporaryDirectory(prefix='dewing-cold-') as folder:
        kernels = arguments.kernels
        if kernels is None:
            kernels = Path(folder) / 'kernels'
            began = perf_counter()
            prepare.prepare_baseline(jobs.cores(), kernels)
            print(f'compiled beforehand in {perf_counter() - began:.1f} s '
                  f'on {jobs.cores()} cores')
        found = measure(kernels, Path(folder), arguments.repeats)
    print(f"{'':34}{'warm':>10}{'prepared':>10}{'nothing':>10}  s")
    for name, row in found.items():
        print(f'{name:34}' + ''.join(f'{row[key]:10.2f}' if key in row else f"{'':10}"
                                     for key in ('warm', 'prepared', 'nothing')))
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(found, indent=2) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()

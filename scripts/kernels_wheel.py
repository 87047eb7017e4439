# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Pack compiled kernels as a wheel, ``dewing-kernels``, for machines that shall not compile.

Usage: ``python kernels_wheel.py FOLDER``. The wheel is for this version of Python, numba and
llvmlite and for every processor with AVX2; elsewhere what it holds is left alone and compiled.
"""

import base64
import hashlib
import sys
import tempfile
import zipfile
from importlib.metadata import version
from pathlib import Path

from dewing_sim import prepare
from dewing_sim.machine import jobs, prepared

NOTE = '"""Compiled kernels of dewing, found by dewing_sim.machine.prepared."""\n'


def tag() -> str:
    """Return for which Python and system the wheel is."""
    python = f'cp{sys.version_info[0]}{sys.version_info[1]}'
    return f'{python}-{python}-linux_x86_64'


def information() -> dict[str, str]:
    """Return the files of the wheel's ``dist-info``."""
    needs = ''.join(f'Requires-Dist: {name}=={version(name)}\n'
                    for name in ('dewing', 'llvmlite', 'numba'))
    python = '.'.join(map(str, sys.version_info[:2]))
    return {
        'METADATA': 'Metadata-Version: 2.1\nName: dewing-kernels\n'
                    f"Version: {version('dewing')}\nSummary: Compiled kernels of dewing\n"
                    f'License: Apache-2.0\nRequires-Python: =={python}.*\n{needs}',
        'WHEEL': 'Wheel-Version: 1.0\nGenerator: dewing\nRoot-Is-Purelib: false\n'
                 f'Tag: {tag()}\n'}


def pack(kernels: Path, into: Path) -> Path:
    """Write the wheel of a folder that `prepare.prepare_baseline` has made; return its path."""
    release = version('dewing')
    found = {f'{prepared.PACKAGE}/{path.relative_to(kernels)}': path.read_bytes()
             for path in sorted(kernels.rglob('*')) if path.is_file()}
    found[f'{prepared.PACKAGE}/__init__.py'] = NOTE.encode()
    folder = f'dewing_kernels-{release}.dist-info'
    found |= {f'{folder}/{name}': text.encode() for name, text in information().items()}
    record = [f'{name},sha256={_digest(data)},{len(data)}' for name, data in found.items()]
    found[f'{folder}/RECORD'] = '\n'.join([*record, f'{folder}/RECORD,,', '']).encode()
    into.mkdir(parents=True, exist_ok=True)
    wheel = into / f'dewing_kernels-{release}-{tag()}.whl'
    with zipfile.ZipFile(wheel, 'w', zipfile.ZIP_DEFLATED) as file:
        for name, data in found.items():
            file.writestr(name, data)
    return wheel


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip('=')


def main() -> None:
    """Compile and pack."""
    with tempfile.TemporaryDirectory() as folder:
        kernels = Path(folder) / prepared.PACKAGE
        prepare.prepare_baseline(jobs.cores(), kernels)
        print(pack(kernels, Path(sys.argv[1])))


if __name__ == '__main__':
    main()

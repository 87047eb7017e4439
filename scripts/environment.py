# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Make the virtual environment of ``make venv``; do nothing when it is current.

Usage: ``python3 environment.py FOLDER [REQUIREMENTS]``. Standard library only. ROS comes from a
sourced system ROS if there is one, else from wheels where they exist; everything offline works
without it. With a file of requirements the environment holds these only, as for ``make docs``.
"""

import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
INGREDIENTS = ('setup.py', 'setup.cfg', 'pyproject.toml', 'package.xml', 'scripts/environment.py')
EXECUTABLES = ('simulator', 'controller', 'sysid', 'recorder', 'loop')
SHARED = ('config', 'launch')           # folders of files that ROS looks for
REASONS = {
    'system': 'ROS: the sourced system ROS is used, since AMENT_PREFIX_PATH is set and this '
              'Python imports rclpy; the ROS wheels are left out.',
    'wheels': 'ROS: no usable system ROS is sourced, so the ros-jazzy wheels are installed.',
    'none': 'ROS: wheels exist only for x86_64 Linux with Python 3.10 to 3.13, so the nodes and '
            'the demo need a sourced system ROS or a container; every offline command works.',
    'tools': 'ROS: left out, not needed here.',
}


def ros_source() -> str:
    """Return where ROS comes from: 'system', 'wheels' or 'none'."""
    if os.environ.get('AMENT_PREFIX_PATH') and _runs(sys.executable, 'import rclpy'):
        return 'system'
    has_wheels = (sys.platform == 'linux' and platform.machine() == 'x86_64'
                  and (3, 10) <= sys.version_info[:2] <= (3, 13))
    return 'wheels' if has_wheels else 'none'


def recipe(folder: Path, source: str, requirements: Path | None) -> str:
    """Return what the environment depends on, as the text of its stamp."""
    digest = hashlib.sha256()
    ingredients = [requirements] if requirements else [PROJECT / name for name in INGREDIENTS]
    for path in ingredients:
        digest.update(path.read_bytes())
    if not requirements:
        digest.update('\n'.join(shared_files()).encode())
    version = '.'.join(map(str, sys.version_info[:2]))
    return f'{digest.hexdigest()}\nPython {version}\nROS {source}\n{folder}\n{PROJECT}\n'


def shared_files() -> list[str]:
    """Return the files that are to stand in the share folder, relative to the project."""
    return sorted(str(path.relative_to(PROJECT)) for name in SHARED
                  for path in (PROJECT / name).iterdir() if path.is_file())


def create(folder: Path, source: str) -> None:
    """Create ``folder`` unless it already is an environment of this Python and ROS source."""
    python = folder / 'bin' / 'python'
    version = f'assert sys.version_info[:2] == {sys.version_info[:2]}'
    prefix = f'assert os.path.realpath(sys.prefix) == {str(folder)!r}'
    settings = folder / 'pyvenv.cfg'
    wanted = 'system-site-packages = ' + ('true' if source == 'system' else 'false')
    if folder.exists():
        if (settings.is_file() and wanted in settings.read_text()
                and _runs(str(python), f'import os, sys, pip; {version}; {prefix}')):
            print(f'Updating {folder.name}.')
            return
        if not settings.is_file():
            sys.exit(f'{folder} is in the way: it is not a virtual environment.')
        print(f'Making {folder.name} anew: it belongs to another Python, ROS or place.')
        shutil.rmtree(folder)
    option = ['--system-site-packages'] if source == 'system' else []
    subprocess.run([sys.executable, '-m', 'venv', *option, str(folder)], check=True)


def install(folder: Path, source: str, requirements: Path | None) -> None:
    """Install the project, editable, with its test tools and, if ``source`` is wheels, ROS.

    With ``requirements`` install what they name instead.
    """
    extras = 'ros,test,lint' if source == 'wheels' else 'test,lint'
    packages = (['--requirement', str(requirements)] if requirements
                else ['--editable', f'{PROJECT}[{extras}]'])
    command = [str(folder / 'bin' / 'python'), '-m', 'pip', 'install', '--progress-bar', 'off',
               '--disable-pip-version-check', *packages]
    old_numpy = 'import numpy; assert numpy.__version__ < "2"'
    if source == 'system' and _runs(sys.executable, old_numpy):
        command.append('numpy<2')       # the messages of this ROS are compiled against NumPy 1
    log = folder / 'install.log'
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, errors='replace')
    with open(log, 'w') as file:
        _show_progress(process.stdout, file)
    if process.wait():
        tail = [line for line in log.read_text().splitlines() if 'error' in line.lower()]
        sys.exit('\n'.join(['pip could not install the packages:', *tail[-5:], f'See {log}']))


def _show_progress(lines, file) -> None:
    """Copy pip's output to ``file`` and show one line that counts the packages."""
    packages = 0
    live = sys.stdout.isatty()
    for line in lines:
        file.write(line)
        found = re.match(r'\s*(Collecting|Installing collected packages)\s*(\S*)', line)
        if not found:
            continue
        packages += found[1] == 'Collecting'
        text = (f'  collecting package {packages}: {found[2]}' if found[1] == 'Collecting'
                else f'  installing {line.count(",") + 1} packages')
        if live:
            print(f'\r{text[:70]:70}', end='', flush=True)
        elif found[1] != 'Collecting' or packages % 25 == 1:
            print(text, flush=True)
    if live:
        print('\r' + ' ' * 70, end='\r')


def add_to_ament_index(folder: Path) -> None:
    """Put marker, share and executables where ``ros2 run`` looks, which an editable install omits.

    The executables are links to the console scripts, which name this environment's Python. Every
    file is a link of its own: ``ros2 launch`` does not look into a folder that is one.
    """
    marker = folder / 'share' / 'ament_index' / 'resource_index' / 'packages' / 'dewing'
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.touch()
    share = folder / 'share' / 'dewing'
    for name in SHARED:
        if (share / name).is_symlink():         # as older versions had it
            (share / name).unlink()
        shutil.rmtree(share / name, ignore_errors=True)
    links = {share / name: PROJECT / name for name in ('package.xml', *shared_files())}
    links |= {folder / 'lib' / 'dewing' / name: Path('..', '..', 'bin', f'dewing_{name}')
              for name in EXECUTABLES}
    for link, target in links.items():
        link.parent.mkdir(parents=True, exist_ok=True)
        link.unlink(missing_ok=True)
        link.symlink_to(target)


def compile_kernels(folder: Path) -> None:
    """Compile what most runs need, on all cores; without it each is compiled at its first use."""
    print('Compiling the solvers, one on each core.', flush=True)
    made = subprocess.run([str(folder / 'bin' / 'python'), '-m', 'dewing_sim.prepare'],
                          cwd=PROJECT)
    if made.returncode:
        print('The solvers could not be compiled now; their first use will tell why.')


def _runs(python: str, code: str) -> bool:
    """Whether ``python`` runs ``code``."""
    try:
        return not subprocess.run([python, '-c', code], capture_output=True).returncode
    except OSError:
        return False


def main() -> None:
    """Bring the environment named on the command line up to date."""
    folder = Path(sys.argv[1]).resolve()
    requirements = Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    source = 'tools' if requirements else ros_source()
    stamp = folder / 'dewing.stamp'
    wanted = recipe(folder, source, requirements)
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    started = time.monotonic()
    print(f'Python: {sys.executable} ({platform.python_version()}).')
    print(REASONS[source])
    if source in ('wheels', 'none') and os.environ.get('AMENT_PREFIX_PATH'):
        print('AMENT_PREFIX_PATH is set, but this Python cannot import the rclpy of that ROS: '
              'work in a shell without it, since two ROS in one process do not agree.')
    sys.stdout.flush()
    create(folder, source)
    stamp.unlink(missing_ok=True)
    install(folder, source, requirements)
    if not requirements:
        add_to_ament_index(folder)
    if source in ('system', 'wheels') and not _runs(str(folder / 'bin' / 'python'),
                                                    'import rclpy'):
        sys.exit('ROS is installed but rclpy cannot be imported: '
                 f'try {folder}/bin/python -c "import rclpy".')
    if not requirements:
        compile_kernels(folder)
    stamp.write_text(wanted)
    print(f'{folder.name} is ready after {time.monotonic() - started:.0f} s.')


if __name__ == '__main__':
    main()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that README.md, CONTRIBUTING.md and docs/ show, and where each is executed.

``python scripts/documented_commands.py`` (``make long``) executes the long ones, an hour or more.
``test/project/test_documents.py`` executes all others, shortened, and the Python, and fails
for a command that nobody executes.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

PROJECT = Path(__file__).resolve().parents[1]
PAGES = [PROJECT / 'README.md', PROJECT / 'CONTRIBUTING.md',
         *sorted((PROJECT / 'docs').glob('**/*.md'))]
FENCE = re.compile(r'^( *)```(\w*)\n(.*?)^\1```$', re.M | re.S)
PLACEHOLDER = re.compile(r'\b(COMMAND|DEG|FILE|FOLDER|KEY|KIND|NAME|STATE)\b|\[')

# What the tests execute, with these options added: a later option replaces an earlier one.
SHORT = {
    'simulate': '--grid fast --set numerics.trim_time=0.1 --duration 0.0005 --skip 0.0',
    'plate': '--grid fast --duration 0.05',
    'sweep': '--grid fast --set numerics.trim_time=0.1 --set membrane.elements=16'
             ' --duration 0.0005 --skip 0.0',
    'material': '--set membrane.elements=8 --out figures',
    'identify': '--grid fast --set numerics.trim_time=0.1 --set membrane.elements=16'
                ' --set experiment.record=0.4 --set fresh.record=0.2 --window 0.2 --order 4'
                ' --jobs 1',
    'bag': '', 'plot': '',
}
# Blocks that `make long` executes, by their first line.
LONG = (
    'make demo', 'python3 -m venv ~/dewing-env', 'python examples/closed_loop.py',
    "make test PYTEST_OPTIONS='test/sim/ros/test_examples.py'",
    'dewing material --case paper --out docs/images/material/paper --force',
    'dewing paper --out out/paper',
    'dewing modes --engine conformal --grid realtime --dt 5.0e-4 --set numerics.trim_time=60.0'
    ' --count 4 --out modes --force',
    'python -m dewing_sim.prepare', 'dewing_simulator --ros-args -r __ns:=/wing1 &',
    'dewing_controller &', 'dask scheduler --port 8786 &',
)
# Commands within the text that `make long` executes, each in a folder of its own.
LONG_IN_TEXT = (
    'make help', 'make venv', 'make docs', 'make bench', 'make bench-peers', 'make test',
    "make test PYTEST_OPTIONS='-m \"not slow\"'",
    'python scripts/gallery.py', 'python scripts/parameter_table.py',
    'python scripts/ros_reference.py', 'python scripts/outputs_table.py',
    'python benchmarks/roundtrip.py', 'python benchmarks/soak.py',
    'python benchmarks/soak_realtime.py',
    'python benchmarks/cold_start.py', 'make kernels-wheel',
    'dewing modes --set numerics.trim_time=60.0',
    'dewing plate --alpha 4', 'dewing simulate --case paper', 'dewing verify --quick',
    'dewing verify --out docs --force', 'dewing material --coupled',
    'dewing bench --presets standard --set membrane.element=solid --set membrane.elements=400',
    'dewing bench --engine conformal', 'dewing bench --graph',
    'dewing tune --kind lqg', 'dewing tune --noise-gain 40',
    'dewing compare --duration 0.4', 'dewing simulate --case realtime --duration 1',
    'dewing tune --case realtime --delay 1 --generations 40',
    'dewing compare --case realtime --settings realtime'
    ' --scenarios late0,late1,late2,jitter,alpha8_late1 --duration 0.8',
    'dewing compare --scenarios target_097 --controllers pid_tuned,lqg,mpc --duration 1.0'
    ' --jobs 1',
)
# Commands within the text that are not executed as they stand, and why.
ELSEWHERE = {
    'make long': 'executes all others',
    'make links': 'needs the network',
    'dewing plot last.npz --film 0.04 --out shedding.gif':
        'test/cli/test_plot.py does, with fewer frames',
    'dewing identify --from run.mcap':
        'test/sysid/test_sysid_node.py does, with a recorded campaign',
}
# First lines of blocks that are executed elsewhere, and where.
BLOCKS_ELSEWHERE = {
    'dewing_controller & dewing_recorder --ros-args -p output:=answers.mcap &':
        'test/control/test_replay.py does, with a player of its own',
    'dewing_sysid --ros-args -p begin:=on_replay -p output:=played.npz &':
        'test/control/test_sysid_replay.py does, with a player of its own',
}
# Blocks that need a system ROS; `make long` executes them where there is one.
SYSTEM_ROS = ('source /opt/ros/jazzy/setup.bash', 'ros2 run dewing', 'ros2 launch dewing')
# Blocks for nodes that run; test/project/test_ros2_commands.py executes them where `ros2` is.
BESIDE_NODES = ('ros2 topic',)


class Block(NamedTuple):
    """A fenced block of a page: its language and its lines.

    The lines are without their indentation and the path of the environment.
    """

    page: str
    language: str
    lines: tuple[str, ...]

    @property
    def text(self) -> str:
        """The block as a script."""
        return '\n'.join(self.lines) + '\n'

    @property
    def where(self) -> str:
        """Who executes a shell block: 'test', 'long', 'ros', 'nodes', 'elsewhere', or '': none."""
        if self.lines[0] in LONG:
            return 'long'
        if self.lines[0] in BLOCKS_ELSEWHERE:
            return 'elsewhere'
        if self.lines[0].startswith(SYSTEM_ROS):
            return 'ros'
        if all(line.startswith(BESIDE_NODES) for line in self.lines):
            return 'nodes'
        known = all(words(line)[:1] == ['dewing'] and words(line)[1] in SHORT
                    for line in self.lines)
        return 'test' if known else ''


def blocks(page: Path) -> list[Block]:
    """Return the fenced blocks of a page, in order."""
    name = str(page.relative_to(PROJECT))
    found = FENCE.findall(page.read_text(encoding='utf-8'))
    return [Block(name, language, tuple(
        line[len(indent):].replace('.venv/bin/', '') for line in body.splitlines()))
        for indent, language, body in found]


def words(line: str) -> list[str]:
    """Return the words of a command, without its comment."""
    return shlex.split(line, comments=True)


def commands_in_text(page: Path) -> list[str]:
    """Return the complete commands in back quotes: with arguments, without placeholders."""
    prose = FENCE.sub('', page.read_text(encoding='utf-8'))
    quoted = (' '.join(code.split()) for code in re.findall(r'`([^`]+)`', prose))
    pattern = re.compile(r'(make|dewing [a-z]+|python (?:scripts|benchmarks)/\S+) ?\S')
    return [code for code in quoted
            if pattern.match(code) and not PLACEHOLDER.search(code)
            and not re.fullmatch(r'dewing [a-z]+', code)]


def long_scripts() -> Iterator[tuple[str, str]]:
    """Yield the page and the text of everything `make long` executes here."""
    where = ('long', 'ros') if shutil.which('ros2') else ('long',)
    for page in PAGES:
        for block in blocks(page):
            if block.language == 'sh' and block.where in where:
                yield block.page, block.text
    for command in LONG_IN_TEXT:
        yield 'text', f'{command}\n'


def execute(script: str, home: str) -> bool:
    """Execute a script with bash, in the project if it needs its files, else in a new folder."""
    environment = os.environ | {
        'PATH': f'{Path(sys.executable).parent}:{os.environ["PATH"]}', 'HOME': home,
        'XDG_CACHE_HOME': f'{home}/cache', 'VENV': sys.prefix}
    needs_files = re.search(r"^make |^python (scripts|benchmarks)/|'\.\[", script, re.M)
    folder = PROJECT if needs_files else tempfile.mkdtemp(dir=home)
    done = subprocess.run(['bash', '-ec', script + CLEANUP], cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL)
    return done.returncode == 0


CLEANUP = 'for job in $(jobs -p); do kill $job || true; done; wait || true\n'


def main() -> int:
    """Execute every long script; return 1 if one failed."""
    failed = []
    with tempfile.TemporaryDirectory() as home:
        for page, script in long_scripts():
            began = time.monotonic()
            print(f'\n{page}:\n{script}', flush=True)
            if not execute(script, home):
                failed.append((page, script))
            print(f'{time.monotonic() - began:.0f} s', flush=True)
    for page, script in failed:
        print(f'failed: {page}: {script}')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())

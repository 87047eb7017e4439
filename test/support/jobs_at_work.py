# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs for the tests of the runner; the processes import them."""

import os
import signal
import time
from pathlib import Path

from dewing_sim.errors import Slack


def double(value):
    return 2 * value


def environment():
    return os.environ['OPENBLAS_NUM_THREADS'], os.getpid()


def slack():
    raise Slack('at 1300 V')


def divide():
    return 1 / 0


def unsendable():
    return lambda: None


def kill_itself():
    os.kill(os.getpid(), signal.SIGKILL)


def kill_itself_once(path):
    if not Path(path).exists():
        Path(path).write_text('once')
        kill_itself()
    return 'survived'


def total(tick, inputs):
    tick(0.5)
    return 1 + sum(inputs.values())


def note(path, value):
    with open(path, 'a') as file:
        file.write(f'{value}\n')


def note_linked(path, value, tick, inputs):
    note(path, value)


def half_way(path, tick, inputs):
    """Report a half, then wait until there is a file ``path``."""
    tick(0.5)
    while not Path(path).exists():
        time.sleep(0.02)


def endless(path):
    Path(path).write_text(str(os.getpid()))
    while True:
        time.sleep(0.05)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Signals that ask for an end, and ends of processes that do not want to."""

import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
from started import started

from dewing_sim.machine.signals import ENDS, Interrupted, Stop, end, kill, status_of, undisturbed

PATIENCE = 60.0
WAIT = 'print("ready", flush=True); import time; time.sleep(1000)'
# A shell that starts tests in the background lets them, and their children, ignore SIGINT.
POLITE = f'import signal; signal.signal(signal.SIGINT, signal.SIG_DFL)\n{WAIT}'
DEAF = ('import signal\nfor each in signal.SIGINT, signal.SIGTERM:\n'
        f'    signal.signal(each, lambda *_: None)\n{WAIT}')


@contextmanager
def ready(code):
    with started([sys.executable, '-c', code], stdout=subprocess.PIPE,
                 stderr=subprocess.DEVNULL) as process:
        assert process.stdout.readline() == b'ready\n'
        yield process


@pytest.mark.parametrize('number', ENDS)
def test_every_signal_raises_at_once_and_names_its_status(number):
    before = [signal.getsignal(each) for each in ENDS]
    with pytest.raises(Interrupted) as caught, Stop():
        signal.raise_signal(number)
    assert status_of(caught.value) == 128 + number
    assert [signal.getsignal(each) for each in ENDS] == before
    assert status_of(KeyboardInterrupt()) == 130


@pytest.mark.parametrize('number', ENDS)
def test_an_orderly_end_notes_the_first_and_only_ctrl_c_twice_is_impatience(number):
    with pytest.raises(Interrupted), Stop(orderly=True) as stop:
        signal.raise_signal(number)
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGHUP)
        assert stop.asked and stop.number == number
        signal.raise_signal(signal.SIGINT)


def test_what_was_asked_of_an_inner_one_is_not_asked_again_of_the_outer_one():
    with Stop() as outer:
        with Stop(orderly=True):
            signal.raise_signal(signal.SIGHUP)
        assert outer.number == signal.SIGHUP
        signal.raise_signal(signal.SIGTERM)         # as a shell does while results are saved
        with pytest.raises(Interrupted):
            signal.raise_signal(signal.SIGINT)


def test_a_save_is_not_disturbed():
    saved = []
    with pytest.raises(Interrupted), undisturbed():
        signal.raise_signal(signal.SIGTERM)
        saved.append(True)
    assert saved


def test_a_hangup_that_nohup_ignores_stays_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Stop() as stop:
            signal.raise_signal(signal.SIGHUP)
        assert not stop.asked and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_stopped_process_is_continued_and_asked():
    with ready(POLITE) as process:
        process.send_signal(signal.SIGSTOP)
        assert end(process, PATIENCE) == -signal.SIGINT
        assert end(process, PATIENCE) == -signal.SIGINT     # once more changes nothing


def test_a_deaf_process_is_killed_stopped_or_not():
    with ready(DEAF) as one, ready(DEAF) as other:
        assert end(one, 0.2) == -signal.SIGKILL
        other.send_signal(signal.SIGSTOP)
        assert kill(other) == -signal.SIGKILL

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The demo on a coarse wing: files, metrics, refusals, interrupts."""

import json
import os
import signal
import subprocess
import sys
import warnings

import numpy as np
import pytest
from started import PATIENCE, started, wait_until

from dewing_cli.demo import results as demo_results
from dewing_cli.demo.results import Run
from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.identity import Identity
from dewing_sim.records import bag

COARSE = ('--grid', 'fast', '--set', 'numerics.trim_time=2.0', '--set', 'membrane.elements=32')


def make_run(camber, v_squared=None):
    """Return a run of 0.4 s at 1 ms with relative mean ``camber`` (401,)."""
    identity = Identity('wing', 1.0e-3, 2.0e-5, 3.0e-5, 1.69e6, 1250.0**2, {}, '')
    series = {'time': np.arange(401) * 1.0e-3, 'camber_mean': 2.0e-5 * (1.0 + camber),
              'v_squared': np.zeros(401) if v_squared is None else v_squared}
    status = {'steps': '400', 'stale': '3', 'resent': '2', 'ms_per_step': '1.5',
              'overhead_ms_per_step': '0.5'}
    return Run(identity, series, status)


def test_metrics_are_those_of_the_last_whole_periods():
    time = np.arange(401) * 1.0e-3
    camber = np.where(time > 0.2 + 1.0e-9, -0.05 * (1.0 - np.cos(20.0 * np.pi * time)), 9.0)
    v_squared = np.where(time < 0.1, 0.0, 1.0e4 * (2.0 + np.cos(20.0 * np.pi * time)))
    runs = {'open_loop': make_run(camber), 'closed_loop': make_run(camber, v_squared)}
    metrics = demo_results.metrics(runs, parameters.load('paper'), 1250.0, 0.4)
    assert metrics['open_loop']['camber_mean'] == pytest.approx(-0.05, abs=1.0e-12)
    assert metrics['open_loop']['camber_amplitude'] == pytest.approx(0.05, rel=1.0e-6)
    closed = metrics['closed_loop']
    assert (closed['v_min'], closed['v_max']) == pytest.approx((100.0, 300.0**0.5 * 10.0))
    assert closed['saturation_share'] == pytest.approx(99 / 400)
    assert metrics['steps'] == 800 and metrics['overhead_ms_per_step'] == 0.5
    assert metrics['steps_lost'] == 2           # one stale answer a run beyond the repetitions


def test_missing_measurements_count_as_lost():
    run = make_run(np.zeros(401))
    gap = Run(run.identity, {name: values[:-7] for name, values in run.series.items()},
              run.status)
    assert run.lost(0.4) == 0 and gap.lost(0.4) == 7


def start(folder, *options):
    env = os.environ | {'XDG_CACHE_HOME': str(folder / 'cache')}
    return started(
        [sys.executable, '-m', 'dewing_cli', 'demo', '--out', str(folder / 'demo'), *COARSE,
         *options], env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def assert_as_offline(folder, steps):
    """Check the wing's closed loop over DDS bit for bit against the loop in this process."""
    built = build_wing(parameters.load(folder / 'case.yaml'))
    law = controller(parameters.load('controller', ControllerSettings), built.identity)
    recorded = bag.series(folder / 'closed_loop.mcap', demo_results.MEASUREMENT)
    for step, (_, outputs) in enumerate(closed_loop(built.plant, built.rest, law, steps), 1):
        assert outputs.v_squared == recorded['v_squared'][step]
        assert outputs.camber_mean == recorded['camber_mean'][step]


@pytest.mark.slow
def test_the_demo_leaves_bags_figure_and_metrics(tmp_path):
    with start(tmp_path, '--duration', '0.02', '--realtime', '0.2',
               '--json', str(tmp_path / 'copy.json')) as process:
        said, complaint = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, complaint
    assert 'mean camber change' in said and 'closed_loop.png' in said
    assert 'real time: 0.2 s of the case realtime in two processes' in said
    metrics = json.loads((tmp_path / 'demo' / 'metrics.json').read_text())
    assert metrics == json.loads((tmp_path / 'copy.json').read_text())
    assert metrics['steps'] == 400 and metrics['steps_lost'] == 0
    assert metrics['closed_loop']['v_min'] >= 0.0
    assert metrics['closed_loop']['camber_mean'] > 0.0 > metrics['open_loop']['camber_mean']
    flown = metrics['realtime']
    assert (flown['case'], flown['steps'], flown['clipped']) == ('realtime', 400, 0)
    assert flown['rtf'] > 0.0 and flown['camber_mean'] == pytest.approx(0.10, abs=0.03)
    assert (tmp_path / 'demo' / 'closed_loop.png').read_bytes().startswith(b'\x89PNG')
    with start(tmp_path) as again:
        complaint = again.communicate(timeout=PATIENCE)[1]
    assert again.returncode == 2 and 'exists; --force writes over it' in complaint
    assert_as_offline(tmp_path / 'demo', 200)


def messages_in(recording):
    """Return how many messages a bag holds that is still being written."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)     # it is not closed yet
        return sum(1 for _ in bag.read(recording))


@pytest.mark.slow
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupted_demo_keeps_what_it_recorded(tmp_path, number):
    recording = tmp_path / 'demo' / 'open_loop.mcap'
    with start(tmp_path, '--duration', '5.0') as process:
        wait_until(lambda: recording.exists() and messages_in(recording) > 100, process)
        process.send_signal(number)
        _, complaint = process.communicate(timeout=PATIENCE)
    assert process.returncode == 128 + number
    assert f'kept {recording} up to 0.' in complaint and complaint.endswith('interrupted\n')
    run = bag.series(recording, demo_results.MEASUREMENT)
    assert np.all(np.isfinite(run['camber_mean'])) and len(run['time']) > 10

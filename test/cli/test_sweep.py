# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Sweeps: points, the file and its resumption, failures, a cluster by its address."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import psutil
import pytest
import xarray
from started import PATIENCE, started, wait_until

from dewing_cli import main as cli
from dewing_cli.sweep import sweep
from dewing_cli.sweep.file import Table, resume
from dewing_cli.sweep.sweep import (
    DONE,
    FAILED,
    LOST,
    METRICS,
    Result,
    Sweep,
    parse_axes,
    run_point,
)
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed

ANGLE, LIMIT = 'flow.angle_of_attack_deg', 'actuation.voltage_limit'
COARSE = {'numerics.grid': 'fast', 'numerics.trim_time': 0.1, 'membrane.elements': 16}
OPTIONS = [text for key, value in COARSE.items() for text in ('--set', f'{key}={value}')]
OPTIONS += ['--duration', '0.003']
VARY = ['--vary', f'{ANGLE}=2.0,4.0', '--vary', f'{LIMIT}=1250.0,1400.0']    # slack at 1300 V


pytestmark = pytest.mark.usefixtures('own_folder')


@pytest.fixture(scope='module')
def cluster():
    """Return the address of a scheduler with one worker in this process."""
    from distributed import LocalCluster
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False,
                      dashboard_address='127.0.0.1:0') as running:
        yield running.scheduler_address


def make(*texts, duration=0.003, **changes):
    base = parameters.load('paper', changes=COARSE | changes)
    return Sweep(base, parse_axes(texts), duration, 0.0)


def filled(*texts, **options):
    """Return a table whose metrics count the points."""
    table = Table(make(*texts, **options))
    for k, point in enumerate(table.sweep.points):
        table.put(point.index, table.sweep.fingerprint(point),
                  Result(DONE, '', {'cl_mean': float(k)}))
    return table


def test_the_points_are_all_combinations_with_the_last_axis_fastest():
    points = make(f'{ANGLE}=2.0,4.0', 'numerics.engine=finite_volume,conformal').points
    assert [point.index for point in points] == [(0, 0), (0, 1), (1, 0), (1, 1)]
    assert [(point.case.flow.angle_of_attack_deg, point.case.numerics.engine)
            for point in points] == [(2.0, 'finite_volume'), (2.0, 'conformal'),
                                     (4.0, 'finite_volume'), (4.0, 'conformal')]


def test_a_fingerprint_depends_on_case_times_and_nothing_else():
    def first(plan):
        return plan.fingerprint(plan.points[0])
    same = first(make(f'{ANGLE}=2.0,4.0'))
    assert first(make(f'{ANGLE}=2.0')) == same
    assert first(make(f'{ANGLE}=2.5')) != same
    assert first(make(f'{ANGLE}=2.0', duration=0.004)) != same
    assert first(make(f'{ANGLE}=2.0', **{'flow.density': 1.3})) != same


def test_a_point_has_the_metrics_of_the_command_simulate():
    assert cli.main(['simulate', *OPTIONS, '--skip', '0', '--quiet', '--json', 'one.json']) == 0
    one = json.loads(Path('one.json').read_text())
    point = make(f'{ANGLE}=4.0').points[0]
    result = run_point(point.case, 0.003, 0.0)
    assert result.status == DONE and result.metrics.keys() <= METRICS.keys()
    shared = result.metrics.keys() & one.keys()
    assert {'cl_mean', 'camber_mean', 'tension'} <= shared
    assert {name: one[name] for name in shared} == {
        name: result.metrics[name] for name in shared}


def test_a_slack_membrane_is_a_result_with_its_reason():
    point = make(f'{LIMIT}=1400.0').points[0]
    result = run_point(point.case, 0.003, 0.0)
    assert result.status == FAILED and result.metrics == {}
    assert 'loses its tension at 1300 V' in result.reason


def test_a_file_gives_back_every_result_and_holds_no_nan():
    table = filled(f'{ANGLE}=2.0,4.0', 'numerics.engine=finite_volume,conformal')
    table.put((1, 1), 'x', Result(FAILED, 'no shape', {}))
    table.values['cl_mean'][1, 1] = np.nan
    table.save('sweep.nc')
    stored = xarray.load_dataset('sweep.nc')
    assert float(stored.cl_mean.sel({ANGLE: 2.0, 'numerics.engine': 'conformal'})) == 1.0
    assert str(stored.reason[1, 1].values) == 'no shape'
    assert stored.camber_mean.attrs['units'] == 'm'
    raw = xarray.load_dataset('sweep.nc', mask_and_scale=False)
    assert all(np.isfinite(raw[name].values).all() for name in METRICS)
    again = resume(table.sweep, 'sweep.nc')
    assert again.result((0, 1)) == table.result((0, 1))
    assert again.result((1, 1)).status == 0             # its inputs were others


def test_a_file_without_later_outputs_gives_back_what_it_has():
    """As those of version 0.1, which knew neither the mean field nor the capacitance."""
    filled(f'{ANGLE}=2.0').save('sweep.nc')
    stored = xarray.load_dataset('sweep.nc')
    stored.drop_vars(['electric_field_mean', 'capacitance_mean']).to_netcdf(
        'sweep.nc', engine='scipy')
    metrics = resume(make(f'{ANGLE}=2.0'), 'sweep.nc').result((0,)).metrics
    assert metrics['cl_mean'] == 0.0 and 'capacitance_mean' not in metrics


def test_a_result_that_is_not_finite_is_refused():
    table = Table(make(f'{ANGLE}=2.0'))
    with pytest.raises(RunFailed, match='cl_mean = nan'):
        table.put((0,), '', Result(DONE, '', {'cl_mean': float('nan')}))


def test_a_sweep_is_extended_by_further_values_in_any_order():
    filled(f'{ANGLE}=2.0,4.0').save('sweep.nc')
    table = resume(make(f'{ANGLE}=4.0,3.0,2.0'), 'sweep.nc')
    assert table.status.tolist() == [DONE, 0, DONE]
    assert [table.result((k,)).metrics.get('cl_mean') for k in range(3)] == [1.0, None, 0.0]


@pytest.mark.parametrize('texts, changes, complaint', [
    ([f'{ANGLE}=2.0'], {}, f'also holds {ANGLE} = 4.0'),
    ([f'{LIMIT}=2.0'], {}, f'varies {ANGLE}, not {LIMIT}'),
    ([f'{ANGLE}=2.0,4.0'], {'flow.density': 1.3}, 'computed with flow.density = 1.225, not 1.3'),
    ([f'{ANGLE}=2.0,4.0'], {'duration': 0.5}, 'computed with duration = 0.003, not 0.5'),
])
def test_what_another_sweep_computed_is_not_lost_without_force(texts, changes, complaint):
    filled(f'{ANGLE}=2.0,4.0').save('sweep.nc')
    with pytest.raises(BadInput, match=complaint):
        resume(make(*texts, **changes), 'sweep.nc')


@pytest.mark.parametrize('status, retry, kept', [
    (FAILED, False, True), (FAILED, True, False), (LOST, False, False)])
def test_failed_points_are_computed_again_on_request_and_lost_ones_always(status, retry, kept):
    table = Table(make(f'{ANGLE}=2.0'))
    table.put((0,), table.sweep.fingerprint(table.sweep.points[0]), Result(status, 'why', {}))
    table.save('sweep.nc')
    assert (resume(table.sweep, 'sweep.nc', retry).status[0] == status) == kept


@pytest.mark.parametrize('content', [b'', b'precious', b'CDF\x02' + bytes(40)])
def test_another_file_is_refused_in_one_sentence(content):
    Path('sweep.nc').write_bytes(content)
    with pytest.raises(BadInput, match='not a file of a sweep'):
        resume(make(f'{ANGLE}=2.0'), 'sweep.nc')


@pytest.mark.parametrize('arguments, complaint', [
    ([], 'arguments are required: --vary'),
    (['--vary', 'flow.speed'], 'is not of the form section.key=a,b,c'),
    (['--vary', 'flow.wind=1.0'], 'flow.wind is not a parameter'),
    (['--vary', f'{ANGLE}=2.0,40.0'], f'{ANGLE} = 40.0 is out of range'),
    (['--vary', f'{ANGLE}=2.0,4'], f'{ANGLE} = 4 is not a floating-point number'),
    (['--vary', f'{ANGLE}=2.0,'], f'{ANGLE} = None is not a floating-point number'),
    (['--vary', f'{ANGLE}=2.0,2.0'], f'{ANGLE}: 2.0 is given twice'),
    (['--vary', f'{ANGLE}=2.0', '--vary', f'{ANGLE}=4.0'], f'{ANGLE} is given twice'),
    (['--vary', f'{ANGLE}=2.0', '--duration', '0'], '--duration 0 s is out of range'),
    (['--vary', f'{ANGLE}=2.0', '--skip', '1.0'], '--skip 1 is out of range'),
    (['--vary', f'{ANGLE}=2.0', '--jobs', '0'], '--jobs 0 is out of range'),
    (['--vary', f'{ANGLE}=2.0', '--jobs', '2', '--scheduler', 'x'], 'not allowed with argument'),
    (['--vary', f'{ANGLE}=2.0', '--scheduler', 'http://x'], 'no scheduler answers'),
    (['--vary', f'{ANGLE}=2.0', '--case', 'papier'], 'is not a shipped configuration'),
    (['--vary', f'{ANGLE}=2.0', '--out', '.'], '. is a folder'),
    (['--vary', 'membrane.elements=' + ','.join(map(str, range(4, 1500))), '--vary',
      'numerics.coupling_iterations=' + ','.join(map(str, range(1, 101)))], '149600 points'),
])
def test_bad_input_ends_with_status_2_and_one_sentence(capsys, arguments, complaint):
    assert cli.main(['sweep', *arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == '' and captured.err.count('\n') == 1
    assert complaint in captured.err


def test_a_sweep_keeps_its_points_and_records_failures(cluster, capsys, monkeypatch):
    command = ['sweep', *OPTIONS, *VARY, '--scheduler', cluster, '--out', 'sweep.nc']
    assert cli.main([*command, '--json', 'sweep.json']) == 0
    report = json.loads(Path('sweep.json').read_text())
    assert report['counts'] == {'missing': 0, 'done': 2, 'failed': 2, 'lost': 0}
    assert [(row[ANGLE], row[LIMIT], row['status']) for row in report['points']] == [
        (2.0, 1250.0, 'done'), (2.0, 1400.0, 'failed'),
        (4.0, 1250.0, 'done'), (4.0, 1400.0, 'failed')]
    assert 'loses its tension' in report['points'][1]['reason']
    assert 0.1 < report['points'][0]['cl_mean'] < report['points'][2]['cl_mean'] < 0.7
    assert '2 done, 2 failed; 0 of them from before; sweep.nc' in capsys.readouterr().out
    # Nothing is computed again: a solver that only raises would be found out.
    monkeypatch.setattr(sweep, '_simulate', lambda *_: 1 / 0)
    assert cli.main(command) == 0
    assert '4 of them from before' in capsys.readouterr().out
    # A point that raises what no solver raises on purpose neither stops nor spoils the others.
    longer = [text.replace('2.0,4.0', '2.0,4.0,3.0') for text in command]
    assert cli.main([*longer, '--quiet']) == 0
    stored = xarray.load_dataset('sweep.nc')
    assert stored.status.values.tolist() == [[DONE, FAILED], [DONE, FAILED], [LOST, LOST]]
    assert str(stored.reason[2, 0].values) == 'ZeroDivisionError: division by zero'


def test_the_status_is_1_if_no_point_succeeds(cluster, capsys):
    command = ['sweep', *OPTIONS, '--vary', f'{LIMIT}=1400.0', '--scheduler', cluster]
    assert cli.main([*command, '--out', 'sweep.nc']) == 1
    assert 'failed: BadInput' in capsys.readouterr().out


def start(*arguments):
    env = os.environ | {'OPENBLAS_NUM_THREADS': '1', 'NUMBA_NUM_THREADS': '1'}
    return started([sys.executable, '-m', 'dewing_cli', 'sweep', *OPTIONS, *arguments], env=env,
                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.slow
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_sweep_of_processes_is_interrupted_and_goes_on_elsewhere(cluster, number):
    command = ['--vary', 'numerics.trim_time=0.1,80.0', '--out', 'sweep.nc']
    with start(*command, '--jobs', '2') as process:
        wait_until(Path('sweep.nc').exists, process)
        os.killpg(process.pid, number)              # as Ctrl-C on a terminal does
        said, complaint = process.communicate(timeout=PATIENCE)
    assert process.returncode == 128 + number, complaint
    assert complaint == 'dewing: interrupted\n' and '1 missing, 1 done' in said
    first = xarray.load_dataset('sweep.nc')
    assert first.status.values.tolist() == [DONE, 0]
    command += ['--scheduler', cluster, '--json', 'sweep.json', '--quiet']
    assert cli.main(['sweep', *OPTIONS, *command]) == 0
    assert json.loads(Path('sweep.json').read_text())['reused'] == 1
    second = xarray.load_dataset('sweep.nc')
    assert second.status.values.tolist() == [DONE, DONE]
    assert float(second.seconds[0]) == float(first.seconds[0])


@pytest.mark.slow
def test_a_worker_that_is_killed_does_not_stop_the_sweep():
    with start('--vary', 'numerics.trim_time=0.1,50.0', '--jobs', '2', '--out',
               'sweep.nc') as process:
        wait_until(Path('sweep.nc').exists, process)
        workers = [child for child in psutil.Process(process.pid).children()
                   if 'spawn_main' in ' '.join(child.cmdline())]
        assert len(workers) == 2
        for worker in workers:
            worker.kill()
        said, complaint = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, complaint
    assert xarray.load_dataset('sweep.nc').status.values.tolist() == [DONE, DONE]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One runner of jobs: order, failures, killed processes, interrupts, progress, clusters."""

import os
import subprocess
import sys
import warnings
from functools import partial
from pathlib import Path

import jobs_at_work as at_work
import psutil
import pytest
from started import started, wait_until

from dewing_sim.errors import BadInput, RunFailed, Slack
from dewing_sim.machine import cluster as on_dask
from dewing_sim.machine import jobs
from dewing_sim.machine.job import Job
from dewing_sim.machine.jobs import Workers

PATIENCE = 120.0        # s


@pytest.fixture(scope='module')
def scheduler():
    """Return the address of a scheduler with one worker in this process."""
    from distributed import LocalCluster
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False,
                      dashboard_address='127.0.0.1:0') as running:
        yield running.scheduler_address


@pytest.fixture(params=['processes', 'cluster'])
def workers(request):
    if request.param == 'processes':
        return Workers(2)
    return Workers(scheduler=request.getfixturevalue('scheduler'))


def outcomes(planned, workers, **options):
    return {name: outcome for batch in jobs.run(planned, workers, **options)
            for name, outcome in batch}


def test_results_come_by_name_and_failures_beside_them(workers):
    planned = {n: Job(partial(at_work.double, n)) for n in range(4)} | {
        'slack': Job(at_work.slack), 'bug': Job(at_work.divide)}
    found = outcomes(planned, workers)
    assert {n: found[n] for n in range(4)} == {0: 0, 1: 2, 2: 4, 3: 6}
    assert isinstance(found['slack'].error, Slack) and not found['slack'].lost
    assert found['slack'].reason == 'Slack: at 1300 V'
    assert isinstance(found['bug'].error, ZeroDivisionError) and found['bug'].lost
    with pytest.raises(ZeroDivisionError):
        dict(jobs.results(planned, workers))


def test_jobs_wait_for_what_they_need_and_known_ones_are_not_repeated(workers):
    shares = []
    planned = {'last': Job(at_work.total, ('middle', 'first'), linked=True),
               'middle': Job(at_work.total, ('first', 'known'), linked=True),
               'first': Job(at_work.total, linked=True), 'known': Job(at_work.divide)}
    found = outcomes(planned, workers, known={'known': 10},
                     progress=lambda done, total: shares.append(done / total))
    assert found == {'first': 1, 'middle': 12, 'last': 14}
    assert shares[0] >= 0.25 and shares[-1] == 1.0 and sorted(shares) == shares


def test_what_needs_a_failed_job_fails_and_no_other(workers):
    planned = {'broken': Job(at_work.slack), 'beside': Job(at_work.total, linked=True),
               'after': Job(at_work.total, ('broken',), linked=True),
               'later': Job(at_work.total, ('after', 'beside'), linked=True)}
    found = outcomes(planned, workers)
    assert found['beside'] == 1
    assert str(found['after']) == 'it needs broken, which failed'
    assert str(found['later']) == 'it needs after, which failed'


def test_the_longest_chain_starts_first(tmp_path):
    log = tmp_path / 'log'
    costs = {'short': 1.0, 'long': 3.0, 'begins a chain': 2.0, 'ends it': 2.5}
    planned = {name: Job(partial(at_work.note, log, name), cost=cost)
               for name, cost in costs.items()}
    planned['ends it'] = Job(partial(at_work.note_linked, log, 'ends it'), ('begins a chain',),
                             2.5, linked=True)
    outcomes(planned, Workers(1))
    assert log.read_text().splitlines() == ['begins a chain', 'long', 'ends it', 'short']


def test_processes_have_one_thread_and_are_not_this_one(monkeypatch):
    monkeypatch.delenv('OPENBLAS_NUM_THREADS', raising=False)
    (threads, process), = outcomes({0: Job(at_work.environment)}, Workers(1)).values()
    assert threads == '1' and process != os.getpid()


def test_what_cannot_be_sent_is_lost_and_no_other():
    planned = {'result': Job(at_work.unsendable), 'call': Job(lambda: None),
               'sound': Job(partial(at_work.double, 1))}
    found = outcomes(planned, Workers(2))
    assert found['result'].lost and found['call'].lost and found['sound'] == 2


def test_a_call_that_only_this_process_knows_is_lost(tmp_path, monkeypatch):
    (tmp_path / 'known_here.py').write_text('def call():\n    return 1\n')
    with monkeypatch.context() as here:
        here.syspath_prepend(str(tmp_path))
        import known_here
    found = outcomes({'here': Job(known_here.call), 'sound': Job(partial(at_work.double, 1))},
                     Workers(1))
    assert isinstance(found['here'].error, ModuleNotFoundError) and found['sound'] == 2


def test_a_killed_process_costs_its_own_job_only(tmp_path):
    planned = {n: Job(partial(at_work.double, n)) for n in range(6)} | {
        'kills': Job(at_work.kill_itself, cost=9.0),
        'once': Job(partial(at_work.kill_itself_once, tmp_path / 'once'), cost=8.0)}
    found = outcomes(planned, Workers(3))
    assert [found[n] for n in range(6)] == [0, 2, 4, 6, 8, 10]
    assert found['once'] == 'survived'
    assert found['kills'].lost and 'process was killed' in str(found['kills'])
    with pytest.raises(RunFailed, match='kills: its process was killed'):
        jobs.found('kills', found['kills'])


def test_shares_are_heard_while_a_job_runs(tmp_path):
    go, seen = tmp_path / 'go', []

    def progress(done, total):
        seen.append(done)
        if done == 2.0:
            go.write_text('')

    planned = {'slow': Job(partial(at_work.half_way, go), cost=4.0, linked=True)}
    assert outcomes(planned, Workers(1), progress=progress) == {'slow': None}
    assert 2.0 in seen and seen[-1] == 4.0


def test_a_reader_that_stops_ends_what_runs_and_cancels_the_rest(tmp_path):
    planned = {'short': Job(partial(at_work.double, 1), cost=9.0),
               'endless': Job(partial(at_work.endless, tmp_path / 'endless'), cost=8.0),
               'next': Job(partial(at_work.endless, tmp_path / 'next')),
               'never': Job(partial(at_work.note, tmp_path / 'never', 'started'))}

    def interrupt(done, total):
        if (tmp_path / 'endless').exists() and (tmp_path / 'next').exists():
            raise KeyboardInterrupt

    kept = []
    with pytest.raises(KeyboardInterrupt):
        for batch in jobs.run(planned, Workers(2), progress=interrupt):
            kept += batch
    assert kept == [('short', 2)]
    for name in ('endless', 'next'):
        assert not psutil.pid_exists(int((tmp_path / name).read_text()))
    assert not (tmp_path / 'never').exists()


def test_processes_end_with_a_parent_that_is_killed(tmp_path):
    program = ('from functools import partial\nimport jobs_at_work as at_work\n'
               'from dewing_sim.machine.jobs import *\n'
               'if __name__ == "__main__":\n'
               f'    list(run({{0: Job(partial(at_work.endless, {str(tmp_path / "pid")!r}))}}, '
               'Workers(1)))\n')
    script = tmp_path / 'program.py'
    script.write_text(program)
    pid = tmp_path / 'pid'
    with started([sys.executable, str(script)], stderr=subprocess.DEVNULL,
                 env=os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}) as parent:
        wait_until(lambda: pid.exists() and pid.read_text(), parent)
        parent.kill()
        wait_until(lambda: not psutil.pid_exists(int(pid.read_text())))


def test_nothing_to_do_starts_nothing():
    assert outcomes({}, Workers(scheduler='nowhere')) == {}
    assert outcomes({0: Job(at_work.divide)}, Workers(2), known={0: 1}) == {}


@pytest.mark.parametrize('address', ['http://x', 'tcp://127.0.0.1:9'])
def test_a_scheduler_that_does_not_answer_is_refused(address, monkeypatch):
    monkeypatch.setattr(on_dask, 'ANSWER', 0.5)
    with pytest.raises(BadInput, match=f'--scheduler {address}: no scheduler answers'):
        outcomes({0: Job(at_work.divide)}, Workers(scheduler=address))


def test_a_scheduler_without_workers_is_warned_about_and_waited_for(monkeypatch):
    from distributed import LocalCluster
    monkeypatch.setattr(on_dask, 'MUSTER', 0.2)
    with LocalCluster(n_workers=0, threads_per_worker=1, processes=False,
                      dashboard_address='127.0.0.1:0') as running:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter('always')
            found = outcomes({0: Job(partial(at_work.double, 2))},
                             Workers(scheduler=running.scheduler_address),
                             progress=lambda done, total: running.scale(1))
    assert found == {0: 4}
    texts = [str(warning.message) for warning in said if warning.category is RuntimeWarning]
    assert [f'--scheduler {running.scheduler_address} has no workers yet' in text
            for text in texts] == [True]


def test_dask_is_imported_for_a_scheduler_only():
    program = ('import sys\nfrom dewing_cli.main import build_parser\nbuild_parser()\n'
               'from dewing_sim.machine import jobs, processes\n'
               'print([name for name in ("distributed", "xarray") if name in sys.modules])')
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True,
                          check=True, env=os.environ | {'PYTHONPATH': str(Path.cwd())})
    assert done.stdout.strip() == '[]'

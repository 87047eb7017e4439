# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The report: runs are kept and resumed, the page is whole, its numbers are those of the runs."""

import base64
import csv
import dataclasses
import json
import math
import os
import re
import signal
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest
from identified_wing import identity, reduced_model
from paper_runs import TINY, Sum
from started import PATIENCE, started, wait_until

from dewing_cli import main as cli
from dewing_cli.commands import paper
from dewing_cli.paper import plan
from dewing_cli.paper.report import html, record, sections
from dewing_cli.paper.report.section import Found, Row, Section
from dewing_cli.paper.runs import quantities, workers
from dewing_cli.paper.runs.experiments import FIELDS
from dewing_cli.paper.runs.result import Result, fingerprint, keep, recall
from dewing_cli.paper.runs.workers import Failure
from dewing_sim.errors import RunFailed
from dewing_sim.machine.jobs import Workers


def test_a_result_is_kept_and_recalled_under_its_mark_only(tmp_path):
    path = tmp_path / 'runs' / 'one.npz'
    keep(path, Result({'cl': 0.4, 'names': ['a']}, {'t': np.arange(3.0)}), 'mark')
    found = recall(path, 'mark')
    assert found.values == {'cl': 0.4, 'names': ['a']} and (found['t'] == np.arange(3.0)).all()
    assert recall(path, 'other') is None
    path.write_bytes(path.read_bytes()[:100])
    assert recall(path, 'mark') is None and recall(tmp_path / 'none.npz', 'mark') is None


def test_a_fingerprint_follows_the_run_and_what_it_needs():
    runs = {'first': Sum(), 'second': Sum(needs=('first',))}
    mark = fingerprint('second', runs)
    assert fingerprint('second', runs) == mark
    assert fingerprint('second', runs | {'first': Sum(cost=2.0)}) != mark
    assert fingerprint('second', runs | {'second': Sum(needs=('first',), fails=True)}) != mark


def test_runs_wait_for_what_they_need_and_known_ones_are_not_repeated(tmp_path):
    log = tmp_path / 'log'
    runs = {'last': Sum(needs=('middle', 'first')), 'middle': Sum(needs=('first',)),
            'first': Sum(log=str(log)), 'known': Sum(log=str(log))}
    kept, shares = {}, []
    results = workers.execute(runs, {'known': Result({'total': 7})}, Workers(2), kept.__setitem__,
                              lambda done, total: shares.append(done / total))
    assert {name: result.values['total'] for name, result in results.items()} == {
        'first': 1, 'middle': 2, 'last': 4, 'known': 7}
    assert set(kept) == {'first', 'middle', 'last'}
    assert log.read_text().count('run') == 1
    assert shares[-1] == pytest.approx(1.0)


def test_a_failed_run_stops_only_those_that_need_it():
    runs = {'broken': Sum(fails=True), 'after': Sum(needs=('broken',)), 'beside': Sum()}
    kept = {}
    results = workers.execute(runs, {}, Workers(1), kept.__setitem__)
    assert results['broken'] == Failure('slack')
    assert 'broken' in results['after'].reason
    assert set(kept) == {'beside'}


def test_an_interrupt_ends_running_work_and_keeps_what_had_finished():
    runs = {'short': Sum(), 'long': Sum(endless=True)}
    kept = {}

    def interrupt(done, total):
        if kept:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        workers.execute(runs, {}, Workers(2), kept.__setitem__, interrupt)
    assert set(kept) == {'short'}


def test_modes_of_a_known_motion():
    x, time = quantities.STATIONS, np.linspace(0.0, 1.0, 200, endpoint=False)
    standing = np.outer(np.cos(2.0 * np.pi * 5.0 * time), np.sin(np.pi * x))
    second = 0.1 * np.outer(np.sin(2.0 * np.pi * 9.0 * time), np.sin(2.0 * np.pi * x))
    found = quantities.modes(3.0 + standing + second)
    assert found.energy[:2] == pytest.approx([1.0 / 1.01, 0.01 / 1.01], rel=1.0e-3)
    assert found.shape[0] == pytest.approx(math.sqrt(2.0) * np.sin(np.pi * x), abs=1.0e-3)
    assert np.abs(found.amplitude[:, 0]).max() == pytest.approx(math.sqrt(0.5), rel=1.0e-3)


def test_peak_of_a_mean_shape():
    x = np.linspace(0.0, 0.03, 129)
    y = 1.0e-5 * np.sin(np.pi * (x / 0.03)**0.8)
    flight = Result({'chord': 0.03, 'y_ref': 1.0e-5}, {'x': np.tile(x, (32, 1)),
                                                       'y': np.tile(y, (32, 1))})
    found = quantities.peak(flight)
    assert found.height.value == pytest.approx(1.0, abs=1.0e-4)
    assert found.place.value == pytest.approx(0.5**1.25, abs=2.0e-3)
    assert found.place.error == pytest.approx(0.0, abs=1.0e-12)


@pytest.mark.parametrize('paper_value, ours, difference', [
    (0.4, 0.44, 0.1), (-5.0, -4.5, 0.1), (None, 1.0, None), (0.0, 1.0, None)])
def test_difference_of_a_row(paper_value, ours, difference):
    row = Row('Cl', paper_value, ours)
    assert row.difference == (difference if difference is None else pytest.approx(difference))
    assert json.dumps(row.to_mapping(), allow_nan=False)


def test_a_full_plan_shares_runs_and_needs_only_what_it_has():
    made = plan.make('finite_volume', quick=False)
    for name, run in made.runs.items():
        assert set(run.needs) <= set(made.runs), name
    cases = [(run.case, run.duration, repr(run)) for run in made.runs.values()
             if hasattr(run, 'case') and hasattr(run, 'sample')]
    assert len(set(cases)) == len(cases)
    assert {variant.flight for variant in made.variants} <= set(made.runs)
    assert 'rest' in {variant.flight for variant in made.variants}


# The page, from wings that are not simulated


def flight(made: plan.Plan, name: str) -> Result:
    """Return a flight whose lift and shape oscillate as told."""
    case = made.case(name)
    steady = case.flow.angle_of_attack_deg == 4.0
    time = 2.0e-4 * np.arange(1600)
    wave = 0.0 if steady else np.sin(2.0 * np.pi * 25.0 * time)
    chord = case.membrane.chord
    x = np.tile(np.linspace(0.0, chord, 33), (len(time) // 2, 1))
    y = 3.0e-5 * np.sin(np.pi * x / chord) * (1.0 + 0.5 * (0.0 * time + wave)[::2, None])
    flat = np.ones(len(time))
    arrays = {'time': time, 'v_squared': 0.0 * flat, 'cl': 0.4 * flat + 0.2 * wave,
              'cd': 0.06 * flat, 'camber_mean': 2.0e-5 * (flat + 0.5 * wave),
              'camber_max': 3.0e-5 * (flat + 0.5 * wave), 'tension': flat,
              'camber_max_position': 0.4 * flat, 'shape_time': time[::2], 'x': x, 'y': y,
              'pressure_jump': y}
    return Result({'dt': 1.0e-4, 'sample': 2.0e-4, 'y_ref': 8.0e-5, 'chord': chord,
                   'convective_time': 0.025, 'frequency': 0.0, 'v_slack': 1300.0, 'cells': 10,
                   'engine': case.numerics.engine, 'grid': case.numerics.grid}, arrays)


def loop(name: str) -> Result:
    """Return a closed loop that settles at its target."""
    time = 1.0e-4 * np.arange(1, 2501)
    target = 1.1 if name.endswith('open_loop') is False else 1.0
    camber = target + 0.01 * (1.0 - time) * np.sin(20.0 * np.pi * time)
    flat = np.ones(len(time))
    values = {'target': target, 'dt': 1.0e-4, 'averaged': 0.1, 'v_slack': 1300.0,
              'camber_reference': 2.0e-5, 'camber_mean': target, 'camber_amplitude': 0.01,
              'error_mean': 0.0, 'error_rms': 0.007, 'v_max': 400.0, 'v_rms': 390.0,
              'saturation_share': 0.0, 'energy_j': 1.0e-3, 'energy_without_recovery_j': 2.0e-3,
              'power_w': 0.0, 'power_without_recovery_w': 1.0e-2, 'work_w': 0.0,
              'cl_mean': 0.4, 'cl_rms': 0.01, 'cd_mean': 0.06, 'compute_ms': 0.01,
              'compute_worst_ms': 0.1,
              'failure': 'step 7: the membrane went <slack>' if 'printed' in name else ''}
    return Result(values, {'time': time, 'camber': camber, 'v_squared': 1.6e5 * flat,
                           'cl': 0.4 + 0.01 * camber, 'cd': 0.06 * flat,
                           'capacitance': 1.0e-8 * flat})


def excited(made: plan.Plan) -> Result:
    """Return the records of the linear wing of `identified_wing`, with noise of one millionth."""
    from dewing_sim import parameters
    from dewing_sysid import experiment
    from dewing_sysid import plan as sysid_plan
    from dewing_sysid.settings import Settings
    wing = reduced_model()
    settings = parameters.from_yaml(made.runs['experiments'].settings, Settings)
    planned = sysid_plan.make(settings, identity())
    records = planned.records({
        name: experiment.run(wing, wing.rest(), planned.names, v_squared)
        for name, v_squared in planned.inputs.items()})
    noise = np.random.default_rng(1)
    for item in records.values():
        item.outputs[:] += 1.0e-6 * np.ptp(item.y, axis=1, keepdims=True) * (
            noise.standard_normal(item.outputs.shape))
    return Result({'dt': planned.dt, 'operating_v_squared': 0.0, 'names': list(planned.names),
                   'runs': list(records), 'identity': identity().to_yaml()},
                  {f'{run}/{field}': getattr(item, field) for run, item in records.items()
                   for field in FIELDS})


@pytest.fixture(scope='module')
def drawn() -> tuple[plan.Plan, dict, list[Section], dict]:
    made = plan.make('conformal', True, dataclasses.replace(TINY, scenarios=('fig5',)))
    results = {}
    for name, run in made.runs.items():
        if type(run).__name__ == 'Flight':
            results[name] = flight(made, name)
        elif type(run).__name__ == 'Controlled':
            results[name] = loop(name)
    results['experiments'] = excited(made)
    results['design'] = made.runs['design'](lambda share: None, results)
    picture = np.frombuffer(b'picture', np.uint8)
    for engine in plan.ENGINES:
        results[f'film {engine}'] = Result({'exaggeration': 20.0},
                                           {'still': picture, 'film': picture})
    results['shed other'] = Failure('the flow <diverged>')
    found = sections.make(made, Found(results))
    return made, results, found, record.metrics(made, found, results, 1.0)


class Reader(HTMLParser):
    """Checks that tags close in order and collects what the page refers to."""

    VOID = ('meta', 'img', 'br')

    def __init__(self):
        super().__init__()
        self.open, self.links, self.ids = [], [], []

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.links += [values[name] for name in ('src', 'href') if name in values]
        self.ids += [values['id']] if 'id' in values else []
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_is_well_formed_and_needs_no_network(drawn):
    made, _, found, numbers = drawn
    text = html.page(made, found, numbers)
    reader = Reader()
    reader.feed(text)
    assert reader.open == [] and len(set(reader.ids)) == len(reader.ids)
    for link in reader.links:
        assert link.startswith('data:image/') or link[1:] in reader.ids
    pictures = [link for link in reader.links if link.startswith('data:')]
    assert len(pictures) == sum(len(section.figures) for section in found) > 14
    decoded = [base64.b64decode(link.partition(',')[2]) for link in pictures]
    assert decoded[0] == b'picture' and decoded[1].startswith(b'\x89PNG')
    assert not re.search(r'https?://|<script|\bnan\b', text)
    assert 'Quick version' in text and 'the flow &lt;diverged&gt;' in text


def test_numbers_of_the_page_are_those_of_the_runs(drawn):
    _, _, found, numbers = drawn
    rows = {row['quantity']: row for row in numbers['rows']}
    assert rows['8 deg: mean Cl']['paper'] == 0.83
    assert rows['8 deg: mean Cl']['ours'] == pytest.approx(0.4, abs=1.0e-3)
    assert rows['8 deg: shedding frequency']['ours'] == pytest.approx(25.0, abs=0.1)
    assert rows['Fig. 5, closed loop: mean of the camber']['ours'] == pytest.approx(10.0)
    assert {'quantity', 'paper', 'ours', 'error', 'explanation'} <= set(numbers['rows'][0])
    assert all(row['explanation'] for name, row in rows.items() if name.startswith('8 deg'))
    assert not [section.title for section in found if 'Not available' in ''.join(section.text)]
    json.dumps(numbers, allow_nan=False)


def test_a_section_without_its_run_says_so(drawn):
    made, results, _, _ = drawn
    found = {section.name: section for section in sections.make(
        made, Found(results | {'design': Failure('no memory')}))}
    assert 'no memory' in found['controller'].text[0]
    assert found['shapes'].figures


def test_series_are_written_with_units_and_never_with_nan(drawn, tmp_path):
    _, _, found, _ = drawn
    record.write_series(tmp_path, found, overwrite=False)
    with open(tmp_path / 'fig5.csv', newline='') as file:
        table = list(csv.reader(file))
    assert table[0][0] == 't [s]' and len({len(row) for row in table}) == 1
    assert float(table[1][0]) == pytest.approx(1.0e-4)
    broken = Section('x', 'x', series={'bad': {'t [s]': np.array([0.0, math.nan])}})
    with pytest.raises(RunFailed, match='not finite'):
        record.write_series(tmp_path, [broken], overwrite=True)


# The command

TINY_COMMAND = """
import sys
from dewing_cli import main as cli
from dewing_cli.paper import plan
from paper_runs import TINY
plan.QUICK = TINY
sys.exit(cli.main(sys.argv[1:]))
"""


@pytest.mark.parametrize('name', [paper.REPORT, paper.NUMBERS])
def test_nothing_is_written_over(name, tmp_path, capsys):
    (tmp_path / name).write_text('mine')
    assert cli.main(['paper', '--quick', '--out', str(tmp_path)]) == 2
    assert '--force' in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize('option', [['--engine', 'spectral'], ['--jobs', '0']])
def test_unusable_options_are_refused(option, capsys):
    assert cli.main(['paper', '--quick', *option]) == 2
    assert option[0] in capsys.readouterr().err


def test_finished_runs_are_used_again_and_changed_ones_are_not(tmp_path):
    log = tmp_path / 'log'
    runs = {'first': Sum(log=str(log)), 'second': Sum(needs=('first',), log=str(log))}
    made = dataclasses.replace(plan.make('conformal', True), runs=runs)
    found, _ = paper.compute(made, tmp_path, Workers(1), True)
    assert found['second'].values == {'total': 2} and log.read_text().count('run') == 2
    paper.compute(made, tmp_path, Workers(1), True)
    assert log.read_text().count('run') == 2
    changed = runs | {'second': Sum(needs=('first',), log=str(log), cost=3.0)}
    paper.compute(dataclasses.replace(made, runs=changed), tmp_path, Workers(1), True)
    assert log.read_text().count('run') == 3


@pytest.mark.slow
def test_the_command_from_an_interrupt_to_the_report(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    monkeypatch.setattr(plan, 'QUICK', TINY)
    out = tmp_path / 'out'
    arguments = ['paper', '--quick', '--out', str(out), '--quiet']
    with started([sys.executable, '-c', TINY_COMMAND, *arguments], stderr=subprocess.PIPE,
                 text=True, env=os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}) as process:
        wait_until(lambda: list(out.glob('runs/*.npz')), process)
        process.send_signal(signal.SIGHUP)
        _, complaint = process.communicate(timeout=PATIENCE)
    assert process.returncode == 128 + signal.SIGHUP
    kept, interrupted = complaint.splitlines()
    assert re.match(r'dewing: kept [1-9]\d* of \d+ runs in ', kept)
    assert interrupted == 'dewing: interrupted'
    assert not (out / paper.REPORT).exists()
    assert cli.main(arguments) == 0
    numbers = json.loads((out / paper.NUMBERS).read_text())
    assert numbers['failures'] == {} and len(numbers['rows']) >= 15
    assert (out / paper.REPORT).stat().st_size > 500_000
    assert cli.main(arguments) == 2
    assert capsys.readouterr().out == ''

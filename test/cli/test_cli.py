# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command line: exit status, one sentence for each mistake, and the promised JSON keys."""

import json
import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from dewing_cli import main as cli
from dewing_cli.commands import simulate
from dewing_cli.options import load_case
from dewing_sim import parameters
from dewing_sim.machine.signals import ENDS
from dewing_sim.records.history import History, Recorder

PROJECT = Path(__file__).parents[2]
QUICK = ['--grid', 'fast', '--set', 'numerics.trim_time=0.1', '--quiet']
SIMULATE_KEYS = {
    'cl_mean', 'cl_rms', 'cd_mean', 'y_star', 'camber_max', 'camber_max_x_c', 'camber_mean',
    'tension', 'v_min', 'v_max', 'rtf', 'ms_per_step', 'coupling_iterations_mean',
    'spectrum_peaks_hz', 'slip_max', 'clipped_steps', 'courant_max', 'edge_courant_max'}
PLATE_KEYS = {'cl_mean', 'cl_rms', 'cd_mean', 'cd_rms', 'cm_mean', 'strouhal', 'ms_per_step',
              'cells', 'dt', 'engine'}


pytestmark = pytest.mark.usefixtures('own_folder')


def changed_case(old: str, new: str) -> str:
    """Write the paper case with a piece of its text replaced; return the file's name."""
    text = parameters.to_yaml(parameters.load('paper'))
    assert old in text
    Path('changed.yaml').write_text(text.replace(old, new))
    return 'changed.yaml'


def fails(capsys, arguments, status: int = 2) -> str:
    """Return the only line on standard error of a command that must end with ``status``."""
    assert cli.main(arguments) == status
    captured = capsys.readouterr()
    assert captured.out == ''
    lines = captured.err.splitlines()
    assert len(lines) == 1 and lines[0].startswith('dewing: ')
    return lines[0]


@pytest.mark.parametrize('arguments, complaint', [
    ([], 'arguments are required: COMMAND'),
    (['fly'], "invalid choice: 'fly'"),
    (['simulate', '--wind', '1'], 'unrecognized arguments: --wind'),
    (['simulate', '--dur', '0.1'], 'unrecognized arguments: --dur'),
    (['simulate', '--case'], 'expected one argument'),
    (['simulate', '--case', 'papier'], "'papier' is not a shipped configuration"),
    (['simulate', '--case', 'missing.yaml'], 'missing.yaml: no such file'),
    (['simulate', '--case', '.'], "'.' is not a shipped configuration"),
    (['simulate', '--set', 'flow.speed'], 'is not of the form section.key=value'),
    (['simulate', '--set', 'flow.wind=1.0'], 'flow.wind is not a parameter'),
    (['simulate', '--set', 'flow.speed=1'], 'flow.speed = 1 is not a floating-point number'),
    (['simulate', '--set', 'flow.speed=-1.0'], 'flow.speed = -1.0 is out of range'),
    (['simulate', '--set', 'flow.speed=fast'], "flow.speed = 'fast' is not a"),
    (['simulate', '--set', 'actuation.voltage=1400.0'],
     'actuation.voltage = 1400 V is out of range: at most 1250 V with actuation.voltage_limit'),
    (['simulate', '--set', 'actuation.voltage=1400.0', '--set', 'actuation.voltage_limit=1500.0'],
     'loses its tension at 1300 V'),
    (['simulate', '--voltage', '1400'], 'loses its tension at 1300 V'),
    (['simulate', '--voltage', '1260'], '--voltage 1260 is out of range: from 0 to 1250 V'),
    (['simulate', '--voltage', '-1'], '--voltage -1 is out of range'),
    (['simulate', '--voltage', 'nan'], '--voltage nan is out of range'),
    (['simulate', '--voltage', 'high'], "invalid float value: 'high'"),
    (['simulate', '--voltage', '1', '--controller', 'x'], 'not allowed with argument --voltage'),
    (['simulate', '--controller', 'missing.yaml'], 'missing.yaml: no such file'),
    (['simulate', '--controller', 'paper'], 'are expected below /** or /**/controller'),
    (['simulate', '--disturbance', 'gust'], '--disturbance gust is not known; one of none, fig5'),
    (['simulate', '--grid', 'coarse'], "numerics.grid = 'coarse' is out of range"),
    (['simulate', '--engine', 'panel'], "numerics.engine = 'panel' is out of range"),
    (['simulate', '--dt', '0'], 'numerics.time_step = 0.0 is out of range'),
    (['simulate', '--dt', 'nan'], 'numerics.time_step = nan is out of range'),
    (['simulate', '--duration', '0'], '--duration 0 s is out of range'),
    (['simulate', '--duration', '-1'], '--duration -1 s is out of range'),
    (['simulate', '--duration', 'inf'], '--duration inf s is out of range'),
    (['simulate', '--voltage', '1250.0000001'],
     '--voltage 1250.0000001 is out of range: from 0 to 1250 V'),
    (['simulate', '--skip', '9'], '--skip 9 is out of range'),
    (['simulate', '--duration', '0.02', '--skip', '0.02', '--dt', '5e-4'],
     '--skip 0.02 is out of range: from 0 to 0.0195 s, a time step before the end'),
    (['plate', '--alpha', '4', '--duration', '2', '--skip', '2'],
     '--skip 2 is out of range: from 0 to 1.996 t*'),
    (['simulate', '--every', '0'], '--every 0 is out of range'),
    (['simulate', '--every', '1.5'], "invalid int value: '1.5'"),
    (['simulate', '--out', '.'], '. is a folder'),
    (['plate'], 'arguments are required: --alpha'),
    (['plate', '--alpha', '40'], '--alpha 40 is out of range: from -15 to 15 deg'),
    (['plate', '--alpha', 'nan'], '--alpha nan is out of range'),
    (['plate', '--alpha', '4', '--camber', '2'], '--camber 2 is out of range'),
    (['plate', '--alpha', '4', '--re', '0'], '--re 0 is out of range'),
    (['plate', '--alpha', '4', '--dt', '1'], '--dt 1 is out of range'),
    (['plate', '--alpha', '4', '--grid', 'coarse'], '--grid coarse is not known; one of fast'),
    (['plate', '--alpha', '4', '--engine', 'panel'], '--engine panel is not known'),
    (['plate', '--alpha', '4', '--duration', '0'], '--duration 0 t* is out of range'),
    (['plate', '--alpha', '4', '--skip', '-1'], '--skip -1 is out of range'),
    (['simulate', '--controller', 'late', '--delay', '-1'], '--delay -1 is out of range'),
    (['simulate', '--controller', 'late', '--jitter', '2'], '--jitter 2 is out of range'),
    (['tune', '--generations', '0'], '--generations 0 is out of range'),
    (['tune', '--delay', '-1'], 'command.delay_steps = -1 is out of range'),
    (['demo', '--case', 'papier'], "'papier' is not a shipped configuration"),
    (['demo', '--controller', 'missing.yaml'], 'missing.yaml: no such file'),
    (['demo', '--duration', '0'], '--duration 0 s is out of range'),
])
def test_bad_input_ends_with_status_2_and_one_sentence(capsys, arguments, complaint):
    assert complaint in fails(capsys, arguments)


@pytest.mark.parametrize('old, new, complaint', [
    ('speed: 1.21725', 'speed: 1', 'flow.speed = 1 is not a floating-point number'),
    ('speed: 1.21725', 'sped: 1.21725', 'flow.sped is not a parameter'),
    ('      speed: 1.21725\n', '', 'flow.speed is missing'),
    ('speed: 1.21725', 'speed: 1.0e+9', 'flow.speed = 1000000000.0 is out of range'),
    ('speed: 1.21725', 'speed: "1.21725"', "flow.speed = '1.21725' is not a floating-point"),
    ('speed: 1.21725', 'speed: [1.0]', 'flow.speed = [1.0] is not a floating-point'),
    ('speed: 1.21725', 'speed: 1.0: 2', 'not valid YAML'),
    ('ros__parameters', 'parameters', 'parameters are expected below'),
    ('voltage: 0.0', 'voltage: 1400.0', 'actuation.voltage = 1400 V is out of range: at most'),
    ('voltage_limit: 1250.0', 'voltage_limit: 1400.0', 'loses its tension at 1300 V'),
])
def test_a_bad_case_file_ends_with_status_2_and_one_sentence(capsys, old, new, complaint):
    assert complaint in fails(capsys, ['simulate', '--case', changed_case(old, new)])


def test_a_controller_may_be_obeyed_late():
    def late(*options):
        assert cli.main(['simulate', '--case', 'realtime', '--set', 'numerics.trim_time=10.0',
                         '--controller', 'realtime', '--duration', '0.03', '--json', 'late.json',
                         '--force', '--quiet', *options]) == 0
        return json.loads(Path('late.json').read_text())['v_max']
    in_time = late()
    assert late('--delay', '60') == 0.0 < in_time != late('--delay', '1') > 0.0


@pytest.mark.parametrize('options, said', [
    (['--engine', 'conformal', '--grid', 'realtime'],
     'dewing: warning: numerics.grid = realtime is made for steps of 0.0005 s: 0.0001 s takes 5 '
     'times as many, 10000 for a second of flight; --case realtime has both\n'),
    (['--engine', 'conformal', '--grid', 'realtime', '--quiet'], ''),
    (['--engine', 'conformal', '--grid', 'realtime', '--dt', '5e-4'], ''),
    (['--case', 'realtime', '--grid', 'realtime'], ''),
    (['--engine', 'conformal', '--grid', 'fast'], '')])
def test_a_small_step_on_the_grid_for_real_time_says_what_it_costs(capsys, options, said):
    arguments = cli.build_parser().parse_args(['simulate', *options])
    with warnings.catch_warnings():
        warnings.showwarning = cli._show_warning
        load_case(arguments)
    assert capsys.readouterr().err == said


@pytest.mark.parametrize('option', ['--out', '--json'])
def test_an_existing_result_is_kept_without_force(capsys, option):
    Path('kept').write_text('precious')
    assert '--force' in fails(capsys, ['simulate', option, 'kept'])
    assert Path('kept').read_text() == 'precious'


def test_simulate_writes_metrics_and_the_run():
    options = ['simulate', *QUICK, '--duration', '0.003', '--voltage', '400', '--every', '10']
    assert cli.main([*options, '--json', 'metrics.json', '--out', 'run.npz']) == 0
    metrics = json.loads(Path('metrics.json').read_text())
    assert set(metrics) >= SIMULATE_KEYS
    assert (metrics['steps'], metrics['v_min'], metrics['v_max']) == (30, 400.0, 400.0)
    history = History.load('run.npz')
    assert len(history) == 30 and len(history.shape_time) == 3
    assert parameters.from_yaml(history.case).numerics.grid == 'fast'
    late = history.since(metrics['averaged_from'])
    assert metrics['cl_mean'] == pytest.approx(late.cl.mean())
    assert metrics['camber_mean'] == pytest.approx(late.camber_mean.mean())


def test_simulate_closes_the_loop():
    options = ['simulate', *QUICK, '--duration', '0.003', '--disturbance', 'fig5',
               '--set', 'actuation.voltage=300.0']
    assert cli.main([*options, '--controller', 'controller', '--out', 'run.npz']) == 0
    history = History.load('run.npz')
    assert parameters.from_yaml(history.case).disturbance.pressure == 0.015
    assert np.ptp(history.v_squared) > 0.0 and history.v_squared.min() >= 0.0


def test_a_field_above_breakdown_is_a_warning_of_one_line(capsys):
    options = ['simulate', *QUICK, '--duration', '0.0002', '--voltage']
    assert cli.main([*options, '700']) == 0
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith('dewing: warning: 700 V is a field of 21.0 MV/m')
    assert cli.main([*options, '600']) == 0
    assert capsys.readouterr().err == ''


@pytest.mark.parametrize('numbers', [
    (signal.SIGINT,), (signal.SIGTERM, signal.SIGTERM), (signal.SIGHUP, signal.SIGTERM)])
def test_an_interrupted_run_is_kept_and_says_by_what(capsys, monkeypatch, numbers):
    """A shell and a service manager may send what is no Ctrl-C twice, also during the save."""
    def add(recorder, outputs):
        original(recorder, outputs)
        if len(recorder) == 5:
            signal.raise_signal(numbers[0])

    def history(recorder):
        for number in numbers[1:]:
            signal.raise_signal(number)
        return finished(recorder)
    original, finished = Recorder.add, Recorder.history
    monkeypatch.setattr(Recorder, 'history', history)
    monkeypatch.setattr(Recorder, 'add', add)
    options = ['simulate', *QUICK, '--duration', '0.01', '--out', 'run.npz']
    before = [signal.getsignal(number) for number in ENDS]
    assert fails(capsys, options, 128 + numbers[0]) == 'dewing: interrupted'
    assert len(History.load('run.npz')) == 5
    assert [signal.getsignal(number) for number in ENDS] == before


def test_a_run_that_fails_is_kept_and_ends_with_status_1(capsys, monkeypatch):
    from dewing_sim.errors import NotConverged
    from dewing_sim.wing import Wing

    def step(wing, state, inputs):
        if state.step == 4:
            raise NotConverged('no shape found', state)
        return original(wing, state, inputs)
    original = Wing.step
    monkeypatch.setattr(Wing, 'step', step)
    options = ['simulate', *QUICK, '--duration', '0.01', '--out', 'run.npz']
    assert fails(capsys, options, 1) == 'dewing: no shape found'
    assert len(History.load('run.npz')) == 4


def test_plate_writes_metrics_and_the_pressure_jump():
    options = ['plate', '--alpha', '4', '--grid', 'fast', '--duration', '0.2', '--quiet']
    assert cli.main([*options, '--json', 'metrics.json', '--dcp', 'jump.csv']) == 0
    metrics = json.loads(Path('metrics.json').read_text())
    assert set(metrics) >= PLATE_KEYS
    x, jump = np.loadtxt('jump.csv', delimiter=',', skiprows=1, unpack=True)
    assert Path('jump.csv').read_text().startswith('x,dcp\n')
    assert 0.0 < x[0] < x[-1] < 1.0
    widths = np.diff(np.concatenate([[0.0], 0.5 * (x[1:] + x[:-1]), [1.0]]))
    assert widths @ jump == pytest.approx(metrics['cl_mean'], rel=0.1)


def test_a_table_is_printed_unless_quiet(capsys):
    options = ['plate', '--alpha', '4', '--grid', 'fast', '--duration', '0.008']
    assert cli.main(options) == 0
    captured = capsys.readouterr()
    assert 'cl_mean ' in captured.out and captured.err == ''
    assert cli.main([*options, '--quiet']) == 0
    assert capsys.readouterr().out == ''


@pytest.mark.parametrize('command', ['', *cli.command_modules()])
def test_help_explains_every_command(capsys, command):
    with pytest.raises(SystemExit) as caught:
        cli.main([*command.split(), '--help'])
    assert caught.value.code == 0
    assert capsys.readouterr().out.startswith(f'usage: dewing {command}'.rstrip())


def test_every_command_explains_every_option(capsys):
    parser = cli.build_parser()
    actions = next(action for action in parser._actions if action.choices)
    for command in actions.choices.values():
        assert all(action.help for action in command._actions)


def test_the_help_imports_nothing_slow():
    code = ('import sys\nfrom dewing_cli import main as cli\ncli.build_parser()\n'
            'print(sorted({"numba", "scipy", "matplotlib", "rich", "rclpy"} & set(sys.modules)))')
    result = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True)
    assert result.stdout.strip() == '[]', result.stderr


def test_the_module_is_the_command():
    result = subprocess.run([sys.executable, '-m', 'dewing_cli', 'plate'],
                            capture_output=True, text=True)
    assert result.returncode == 2
    assert result.stderr.count('\n') == 1 and 'Traceback' not in result.stderr


def test_the_disturbances_are_both_readings_of_the_paper():
    assert simulate.options.DISTURBANCES['fig5']['disturbance.pressure'] == 0.015
    assert simulate.options.DISTURBANCES['printed']['disturbance.pressure'] == 0.03


def test_a_command_runs_on_one_thread_unless_told_otherwise():
    code = ("import os\nfrom dewing_cli import main as cli\ncli.main(['plate'])\n"
            "print(os.environ['OPENBLAS_NUM_THREADS'], os.environ['NUMBA_NUM_THREADS'])")
    bare = {name: value for name, value in os.environ.items() if name not in cli.THREADS}
    for given, threads in (({}, '1 1'), ({'NUMBA_NUM_THREADS': '2'}, '1 2')):
        result = subprocess.run([sys.executable, '-c', code], env=bare | given,
                                capture_output=True, text=True)
        assert result.stdout.strip() == threads, result.stderr


@pytest.mark.parametrize('encoding', ['ascii', 'cp1252', 'utf-8'])
def test_outputs_that_lack_a_character_write_an_escape(encoding):
    """Also a name of a file that is in no encoding, as a byte 0xff is."""
    for name in ('Flügel-翼.mcap', os.fsdecode(b'\xff.mcap')):
        Path(name).write_bytes((PROJECT / 'test/reference/flight_0.1.mcap').read_bytes())
        done = subprocess.run(
            [sys.executable, '-m', 'dewing_cli', 'bag', 'info', name],
            env=os.environ | {'PYTHONIOENCODING': encoding, 'PYTHONPATH': str(PROJECT)},
            capture_output=True, check=False)
        assert (done.returncode, done.stderr) == (0, b'')
        assert b'.mcap: ' in done.stdout and b'plant ' in done.stdout

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The one linear model: exact to python-control and back, to npz and mat files, refusals."""

import dataclasses
import subprocess
import sys

import control
import numpy as np
import pytest
from reduced_wing import CAMBER, SLACK, first_mode
from scipy import io

from dewing_sim.errors import BadInput
from dewing_sim.linear.model import Model
from dewing_sim.linear.state_space import Matrices, frequency_response
from dewing_sim.parameters import config_file

BESIDE = dict(operating_outputs=np.array([CAMBER]), v_squared_slack=SLACK, v_squared_max=1.5e6)


def model() -> Model:
    """Return a model with everything that a file can hold."""
    return dataclasses.replace(
        first_mode().model, operating_v_squared=1.0e5, units=('m', 'm', '-'),
        singular_values=np.array([3.0, 1.0]), fit={'window': {'cl': 99.5}},
        case_yaml=config_file('paper').read_text())


def same(one: Model, other: Model) -> bool:
    return all(np.array_equal(getattr(one, item.name), getattr(other, item.name))
               for item in dataclasses.fields(Model))


def test_to_control_and_back_is_exact():
    system = model().to_control()
    assert isinstance(system, control.StateSpace) and system.dt == 1.0e-4
    assert system.input_labels == ['v_squared']
    assert system.output_labels == ['camber_mean', 'camber_max', 'cl']
    back = Model.of_control(system, like=model(), fit=model().fit,
                            singular_values=model().singular_values)
    assert same(back, model())


def test_a_file_gives_every_bit_back(tmp_path):
    model().save(tmp_path / 'model.npz')
    assert same(Model.load(tmp_path / 'model.npz'), model())


def test_another_realisation_keeps_names_and_operating_point_but_no_fit():
    twisted = control.similarity_transform(model().to_control(), [[2.0, 1.0], [0.0, 1.0]])
    other = Model.of_control(twisted, like=model())
    assert other.fit == {} and other.singular_values.size == 0
    assert other.units == ('m', 'm', '-') and other.operating_v_squared == 1.0e5
    frequency = np.array([3.0, 72.0, 400.0])
    np.testing.assert_allclose(other.frequency_response(frequency),
                               model().frequency_response(frequency), rtol=1.0e-9)


def test_a_transfer_function_becomes_a_model_named_by_its_labels():
    sampled = control.sample_system(control.tf([CAMBER], [1.0e-3, 1.0]), 1.0e-4)
    sampled.set_outputs(['camber_mean'])
    found = Model.of_control(sampled, **BESIDE)
    assert found.output_names == ('camber_mean',) and found.units == ('m',)
    assert found.frequency_response([0.0])[0, 0] == pytest.approx(CAMBER)


@pytest.mark.parametrize('system, beside, message', [
    (control.ss(-1.0, 1.0, 1.0, 0.0), BESIDE, 'dt = 0: sample it'),
    (control.ss(0.5, 1.0, 1.0, 0.0, True), BESIDE, 'dt = True: sample it'),
    (control.ss(0.5, [[1.0, 1.0]], 1.0, [[0.0, 0.0]], 0.1), BESIDE, '2 inputs'),
    (control.ss(0.5, 1.0, 1.0, 0.0, 0.1), {}, 'operating_outputs, v_squared_max, v_squared_slack'),
])
def test_systems_that_are_no_models_are_refused(system, beside, message):
    with pytest.raises(BadInput, match=message):
        Model.of_control(system, **beside)


@pytest.mark.parametrize('change, message', [
    (dict(b=np.ones((3, 1))), r'B must be finite and of shape \(2, 1\)'),
    (dict(c=np.full((3, 2), np.nan)), 'C must be finite'),
    (dict(units=('m',)), '1 units for 3 outputs'),
    (dict(dt=0.0), 'dt = 0.0 is not positive'),
])
def test_bad_models_are_refused(change, message):
    with pytest.raises(BadInput, match=message):
        dataclasses.replace(model(), **change)


def test_responses_are_those_of_python_control():
    ours, system = model(), model().to_control()
    frequency = np.geomspace(1.0, 4.9e3, 30)
    theirs = system(np.exp(2j * np.pi * frequency * ours.dt))[:, 0]
    np.testing.assert_allclose(ours.frequency_response(frequency), theirs, rtol=1.0e-9)
    u = np.random.default_rng(1).standard_normal(50)
    time = ours.dt * np.arange(u.size)
    outputs = control.forced_response(system, time, u).outputs
    np.testing.assert_allclose(ours.simulate(u), outputs, rtol=1.0e-9, atol=1.0e-22)


def test_compensators_may_be_systems_of_python_control():
    matrices = Matrices.siso(np.array([[0.5]]), [2.0], [3.0], 1.0)
    assert Matrices.of(matrices) is matrices
    for one, other in zip(Matrices.of(matrices.to_control(0.1)), matrices):
        assert np.array_equal(one, other)
    assert frequency_response(matrices, [0.0], 0.1)[0, 0] == pytest.approx(13.0)


@pytest.mark.parametrize('delays', [0, 1, 4, 9])
def test_delays_are_no_modes(delays):
    """Rounding scatters n poles at z = 0 over a circle of radius eps^(1/n)."""
    delay = control.ss(np.eye(delays, k=-1), np.eye(delays, 1), np.eye(delays)[-1:], 0.0, 1.0e-4) \
        if delays else control.ss([], [], [], 1.0, 1.0e-4)
    twist = np.random.default_rng(3).standard_normal((2 + delays, 2 + delays))
    system = control.similarity_transform(first_mode().model.to_control() * delay, twist)
    late = Model.of_control(system, like=model())
    assert late.order == 2 + delays
    frequency, damping = late.modes()
    assert frequency == pytest.approx([72.0], rel=1.0e-6)
    assert damping == pytest.approx([0.08], rel=1.0e-6)


def test_a_pole_that_alternates_is_no_mode_and_a_lag_is_one():
    poles = control.ss(np.diag([-0.3, 0.9]), np.ones((2, 1)), np.ones((1, 2)), 0.0, 1.0e-4)
    frequency, damping = Model.of_control(poles, **BESIDE).modes()
    assert frequency == pytest.approx([-np.log(0.9) / (2.0e-4 * np.pi)])
    assert damping == pytest.approx([1.0])


def test_matlab_finds_matrices_names_and_units(tmp_path):
    model().save_mat(tmp_path / 'model.mat')
    with pytest.raises(BadInput, match='exists'):
        model().save_mat(tmp_path / 'model.mat')
    read = io.loadmat(tmp_path / 'model.mat', simplify_cells=True)
    for name, expected in zip('ABCD', model().matrices):
        assert np.array_equal(np.reshape(read[name], expected.shape), expected)
    assert list(read['output_names']) == ['camber_mean', 'camber_max', 'cl']
    assert list(read['units']) == ['m', 'm', '-'] and read['input_name'] == 'v_squared'
    assert read['dt'] == 1.0e-4 and read['operating_v_squared'] == 1.0e5
    cells = io.loadmat(tmp_path / 'model.mat')['output_names']
    assert cells.dtype == object and cells.shape == (3, 1)      # a cell array, as ss takes it


def test_files_of_older_releases_are_read(tmp_path):
    """B and D were vectors in the files of plants; units, fit and input came later."""
    ours = model()
    np.savez(tmp_path / 'old.npz', A=ours.a, B=ours.b[:, 0], C=ours.c, D=np.zeros(3), dt=ours.dt,
             operating_v_squared=1.0e5, operating_outputs=ours.operating_outputs,
             output_names=np.array(ours.output_names), v_squared_slack=SLACK,
             v_squared_max=1250.0**2, rest_v_squared=0.0, disturbance_frequency=0.0)
    old = Model.load(tmp_path / 'old.npz')
    assert all(np.array_equal(one, other) for one, other in zip(old.matrices, ours.matrices))
    assert old.fit == {} and old.units == ('m', 'm', '-')


def test_files_that_are_no_models_are_refused(tmp_path):
    np.savez(tmp_path / 'bad.npz', A=np.eye(2))
    with pytest.raises(BadInput, match="bad.npz: not a linear model .it holds no 'output"):
        Model.load(tmp_path / 'bad.npz')
    for content in ('', 'no archive'):
        (tmp_path / 'text.npz').write_text(content)
        with pytest.raises(BadInput, match='text.npz: not a linear model'):
            Model.load(tmp_path / 'text.npz')
    model().save(tmp_path / 'model.npz')
    whole = (tmp_path / 'model.npz').read_bytes()
    (tmp_path / 'half.npz').write_bytes(whole[:len(whole) // 2])
    with pytest.raises(BadInput, match='half.npz: not a linear model'):
        Model.load(tmp_path / 'half.npz')


@pytest.mark.parametrize('code', [
    'from dewing_cli.main import main\ntry:\n    main(["--help"])\nexcept SystemExit:\n    pass',
    'import dewing_sim.wing, dewing_sim.linear.reduced, dewing_sysid.identify, '
    'dewing_control.trial.closed_loop',
    'import dewing_sim.ros.node, dewing_sim.ros.recorder, dewing_sysid.node, dewing_control.node',
    'import sys\nsys.path.insert(0, "test/support")\n'
    'from identified_wing import design_model, identity\n'
    'from dewing_control.law.registry import law\nfrom dewing_control.settings import *\n'
    'from dewing_sim import parameters\nfor kind in ("pid", "periodic", "lqg"):\n'
    '    law(parameters.load("controller", ControllerSettings, {"kind": kind}), identity(),\n'
    '        design_model())'])
def test_python_control_is_not_loaded_on_the_way_to_a_run(code):
    """It costs 1.2 s: neither --help, nor a wing, nor the nodes' laws may import it."""
    found = subprocess.run([sys.executable, '-c', f'{code}\nimport sys\n'
                            'sys.exit(f"control is loaded" if "control" in sys.modules else 0)'],
                           capture_output=True, text=True)
    assert found.returncode == 0, found.stderr

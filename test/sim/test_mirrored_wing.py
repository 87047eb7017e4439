# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Wings at negative and at no angle of attack: mirror images, and what cannot be measured in."""

import json
from dataclasses import replace

import numpy as np
import pytest
from identified_wing import reduced_model

from dewing_cli import main as cli
from dewing_cli.sweep.sweep import run_point
from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings
from dewing_control.trial import closed_loop, trial
from dewing_control.tuning.printed import printed_gains
from dewing_sim import build, parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity, reference_deflection, require_reference
from dewing_sim.structure.camber import peak

REALTIME = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
            'numerics.time_step': 5.0e-4, 'numerics.trim_time': 12.0, 'membrane.elements': 32}
MIRRORED = ('camber_mean', 'camber_max', 'cl_mean', 'cm_mean', 'y_star')
KEPT = ('cd_mean', 'camber_max_x_c', 'tension', 'capacitance_mean')


def case(degrees: float, **changes):
    return parameters.load('paper', changes=REALTIME | {
        'flow.angle_of_attack_deg': degrees} | changes)


def controller(identity: Identity, kind: str = 'pid'):
    return closed_loop.controller(
        parameters.load('controller', ControllerSettings, {'kind': kind}), identity)


@pytest.fixture(scope='module')
def wings():
    return {degrees: build.build_wing(case(degrees)) for degrees in (4.0, -4.0, 0.0)}


def test_a_point_of_a_sweep_at_minus_4_degrees_mirrors_that_at_4():
    here, there = (run_point(case(degrees), 0.005, 0.0) for degrees in (4.0, -4.0))
    assert not here.reason and not there.reason
    for name in MIRRORED:
        assert there.metrics[name] == pytest.approx(-here.metrics[name], rel=1.0e-7)
    for name in KEPT:
        assert there.metrics[name] == pytest.approx(here.metrics[name], rel=1.0e-7)
    assert here.metrics['y_star'] > 0.2 and 0.3 < here.metrics['camber_max_x_c'] < 0.5


def test_the_largest_deflection_has_a_sign_and_the_place_of_its_mirror_image():
    x = np.linspace(0.0, 1.0, 9)
    y = x * (1.0 - x) ** 2
    height, place = peak(x, y)
    assert peak(x, -y) == (-height, place)
    assert height == pytest.approx(4.0 / 27.0, rel=0.02)
    assert peak(x, np.sin(2.0 * np.pi * x) - 0.1 * np.sin(np.pi * x))[0] < 0.0


@pytest.mark.parametrize('kind', ['pid', 'periodic'])
def test_a_controller_holds_a_wing_and_its_mirror_image_alike(wings, kind):
    runs = []
    for degrees in (4.0, -4.0):
        built = wings[degrees]
        runs.append(trial.run(built.plant, built.rest, controller(built.identity, kind), 40,
                              noise=1.0e-3, passive=built.identity.passive('camber_mean')))
    here, there = runs
    assert there.v_squared == pytest.approx(here.v_squared, rel=1.0e-6, abs=1.0e-6)
    assert there.camber == pytest.approx(here.camber, rel=1.0e-8)
    assert here.v_squared.max() > 1.0e3
    gains = [printed_gains(wings[degrees].identity) for degrees in (4.0, -4.0)]
    assert gains[1] == pytest.approx(gains[0]) and gains[0]['kp'] > 0.0


def test_a_wing_without_camber_has_no_controller_and_no_trial(wings):
    flat = wings[0.0]
    assert abs(flat.identity.camber_mean) < 1.0e-9
    assert Identity.from_yaml(flat.identity.to_yaml()) == flat.identity
    for kind in ('pid', 'periodic'):
        with pytest.raises(BadInput, match='passive camber is .* y_ref = 8.4.*angle of attack'):
            controller(flat.identity, kind)
    with pytest.raises(BadInput, match='passive camber is 0 m'):
        trial.run(flat.plant, flat.rest, None, 2, passive=0.0)


def test_a_reference_is_compared_with_y_ref():
    paper = parameters.load('paper')
    y_ref = reference_deflection(paper)
    assert y_ref == pytest.approx(8.42e-5, rel=1.0e-3)
    for sign in (1.0, -1.0):
        assert require_reference('camber', sign * 0.01 * y_ref, paper) == sign * 0.01 * y_ref
        with pytest.raises(BadInput, match='less than 0.001 of y_ref'):
            require_reference('camber', sign * 1.0e-4 * y_ref, paper)
    with pytest.raises(BadInput, match='0 m'):
        require_reference('camber', 0.0, None)


def simulate(folder, *options) -> dict:
    out = folder / 'metrics.json'
    assert cli.main(['simulate', '--duration', '0.01', '--json', str(out), '--force', '--quiet',
                     *(f'--set={name}={value}' for name, value in REALTIME.items()),
                     *options]) == 0
    return json.loads(out.read_text())


def test_no_ratios_of_rounding_errors_are_reported(tmp_path):
    flat = simulate(tmp_path, '--set=flow.angle_of_attack_deg=0.0')
    assert not {'camber_mean_relative', 'camber_amplitude_relative'} & flat.keys()
    assert flat['spectrum_peaks_hz'] == flat['camber_peaks_hz'] == []
    assert abs(flat['y_star']) < 1.0e-6
    down = simulate(tmp_path, '--set=flow.angle_of_attack_deg=-4.0')
    assert abs(down['camber_mean_relative']) < 1.0e-3 and down['y_star'] < -0.2


def test_a_wing_may_start_without_any_trim(tmp_path, capsys):
    started = simulate(tmp_path, '--set=numerics.trim_time=0.0')
    assert started['cl_mean'] > 0.1 and 'camber_mean_relative' not in started
    assert cli.main(['simulate', '--controller', 'controller', '--set=numerics.trim_time=0.0',
                     *(f'--set={name}={value}' for name, value in REALTIME.items()
                       if name != 'numerics.trim_time')]) == 2
    assert 'passive camber is 0 m' in capsys.readouterr().err


def test_the_mirror_image_of_a_model_is_the_same_to_design_on():
    model = reduced_model().model
    mirrored = replace(model, c=-model.c, operating_outputs=-model.operating_outputs)
    one, other = Design.of(model, 'camber_mean'), Design.of(mirrored, 'camber_mean')
    assert np.array_equal(one.c, other.c) and one.static_gain == other.static_gain
    flat = replace(model, operating_outputs=0.0 * model.operating_outputs)
    with pytest.raises(BadInput, match='passive camber is 0 m'):
        Design.of(flat, 'camber_mean')


def test_a_model_of_the_mean_camber_alone_is_a_plant(tmp_path):
    model = reduced_model().model
    alone = replace(model, c=model.c[:1], d=model.d[:1], output_names=('camber_mean',),
                    operating_outputs=-model.operating_outputs[:1], units=model.units[:1])
    alone.save(tmp_path / 'alone.npz')
    built = build.build_reduced(str(tmp_path / 'alone.npz'))
    assert built.identity.camber_max is None and built.identity.camber_mean < 0.0
    assert Identity.from_yaml(built.identity.to_yaml()) == built.identity
    run = trial.run(built.plant, built.rest, controller(built.identity), 20)
    assert np.isfinite(run.camber).all() and run.v_squared.max() > 0.0
    with pytest.raises(BadInput, match='no output camber_max'):
        closed_loop.controller(parameters.load('controller', ControllerSettings, {
            'reference.output': 'camber_max'}), built.identity)

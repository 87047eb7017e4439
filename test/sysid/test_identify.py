# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Identification of a wing-like plant with known poles, and refusals of what cannot be used."""

import json
from dataclasses import replace

import numpy as np
import pytest
from synthetic_plant import DAMPING, FREQUENCIES, SyntheticPlant

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.linear.model import Model
from dewing_sim.machine.jobs import HERE, Workers
from dewing_sim.wing import Wing
from dewing_sysid import experiment, figures, plan
from dewing_sysid.identify import concerns, identify, identify_plant, judge, nrmse_fit, report
from dewing_sysid.settings import Settings

CASE = parameters.load('paper')


def identity_of(plant, case=CASE):
    return Identity.of('synthetic', plant, plant.rest(),
                       case.actuation.voltage_limit**2,
                       parameters.to_mapping(case))


PAPER = identity_of(SyntheticPlant())


def settings(**changes):
    names = {'experiment__': 'experiment.', 'fresh__': 'fresh.', 'realisation__': 'realisation.'}
    changed = {'realisation.order': 8, 'realisation.at_once': 'hankel', 'realisation.window': 1.2}
    for key, value in changes.items():
        for prefix, dotted in names.items():
            key = key.replace(prefix, dotted)
        changed[key] = value
    return parameters.load('sysid', Settings, changed)


def found_on(plant, chosen, case=CASE, start=None, workers=HERE):
    start = plant.rest() if start is None else start
    return identify_plant(plant, start, identity_of(plant, case), chosen, workers=workers)


@pytest.fixture(scope='module')
def pulsed():
    return found_on(SyntheticPlant(), settings())


def test_a_membrane_that_lies_flat_is_not_identified(pulsed):
    """What V^2 moves without a passive camber are rounding errors, and no model of it is made."""
    flat = replace(PAPER, camber_mean=3.0e-12, camber_max=-4.0e-12)
    complaint = r'the passive camber is -4e-12 m, less than 0.001 of y_ref .* angle of attack'
    with pytest.raises(BadInput, match=complaint):
        identify_plant(SyntheticPlant(), None, flat, settings())        # before any step
    with pytest.raises(BadInput, match=complaint):
        identify(pulsed.records, settings(), flat)
    deep = replace(PAPER, camber_mean=3.0e-12, camber_max=-4.0e-5)      # an S, or upside down
    assert plan.make(settings(), deep).names == plan.make(settings(), PAPER).names
    no_camber = replace(PAPER, camber_mean=None, camber_max=None)
    assert plan.make(settings(), no_camber, ('cl',)).names == ('cl',)


def test_pulse_gives_the_poles_of_the_plant(pulsed):
    frequency, damping = pulsed.model.modes()
    assert frequency[-3:] == pytest.approx(FREQUENCIES, rel=1e-6)
    assert damping[-3:] == pytest.approx(DAMPING, rel=1e-5)
    assert damping[:2] == pytest.approx([1.0, 1.0])


def test_every_record_is_reproduced(pulsed):
    assert set(pulsed.model.fit) == {'window', 'experiment', 'half', 'prbs', 'chirp'}
    for fits in pulsed.model.fit.values():
        assert min(fits.values()) > 99.99


@pytest.mark.parametrize('at_once, order', [('hankel', 8), ('state', 9)])
def test_the_response_at_once_may_have_a_state_of_its_own(at_once, order):
    found = found_on(SyntheticPlant(), settings(realisation__at_once=at_once,
                                                realisation__order=order))
    assert found.model.order == order
    assert found.model.modes()[0][-3:] == pytest.approx(FREQUENCIES, rel=1e-6)
    assert min(found.model.fit['prbs'].values()) > 99.99


def test_first_sample_is_untouched_and_the_second_is_the_first_markov_parameter(pulsed):
    record, model = pulsed.records['experiment'], pulsed.model
    assert not record.y[:, 0].any()
    assert record.y[:, 1] == pytest.approx((model.c @ model.b)[:, 0] * record.u[0], rel=1e-9)
    assert not model.d.any()


def test_report_is_json_with_the_names_of_the_command(pulsed):
    written = json.loads(json.dumps(report(pulsed), allow_nan=False))
    assert written['fit']['camber_mean'] > 99.99
    assert written['fit_fresh']['cl'] > 99.99
    assert written['order'] == 8
    assert written['spectral_radius'] < 1.0
    assert len(written['poles_hz']) == len(written['poles_damping']) == 5


def test_a_good_model_raises_no_concern(pulsed):
    assert concerns(pulsed, settings()) == []


def test_doubts_are_put_into_words(pulsed):
    record = pulsed.records['experiment']
    wavy = replace(record, outputs=record.outputs + np.linspace(0.0, 1.0, len(record.u)),
                   baseline=record.baseline + np.linspace(0.0, 1.0, len(record.u)))
    doubtful = replace(pulsed, model=replace(pulsed.model, a=1.1 * pulsed.model.a),
                       records={'experiment': wavy}, linearity={'cl': 0.5})
    unstable, nonlinear, unsteady = concerns(doubtful, settings())
    assert 'unstable' in unstable
    assert 'cl responds to half the amplitude with a departure of 50 %' in nonlinear
    assert unsteady.startswith('camber_mean, camber_max, cl moves more at rest')


def test_figures_are_written(pulsed, tmp_path):
    paths = figures.save(pulsed, tmp_path / 'figures')
    assert [path.stem for path in paths] == ['response', 'singular_values', 'bode', 'poles',
                                             'fresh']
    assert all(path.read_bytes().startswith(b'\x89PNG') for path in paths)


def test_swept_sine_estimates_the_frequency_response(pulsed):
    frequency, estimate = figures.swept_sine(pulsed.records['chirp'])
    assert 5.0 <= frequency.min() < 15.0 and 380.0 < frequency.max() < 800.0
    band = (frequency > 30.0) & (frequency < 300.0)
    exact = pulsed.model.frequency_response(frequency[band])
    assert np.count_nonzero(band) > 40
    assert np.max(np.abs(estimate[:, band] - exact) / np.abs(exact).max(axis=1)[:, None]) < 0.05


def test_fit_grows_with_order(pulsed):
    fits = [pulsed.by_order[order]['window']['camber_mean'] for order in (2, 4, 6, 8)]
    assert np.all(np.diff(fits) > 0.0)


def test_a_linear_plant_passes_the_linearity_check(pulsed):
    assert max(pulsed.linearity.values()) < 1e-9


def test_a_hardening_plant_fails_the_linearity_check():
    found = found_on(SyntheticPlant(hardening=1e-6), settings())
    # a (1 + g a) against 2 (a/2)(1 + g a/2) at g a = 0.16: g a / 2 / (1 + g a)
    assert found.linearity['cl'] == pytest.approx(0.08 / 1.16, rel=1e-6)


@pytest.mark.parametrize('kind', ['prbs', 'chirp', 'step'])
def test_other_experiments_give_the_same_poles(kind):
    found = found_on(SyntheticPlant(), settings(experiment__kind=kind, experiment__hold=4))
    assert found.model.modes()[0][-3:] == pytest.approx(FREQUENCIES, rel=1e-3)
    assert min(found.model.fit['prbs'].values()) > 99.5


def test_a_doublet_about_a_raised_operating_point_gives_the_same_poles():
    raised = parameters.replace(CASE, {'actuation.voltage': 500.0})
    chosen = settings(experiment__kind='doublet', experiment__hold=2)
    plant = SyntheticPlant()
    start = plant.rest()
    for _ in range(200):
        start = plant.step(start, Inputs(500.0**2))
    found = found_on(plant, chosen, raised, start)
    assert found.model.operating_v_squared == 500.0**2
    assert found.model.modes()[0][-3:] == pytest.approx(FREQUENCIES, rel=1e-3)


@pytest.fixture
def always_processes(monkeypatch):
    """Let the shortest experiments have processes of their own."""
    monkeypatch.setattr(experiment, 'WORTH_PROCESSES', 0)
    return [HERE, Workers(2)]


def test_few_steps_are_made_in_this_process(monkeypatch):
    monkeypatch.setattr(experiment, 'results', None)
    assert found_on(SyntheticPlant(), settings(), workers=Workers(2)).records


def test_two_processes_give_the_records_of_one(always_processes):
    one, two = (found_on(SyntheticPlant(), settings(), workers=n).records
                for n in always_processes)
    assert list(one) == list(two)
    for run in one:
        assert np.array_equal(one[run].outputs, two[run].outputs)


def test_records_survive_their_file(pulsed, tmp_path):
    experiment.save_records(tmp_path / 'r.npz', pulsed.records, PAPER)
    loaded, identity = experiment.load_records(tmp_path / 'r.npz')
    assert identity == PAPER
    assert list(loaded) == list(pulsed.records)
    again = identify(loaded, settings(), PAPER)
    assert np.array_equal(again.model.a, pulsed.model.a)


def test_a_single_record_is_enough(pulsed):
    alone = identify({'experiment': pulsed.records['experiment']}, settings(), PAPER)
    assert np.array_equal(alone.model.a, pulsed.model.a)
    assert alone.linearity == {}


def test_model_survives_its_file(pulsed, tmp_path):
    pulsed.model.save(tmp_path / 'm.npz')
    loaded = Model.load(tmp_path / 'm.npz')
    for name in 'abcd':
        assert np.array_equal(getattr(loaded, name), getattr(pulsed.model, name))
    assert loaded.fit == pulsed.model.fit
    assert (loaded.output_names, loaded.units) == (experiment.STANDARD, ('m', 'm', '-'))
    assert loaded.dt == 1.0e-4
    (tmp_path / 'case.yaml').write_text(loaded.case_yaml)
    assert parameters.load(str(tmp_path / 'case.yaml')) == CASE
    assert loaded.operating_outputs == pytest.approx([1.8e-5, 2.7e-5, 0.395])


def test_model_file_runs_as_a_plant(pulsed, tmp_path):
    pulsed.model.save(tmp_path / 'm.npz')
    plant = reduced.load(tmp_path / 'm.npz')
    record = pulsed.records['prbs']
    outputs = experiment.run(plant, plant.rest(), record.names, record.v_squared)
    assert np.min(nrmse_fit(record.outputs, outputs)) > 99.99


def test_model_file_that_is_none_is_refused(tmp_path):
    (tmp_path / 'x.npz').write_text('no archive')
    with pytest.raises(BadInput, match='not a linear model'):
        Model.load(tmp_path / 'x.npz')
    with pytest.raises(BadInput, match='no such file'):
        Model.load(tmp_path / 'y.npz')


def test_frequency_response_is_that_of_the_simulated_sine(pulsed):
    frequency = 50.0
    u = np.sin(2.0 * np.pi * frequency * 1.0e-4 * np.arange(60000))
    tail = slice(-2000, None)           # ten periods
    phase = np.exp(-2j * np.pi * frequency * 1.0e-4 * np.arange(60000))[tail]
    measured = 2j * np.mean(pulsed.model.simulate(u)[:, tail] * phase, axis=1)
    assert np.allclose(pulsed.model.frequency_response([frequency])[:, 0], measured, rtol=1e-6)


def test_unstable_model_is_judged_with_a_finite_number(pulsed):
    growing = replace(pulsed.model, a=3.0 * pulsed.model.a)
    assert judge(growing, pulsed.records)['prbs']['cl'] == -1.0e6


def test_fit_of_the_record_itself_is_a_hundred_and_of_its_mean_zero():
    y = np.array([[1.0, 2.0, 4.0]])
    assert nrmse_fit(y, y)[0] == 100.0
    assert nrmse_fit(y, np.full_like(y, y.mean()))[0] == pytest.approx(0.0)


@pytest.mark.parametrize('kind, levels', [('pulse', 1), ('doublet', 2), ('prbs', 1)])
def test_levels_that_outlast_the_record_are_refused_with_the_longest_there_are(kind, levels):
    chosen = {'experiment__kind': kind, 'experiment__record': 2.0}
    length = plan.samples(2.0, plan.time_scale(PAPER), PAPER.dt)
    most = (length - 1) // levels
    with pytest.raises(BadInput, match=f'experiment.hold = {most + 1} .* at most {most} with '):
        plan.make(settings(experiment__hold=most + 1, **chosen), PAPER)
    made = plan.make(settings(experiment__hold=most, **chosen), PAPER)
    lasts = np.argmax(np.diff(made.inputs[plan.EXPERIMENT]) != 0.0) + 1
    assert lasts == most or kind == 'prbs'      # whose next bit may be the same
    with pytest.raises(BadInput, match='fresh.hold = 10000 samples is out of range'):
        plan.make(settings(fresh__hold=10000), PAPER)


def test_a_pulse_above_the_voltage_limit_is_refused_with_both_voltages():
    with pytest.raises(BadInput, match='1400 V.*1250 V.*1300 V'):
        plan.make(settings(experiment__amplitude=1400.0), PAPER)


def test_a_pulse_that_slackens_the_membrane_is_refused():
    plant = SyntheticPlant(v_squared_slack=350.0**2)
    with pytest.raises(BadInput, match='V = 400 V slackens the membrane in step 1'):
        experiment.run(plant, plant.rest(), ['cl'], np.full(3, 400.0**2))


def test_a_window_longer_than_the_record_is_refused():
    with pytest.raises(BadInput, match='record = 0.5 c/U is too short'):
        plan.make(settings(experiment__record=0.5), PAPER)


def test_an_order_the_window_cannot_carry_is_refused():
    with pytest.raises(BadInput, match='order = 8 cannot be realised'):
        found_on(SyntheticPlant(), settings(realisation__window=0.05))


def test_an_output_without_response_is_refused(pulsed):
    record = pulsed.records['experiment']
    still = record.outputs.copy()
    still[1] = record.baseline[1]
    with pytest.raises(BadInput, match='camber_max is constant'):
        identify({'experiment': replace(record, outputs=still)}, settings(), PAPER)


@pytest.mark.parametrize('field, name', [('outputs', 'cl'), ('baseline', 'cl')])
def test_nan_is_refused_where_it_stands(pulsed, field, name):
    record = pulsed.records['experiment']
    broken = getattr(record, field).copy()
    broken[2, 17] = np.nan
    with pytest.raises(BadInput, match=f'{name} is not finite at sample 17'):
        replace(record, **{field: broken})


@pytest.mark.parametrize('dt', [0.0, -1.0e-4, np.nan])
def test_a_wrong_time_step_is_refused(pulsed, dt):
    with pytest.raises(BadInput, match='dt'):
        replace(pulsed.records['experiment'], dt=dt)


def test_a_record_of_another_time_step_is_refused(pulsed):
    record = replace(pulsed.records['experiment'], dt=2.0e-4)
    with pytest.raises(BadInput, match='dt = 0.0002 s, the plant 0.0001 s'):
        identify({'experiment': record}, settings(), PAPER)


def test_shapes_that_do_not_fit_are_refused(pulsed):
    record = pulsed.records['experiment']
    with pytest.raises(BadInput, match='do not fit'):
        replace(record, v_squared=record.v_squared[:-1])


def test_an_unknown_output_is_refused():
    with pytest.raises(BadInput, match="'lift' is unknown"):
        plan.make(settings(), PAPER, ['lift'])
    with pytest.raises(BadInput, match='mode_1 needs a membrane'):
        experiment.run(SyntheticPlant(), SyntheticPlant().rest(), ['mode_1'], np.zeros(2))


@pytest.mark.parametrize('engine, grid', [('conformal', 'realtime'), ('finite_volume', 'fast')])
def test_a_wing_moves_alike_in_processes_of_its_own(engine, grid, always_processes):
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': engine, 'numerics.grid': grid, 'numerics.trim_time': 0.2}))
    inputs = [np.full(4, v_squared) for v_squared in (0.0, 2.5e5)]
    here, there = (experiment.run_all(wing, wing.rest(), ('camber_mean', 'cl'), inputs, workers)
                   for workers in always_processes)
    assert np.array_equal(here, there)

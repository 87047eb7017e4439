# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The registry of laws: what they declare, a law from outside in one file, and refused designs."""

import dataclasses
import math
import pickle
import re
import sys
from pathlib import Path

import pytest
from hypothesis import given, strategies
from identified_wing import CAMBER, design_model, identity, reduced_model
from outside_law import INTEGRATOR, KIND

from dewing_cli.main import main
from dewing_control.law.base import Law
from dewing_control.law.registry import LAWS, law
from dewing_control.settings import ControllerSettings, value_of
from dewing_control.trial.closed_loop import closed_loop, controller, same_memory
from dewing_control.tuning.bounds import Bounds
from dewing_control.tuning.tuning import tune
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.linear import reduced
from dewing_sim.plant import Measurement

PROJECT = Path(__file__).parents[2]
COARSE = ['--grid', 'fast', '--set', 'numerics.trim_time=0.1', '--set', 'membrane.elements=16']


@pytest.fixture
def outside(tmp_path, monkeypatch):
    """Write the law into the working folder; return how to write others."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, 'path', [*sys.path])
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))

    def write(text, name='my_integrator'):
        (tmp_path / f'{name}.py').write_text(text)
        sys.modules.pop(name, None)
    write(INTEGRATOR)
    yield write
    for name in [name for name in sys.modules if name.startswith('my_')]:
        del sys.modules[name]


def settings(kind=KIND, **changes):
    changes = {name.replace('__', '.'): value for name, value in changes.items()}
    return parameters.load('controller', ControllerSettings, {'kind': kind, **changes})


# What dewing's own laws declare.

@pytest.mark.parametrize('kind', LAWS)
def test_a_law_declares_what_others_read(kind):
    found = LAWS[kind]
    assert found.kind == kind and found.title and found.about and found.sections
    shipped = settings(kind)
    for name, (low, high) in found.ranges.items():
        assert low < value_of(shipped, name) < high
    for name in (*found.memory, *found.ranges):
        assert name.partition('.')[0] in found.sections
    assert found.compensator is not Law.compensator


def test_the_page_on_control_shows_what_the_laws_declare():
    table = dict(re.findall(r'^\| `(\w+)` \| (.*?) \| `\w+\.py`.*\|$',
                            (PROJECT / 'docs' / 'control.md').read_text(), re.M))
    assert table == {kind: found.about for kind, found in LAWS.items()}
    shipped = (PROJECT / 'config' / 'controller.yaml').read_text()
    assert f"# {', '.join(LAWS)}" in shipped


def test_sections_that_a_kind_does_not_use_lie_idle():
    one, other = settings('pid'), settings('pid', mpc__moves=7, lqg__control_weight=0.3)
    assert one != other and law(one, identity()) == law(other, identity())
    assert same_memory(one, other)
    assert not same_memory(settings('mpc'), settings('mpc', mpc__moves=7))


@pytest.mark.parametrize('kind', LAWS)
def test_settings_survive_pickle_and_yaml(kind):
    chosen = settings(kind, reference__target=1.07)
    assert pickle.loads(pickle.dumps(chosen)) == chosen
    assert parameters.from_yaml(parameters.to_yaml(chosen), ControllerSettings) == chosen


def test_an_unknown_kind_is_an_error_that_names_the_kinds():
    with pytest.raises(BadInput, match='fuzzy.*pid, periodic, lqg, mpc or package.module:Name'):
        settings('fuzzy')
    with pytest.raises(BadInput, match='fuzzy.*pid, periodic, lqg, mpc or package.module:Name'):
        law(dataclasses.replace(settings('pid'), kind='fuzzy'), identity(), design_model())


# A law from outside.

def test_its_section_is_there_while_it_is_the_kind(outside):
    chosen = settings(my_gain__rate=4.0)
    assert chosen.my_gain.rate == 4.0 and chosen.my_gain.delay == 0
    assert pickle.loads(pickle.dumps(chosen)) == chosen
    assert parameters.from_yaml(parameters.to_yaml(chosen), ControllerSettings) == chosen
    back = parameters.replace(chosen, {'kind': 'pid'})
    assert back == settings('pid') and type(back) is ControllerSettings
    with pytest.raises(BadInput, match='my_gain.rate = -1.0 is out of range'):
        settings(my_gain__rate=-1.0)
    with pytest.raises(BadInput, match='my_gain is not a parameter'):
        settings('pid', my_gain__rate=4.0)


def test_it_holds_the_target_and_says_when_its_memory_is_of_another_form(outside):
    plant = reduced_model()
    loop = closed_loop(plant, plant.rest(), controller(settings(), identity()), 6000)
    *_, (_, outputs) = loop
    assert outputs.camber_mean / identity().camber_mean == pytest.approx(1.10, abs=1.0e-3)
    assert same_memory(settings(), settings(my_gain__rate=5.0))
    assert not same_memory(settings(), settings(my_gain__delay=1))


def test_it_is_tuned_in_its_own_ranges(outside):
    best = tune(settings(my_gain__rate=0.2), identity(), design_model(), Bounds(), generations=2)
    assert best.stable and best.peak <= Bounds.sensitivity
    assert 0.2 < best.settings.my_gain.rate < 100.0


def test_simulate_takes_it_and_compare_takes_it_in_other_processes(outside, tmp_path, capsys):
    (tmp_path / 'my.yaml').write_text(parameters.to_yaml(settings()))
    assert main(['simulate', *COARSE, '--controller', 'my.yaml', '--duration', '0.0005',
                 '--skip', '0.0', '--json', 'run.json']) == 0
    reduced.save('model.npz', reduced_model())
    assert main(['compare', *COARSE, '--settings', 'my.yaml', '--model', 'model.npz',
                 '--scenarios', 'step,target_1', '--controllers', f'pid_tuned,{KIND}', '--jobs',
                 '2', '--duration', '0.02', '--out', 'out']) == 0, capsys.readouterr().err
    table = (tmp_path / 'out' / 'table.md').read_text()
    assert table.count(f'| {KIND} |') == 2


# What is refused, and how.

BROKEN = {
    'class Law:\n    pass\n': 'it does not inherit Law of dewing_control.law.base',
    'from dewing_control.law.base import Law as Base\nclass Law(Base):\n    pass\n':
        'it does not define of, start, step',
    '1 / 0\n': 'cannot be imported .ZeroDivisionError: division by zero',
    INTEGRATOR.replace("'my_gain': Gain", "'my_gain': float") + 'Law = Integrator\n':
        'its section my_gain is no dataclass of fields declared by real, count, choice and text',
    INTEGRATOR.replace("'my_gain': Gain", "'pid': Gain").replace('ranges = ', 'no_ranges = ')
    .replace('memory = (', 'no_memory = (') + 'Law = Integrator\n':
        'its section pid has the name of another; taken are kind, model, ',
    INTEGRATOR.replace('(0.1, 100.0)', '(0.0, 100.0)') + 'Law = Integrator\n':
        'its range of my_gain.rate is not that of a positive setting',
    INTEGRATOR.replace("('my_gain.delay',)", "('my_gain.age',)") + 'Law = Integrator\n':
        'its memory depends on my_gain.age, which is not in its sections',
    INTEGRATOR.replace("{'my_gain': Gain}", '[Gain]') + 'Law = Integrator\n':
        'its declarations cannot be read .AttributeError',
    INTEGRATOR.replace('default=9.0', 'default=-9.0') + 'Law = Integrator\n':
        'my_gain.rate = -9.0 is out of range',
    INTEGRATOR.replace('own.rate * period', 'own.speed * period') + 'Law = Integrator\n':
        "cannot be designed with these settings .AttributeError: 'Gain' object has no attribute",
    INTEGRATOR.replace('(v_squared, errors[:-1]), v_squared', 'v_squared') + 'Law = Integrator\n':
        'cannot be designed with these settings .TypeError',
    INTEGRATOR.replace('(v_squared, errors[:-1]), v_squared', 'memory, np.nan')
    + 'Law = Integrator\n': 'it answers the plant at rest with V.2 = nan',
}


@pytest.mark.parametrize('number', range(len(BROKEN)))
def test_a_broken_law_gives_one_sentence(outside, number):
    text, reason = list(BROKEN.items())[number]
    outside(text, f'my_broken_{number}')
    kind = f'my_broken_{number}:Law'
    with pytest.raises(BadInput, match=reason) as caught:
        law(settings(kind), identity(), design_model())
    assert '\n' not in str(caught.value)


def test_a_law_that_fails_in_flight_ends_the_run_with_one_sentence(outside):
    outside(INTEGRATOR.replace('v_squared, errors = memory', 'v_squared, errors = memory\n'
                               '        1 / (measurement.time < 0.002)'))
    loop = closed_loop(reduced_model(), reduced_model().rest(),
                       controller(settings(), identity()), 100)
    with pytest.raises(RunFailed, match='law failed at 0.002 s .ZeroDivisionError'):
        list(loop)


def test_what_cannot_be_tuned_says_so(outside):
    outside(INTEGRATOR.replace('ranges = ', 'no_ranges = ').replace('def compens', 'def no_comp'))
    with pytest.raises(BadInput, match='cannot be tuned: it has no ranges and no compensator'):
        tune(settings(), identity(), design_model(), Bounds())


def test_a_compensator_of_another_shape_is_refused(outside):
    outside(INTEGRATOR.replace('Matrices.siso(np.eye(1),', 'Matrices.siso(np.eye(2),'))
    with pytest.raises(BadInput, match='cannot be designed with these settings .ValueError'):
        tune(settings(), identity(), design_model(), Bounds())


def test_what_a_law_asks_for_is_kept_within_the_limits(outside):
    outside(INTEGRATOR.replace('min(max(v_squared, 0.0), self.v_squared_max)',
                               '3.0e6 * math.cos(1.0e4 * measurement.time)')
            .replace('import numpy', 'import math\n\nimport numpy'))
    chosen = settings(command__voltage_limit=500.0)
    loop = controller(chosen, identity())
    memory, asked = loop.start(), []
    for step in range(40):
        memory, v_squared = loop.step(
            memory, Measurement(1.0e-4 * step, CAMBER, CAMBER, 0.4, 0.06, 0.0))
        asked.append(v_squared)
    assert min(asked) == 0.0 and max(asked) == 500.0**2


BASED_ON_LQG = """
from dataclasses import dataclass

from dewing_control.law.lqg import Lqg
from dewing_sim.parameters import real


@dataclass(frozen=True)
class Trust:
    share: float = real('-', 'of the voltage asked for', 0.1, 1.0, default=0.5)


class Half(Lqg):
    about = 'an LQG that goes half way'
    sections = {**Lqg.sections, 'my_trust': Trust}

    @classmethod
    def of(cls, settings, identity, model):
        made = super().of(settings, identity, model)
        object.__setattr__(made, 'share', settings.my_trust.share)
        return made

    def step(self, memory, measurement):
        memory, v_squared = super().step(memory, measurement)
        return memory, self.share * v_squared
"""


def test_a_law_from_outside_builds_on_one_of_dewing_s_and_its_model(outside):
    outside(BASED_ON_LQG, 'my_half')
    chosen = parameters.replace(settings('my_half:Half'), {'lqg.control_weight': 0.5})
    made = law(chosen, identity(), design_model())
    base = law(parameters.replace(chosen, {'kind': 'lqg'}), identity(), design_model())
    sample = Measurement(0.0, 1.01 * CAMBER, CAMBER, 0.4, 0.06, 0.0)
    answers = [each.step(each.start(1.0e5), sample)[1] for each in (made, base)]
    assert answers[0] == 0.5 * answers[1] > 0.0
    with pytest.raises(BadInput, match='model is empty'):
        law(chosen, identity())


@pytest.mark.parametrize('kind', ['periodic', 'lqg', 'mpc'])
@pytest.mark.parametrize('changes', [
    {'disturbance_model.frequency': 5000.0},
    {'disturbance_model.frequency': 500.0, 'disturbance_model.harmonics': 10}])
def test_oscillators_at_or_above_half_the_sampling_rate_are_refused(kind, changes):
    pytest.importorskip('osqp')
    chosen = parameters.replace(settings(kind), changes)
    with pytest.raises(BadInput, match='it must stay below 5000 Hz'):
        law(chosen, identity(), design_model())


IMPOSSIBLE = {'estimator.sensor_noise': 1.0e-3, 'estimator.load_noise': 0.0,
              'estimator.drift': 1.0e3, 'estimator.oscillation': 1.0e-12,
              'disturbance_model.harmonics': 20}


def test_weights_for_which_no_filter_is_found_are_refused():
    chosen = parameters.replace(settings('lqg'), IMPOSSIBLE)
    with pytest.raises(BadInput, match='kind = lqg cannot be designed with these settings .Lin'):
        law(chosen, identity(), design_model())


def drawn(kind):
    """Return a strategy for changes of the settings of a law, anywhere in their ranges."""
    leaves = {f'{name}.{leaf}': field.metadata for name, section in LAWS[kind].sections.items()
              for leaf, field in parameters.fields(section) if 'low' in field.metadata}
    return strategies.fixed_dictionaries({}, optional={
        name: strategies.integers(meta['low'], meta['high']) if meta['type'] is int else
        strategies.floats(math.log(max(meta['low'], 1.0e-12)), math.log(meta['high'])).map(
            lambda logarithm, meta=meta: min(max(math.exp(logarithm), meta['low']), meta['high']))
        for name, meta in leaves.items()})


@pytest.mark.parametrize('kind', ['pid', 'periodic', 'lqg'])
@given(data=strategies.data())
def test_any_settings_give_a_law_within_its_bounds_or_one_sentence(kind, data):
    changed = parameters.replace(settings(kind), data.draw(drawn(kind)))
    try:
        made = law(changed, identity(), design_model())
    except BadInput as error:
        assert '\n' not in str(error)
        return
    memory = made.start(1.0e5)
    for step in range(20):
        camber = CAMBER * (1.0 + 0.1 * math.sin(step))
        memory, v_squared = made.step(
            memory, Measurement(step * 1.0e-4, camber, camber, 0.4, 0.06, 0.0))
        assert 0.0 <= v_squared <= made.v_squared_max

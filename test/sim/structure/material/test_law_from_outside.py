# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A law of elasticity from outside the package, in one file: it flies a wing on both elements."""

import json
import pickle
import sys

import numpy as np
import pytest

from dewing_cli import main as cli
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.inputs.base import Inputs
from dewing_sim.rest import trim
from dewing_sim.schema import plugins
from dewing_sim.structure import elements
from dewing_sim.structure.material import constants, registry
from dewing_sim.structure.sheet import Sheet
from dewing_sim.wing import Wing

YEOH = '''
from dataclasses import dataclass

from dewing_sim.schema import real
from dewing_sim.structure.material.forms import InvariantLaw


@dataclass(frozen=True)
class Yeoh(InvariantLaw):
    """W = C1 (I1bar - 3) + C2 (I1bar - 3)^2."""

    c1: float = real('Pa', 'C1', 1.0e2, 1.0e8)
    c2: float = real('Pa', 'C2', 0.0, 1.0e8, default=0.0)

    @staticmethod
    def density(i1, i2, k):
        return k.c1 * (i1 - 3.0) + k.c2 * (i1 - 3.0) ** 2

    @staticmethod
    def derivatives(i1, i2, k):
        return k.c1 + 2.0 * k.c2 * (i1 - 3.0), 0.0, 2.0 * k.c2, 0.0, 0.0
'''
FLIGHT = {'numerics.engine': 'finite_volume', 'numerics.grid': 'fast', 'numerics.trim_time': 0.3,
          'membrane.elements': 24, 'membrane.support': 'middle', 'actuation.voltage_limit': 800.0}


@pytest.fixture
def law(own_folder, monkeypatch):
    """Return a function that writes the law into a module here and returns its word."""
    written = []

    def write(name, text=YEOH):
        (own_folder / f'{name}.py').write_text(text)
        written.append(name)
        return f'{name}:Yeoh'
    monkeypatch.syspath_prepend(str(own_folder))
    yield write
    for name in written:
        sys.modules.pop(name, None)


def assignments(changes):
    return [part for name, value in changes.items() for part in ('--set', f'{name}={value}')]


def run(path, changes, *options):
    """Return what ``dewing simulate`` finds over ten steps."""
    assert cli.main(['simulate', *assignments({**FLIGHT, **changes}), '--voltage', '300',
                     '--duration', '0.001', '--quiet', '--force', '--json', str(path),
                     *options]) == 0
    return json.loads(path.read_text())


@pytest.mark.parametrize('element', ['membrane', 'solid'])
def test_it_flies_a_wing_by_command_and_offline(law, element, tmp_path):
    changes = {'membrane.law': law('yeoh_flown'), 'membrane.element': element,
               'membrane.constants.c1': 1.0e4, 'membrane.constants.c2': 50.0}
    found = run(tmp_path / 'yeoh.json', changes, '--out', str(tmp_path / 'run.npz'))
    wing = Wing(parameters.load('paper', changes={**FLIGHT, **changes}))
    state = wing.rest()
    for _ in range(10):
        state = wing.step(state, Inputs(9.0e4))
    last = np.load(tmp_path / 'run.npz')
    assert wing.observe(state).camber_mean == last['camber_mean'][-1]
    # C2 stiffens: the flat membrane has the tension of the closed form.
    l1 = 1.5
    i1 = l1 ** 2 + l1 ** -2 + 1.0
    stress = 2.0 * (1.0e4 + 2.0 * 50.0 * (i1 - 3.0)) * (l1 ** 2 - l1 ** -2)
    assert wing.membrane.rest_tension(0.0) * wing.scales.tension == pytest.approx(
        stress * 5.0e-5 / l1, rel=2e-4)
    assert found['steps'] == 10


@pytest.mark.parametrize('element', ['membrane', 'solid'])
def test_without_its_second_term_it_is_neo_hooke_as_mooney_rivlin(law, element):
    section = parameters.replace(parameters.load('paper').membrane, {
        'element': element, 'elements': 12, 'support': 'middle'})
    own, known = (elements.make(parameters.replace(section, changes)) for changes in (
        {'law': law('yeoh_alone'), 'constants': {'c1': 1.0e4}},
        {'law': 'mooney_rivlin', 'constants': {'c10': 1.0e4}}))
    assert own.equilibrium(1.0, 1.0e5) == pytest.approx(known.equilibrium(1.0, 1.0e5), abs=1e-12)


def test_a_changed_law_changes_kernels_and_kept_results(law):
    case = parameters.load('paper', changes={**FLIGHT, 'membrane.constants.c1': 1.0e4,
                                             'membrane.law': law('yeoh_before')})
    other = parameters.replace(case, {
        'membrane.law': law('yeoh_after', YEOH.replace('2.0 * k.c2', '3.0 * k.c2'))})
    same = parameters.replace(case, {'membrane.law': law('yeoh_same')})
    kinds = [type(Sheet.from_parameters(each.membrane).elastomer.constants)
             for each in (case, other, same)]
    assert kinds[0] is not kinds[1] and kinds[0] is kinds[2]
    assert trim.fingerprint(Wing(case)) != trim.fingerprint(Wing(other))


def test_what_kernels_are_kept_by_can_be_read_without_the_law(law):
    section = parameters.replace(parameters.load('paper').membrane, {
        'law': law('yeoh_gone'), 'constants': {'c1': 1.0e4}})
    kind = type(Sheet.from_parameters(section).elastomer.constants)
    kept = pickle.dumps(kind)
    assert b'yeoh_gone' not in kept and pickle.loads(kept) is kind
    again = constants.__getattr__(kind.__name__)
    assert again._fields == ('c1', 'c2', 'bulk', 'eps')
    with pytest.raises(AttributeError):
        getattr(constants, 'nothing')  # noqa: B009, as pickle does


@pytest.mark.parametrize('changes, complaint', [
    ({}, 'membrane.constants.c1 is missing: C1 [Pa], from 100 to 1e+08'),
    ({'membrane.constants.c1': '1.0'}, 'membrane.constants.c1 = 1.0 is out of range: C1 [Pa]'),
    ({'membrane.constants.c3': '1.0'}, 'membrane.constants.c3 is not a parameter; known here:')])
def test_its_constants_are_checked_with_exit_status_2(law, capsys, changes, complaint):
    everything = {**FLIGHT, 'membrane.law': law('yeoh_checked'), **changes}
    assert cli.main(['simulate', *assignments(everything), '--duration', '0.001']) == 2
    error = capsys.readouterr().err
    assert complaint in error and error.count('\n') == 1


def test_a_law_whose_slopes_are_not_those_of_its_energy_is_refused(law):
    section = parameters.replace(parameters.load('paper').membrane, {
        'law': law('yeoh_wrong', YEOH.replace('return k.c1 + 2.0', 'return k.c1 + 1.0')),
        'constants': {'c1': 1.0e4, 'c2': 1.0e3}})
    with pytest.raises(BadInput, match="'yeoh_wrong:Yeoh': its derivatives are not those of its"):
        registry.law_of(section)


def test_a_law_that_cannot_be_loaded_is_refused(law):
    assert issubclass(plugins.load(law('yeoh_loaded'), 'membrane.law'), registry.Law)
    section = parameters.replace(parameters.load('paper').membrane,
                                 {'law': 'yeoh_loaded:Nothing'})
    with pytest.raises(BadInput, match='the module yeoh_loaded has no Nothing'):
        registry.law_of(section)

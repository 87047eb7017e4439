# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Strict loading: every wrong file or value is refused with its name, unit and range."""

import copy
import dataclasses
import math
import pickle
from dataclasses import dataclass

import pytest
from drawn_cases import mappings
from hypothesis import given

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.parameters import Case, Flow, choice, from_mapping, real
from dewing_sim.schema import Numbers

PAPER = parameters.to_mapping(parameters.load('paper'))
LEAVES = dict(parameters.fields(Case))
REQUIRED = [name for name, field in LEAVES.items() if 'default' not in field.metadata]
OPEN = [name for name, field in LEAVES.items() if field.type is Numbers]
NUMBERS = {name: field for name, field in LEAVES.items() if 'low' in field.metadata}


def changed(name: str, value) -> dict:
    """Return the mapping of the paper case with one dotted name set, without any check."""
    mapping = copy.deepcopy(PAPER)
    section, key = name.split('.')
    mapping[section][key] = value
    return mapping


def test_the_paper_case_has_the_paper_s_reynolds_number():
    case = parameters.load('paper')
    reynolds = case.flow.speed * case.membrane.chord / case.flow.kinematic_viscosity
    assert reynolds == pytest.approx(2500.0, rel=1e-4)
    assert case.flow.dynamic_pressure == pytest.approx(0.9075, rel=1e-4)
    assert case.flow.angle_of_attack == pytest.approx(math.pi / 45.0)


@pytest.mark.parametrize('name', LEAVES)
def test_every_field_declares_type_meaning_and_range(name):
    metadata = LEAVES[name].metadata
    assert metadata['meaning'] and LEAVES[name].type is metadata['type']
    assert metadata.get('options') or name in OPEN or metadata['low'] < metadata['high']
    assert '\n' not in parameters.describe(LEAVES[name])


@pytest.mark.parametrize('name', REQUIRED)
def test_a_missing_key_is_named_with_its_description(name):
    mapping = copy.deepcopy(PAPER)
    section, key = name.split('.')
    del mapping[section][key]
    with pytest.raises(BadInput, match=f'^{name} is missing: .*') as caught:
        parameters.from_mapping(Case, mapping)
    assert LEAVES[name].metadata['meaning'] in str(caught.value)


@pytest.mark.parametrize('section', PAPER)
def test_a_missing_section_is_named(section):
    mapping = {key: value for key, value in PAPER.items() if key != section}
    with pytest.raises(BadInput, match=f'^{section} is missing'):
        parameters.from_mapping(Case, mapping)


@pytest.mark.parametrize('section', PAPER)
def test_a_section_must_be_a_mapping(section):
    with pytest.raises(BadInput, match=f'^{section}: expected keys and values'):
        parameters.from_mapping(Case, {**PAPER, section: 1.0})


@pytest.mark.parametrize('name', ['flow.wind', 'membrane.Chord', 'numerics.dt'])
def test_an_unknown_key_is_refused_with_the_known_ones(name):
    with pytest.raises(BadInput, match=f'^{name} is not a parameter; known here: .*, ') as caught:
        parameters.from_mapping(Case, changed(name, 1.0))
    assert all(key in str(caught.value) for key in PAPER[name.split('.')[0]])


def test_an_unknown_section_is_refused():
    with pytest.raises(BadInput, match='^weather is not a parameter'):
        parameters.from_mapping(Case, {**PAPER, 'weather': {}})


@pytest.mark.parametrize('name', LEAVES)
@pytest.mark.parametrize('value', [None, True, [1.0], {'a': [1.0]}])
def test_a_wrong_type_is_refused(name, value):
    with pytest.raises(BadInput, match=f'^{name}(.a)? = .* is not a '):
        parameters.from_mapping(Case, changed(name, value))


@pytest.mark.parametrize('name', NUMBERS)
def test_a_word_for_a_number_is_refused(name):
    with pytest.raises(BadInput, match=f"^{name} = '1e-4' is not a "):
        parameters.from_mapping(Case, changed(name, '1e-4'))


@pytest.mark.parametrize(
    'name', [name for name, field in NUMBERS.items() if field.metadata['type'] is float])
def test_an_integer_for_a_floating_point_number_is_refused_with_a_hint(name):
    with pytest.raises(BadInput, match=f'^{name} = 1 is not a floating-point number .*decimal'):
        parameters.from_mapping(Case, changed(name, 1))


@pytest.mark.parametrize('name', NUMBERS)
@pytest.mark.parametrize('side', ['low', 'high'])
def test_the_ends_of_a_range_are_admitted_and_nothing_beyond(name, side):
    metadata = NUMBERS[name].metadata
    end = metadata[side]
    parameters.check(name, NUMBERS[name], end)
    beyond = (end + (1 if side == 'high' else -1) if metadata['type'] is int
              else math.nextafter(end, math.inf if side == 'high' else -math.inf))
    with pytest.raises(BadInput, match=f'^{name} = .* is out of range') as caught:
        parameters.from_mapping(Case, changed(name, beyond))
    for part in (metadata['unit'], f"{metadata['low']:g}", f"{metadata['high']:g}"):
        assert part in str(caught.value)


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_refused(value):
    with pytest.raises(BadInput, match='^flow.speed = .* is out of range'):
        parameters.from_mapping(Case, changed('flow.speed', value))


def test_an_unknown_option_is_refused_with_the_known_ones():
    with pytest.raises(BadInput, match='^numerics.grid = .*one of fast, standard, fine'):
        parameters.from_mapping(Case, changed('numerics.grid', 'coarse'))


@given(mapping=mappings())
def test_an_admissible_case_survives_yaml_bit_for_bit(mapping, tmp_path_factory):
    case = parameters.from_mapping(Case, mapping)
    path = tmp_path_factory.mktemp('case') / 'case.yaml'
    path.write_text(parameters.to_yaml(case))
    assert parameters.load(str(path)) == case
    assert parameters.to_mapping(case) == mapping


def test_an_older_file_names_neither_law_nor_constants():
    mapping = copy.deepcopy(PAPER)
    del mapping['membrane']['law'], mapping['membrane']['constants']
    assert parameters.from_mapping(Case, mapping) == parameters.load('paper')
    assert parameters.load('paper').membrane.law == 'gent'


def test_an_open_section_of_numbers_is_set_by_name_hashed_pickled_and_left_out_when_empty():
    paper = parameters.load('paper')
    assert 'constants' not in parameters.to_yaml(paper)
    case = parameters.replace(paper, {'membrane.law': 'my.law:Law', 'membrane.constants.b': 2.0,
                                      'membrane.constants.a': -1.0})
    assert pickle.loads(pickle.dumps(case)) == case != paper
    assert hash(case) == hash(parameters.from_yaml(parameters.to_yaml(case)))
    assert case.membrane.constants == Numbers({'a': -1.0, 'b': 2.0})
    named = {name: (value, field.metadata['type']) for name, value, field in
             parameters.leaves(case) if name.startswith('membrane.constants')}
    assert named == {'membrane.constants.a': (-1.0, float), 'membrane.constants.b': (2.0, float)}
    with pytest.raises(TypeError):
        case.membrane.constants['a'] = 0.0


@pytest.mark.parametrize('constants, sentence', [
    ({'a': 1}, r'^membrane.constants.a = 1 is not a floating-point number'),
    ({'a': math.nan}, r'^membrane.constants.a = nan is out of range'),
    ({'2 a': 1.0}, r'^membrane.constants.2 a is not a name'), ({1: 1.0}, 'is not a name')])
def test_numbers_of_an_open_section_have_names_and_are_finite(constants, sentence):
    with pytest.raises(BadInput, match=sentence):
        parameters.from_mapping(Case, changed('membrane.constants', constants))


def test_sections_are_immutable():
    with pytest.raises(dataclasses.FrozenInstanceError):
        parameters.load('paper').flow.speed = 2.0


@pytest.mark.parametrize('text, complaint', [
    ('', 'below /\\*\\* or /\\*\\*/simulator: ros__parameters'),
    ('just words', 'below /\\*\\* or /\\*\\*/simulator: ros__parameters'),
    ('[1, 2]', 'below /\\*\\* or /\\*\\*/simulator: ros__parameters'),
    ('/**: {parameters: {}}', 'below /\\*\\* or /\\*\\*/simulator: ros__parameters'),
    ('/**: {ros__parameters: }', 'expected keys and values'),
    ('/**: {ros__parameters: {flow: 1', 'not valid YAML'),
    ('a:\tb: c', 'not valid YAML'),
    ('{[1]: 2}', 'not valid YAML'),
    ('/**: {ros__parameters: {flow: {speed: 1.0, speed: 2.0}}}', 'speed is given twice'),
])
def test_an_unreadable_file_is_refused_in_one_line_with_its_path(write, text, complaint):
    path = write(text)
    with pytest.raises(BadInput, match=complaint) as caught:
        parameters.load(path)
    assert str(caught.value).startswith(path) and '\n' not in str(caught.value)


def test_a_file_that_is_not_text_is_refused(tmp_path):
    path = tmp_path / 'case.yaml'
    path.write_bytes(b'\xff\xfe\x00')
    with pytest.raises(BadInput, match='cannot be read'):
        parameters.load(str(path))


@pytest.mark.parametrize('name', ['missing.yaml', 'folder/missing', '/', '.'])
def test_a_missing_file_is_named(name):
    with pytest.raises(BadInput, match=name):
        parameters.load(name)


@pytest.mark.parametrize('name', ['papier', '', '..'])
def test_an_unknown_configuration_is_refused_with_the_shipped_ones(name):
    with pytest.raises(BadInput, match='is not a shipped configuration .*paper, .*soft'):
        parameters.load(name)


def test_changes_are_applied_and_checked():
    case = parameters.load('paper', changes={'flow.speed': 2.0, 'numerics.grid': 'fast'})
    assert (case.flow.speed, case.numerics.grid) == (2.0, 'fast')
    assert case.membrane == parameters.load('paper').membrane


@pytest.mark.parametrize('name, value', [
    ('flow.speed', 2), ('flow.speed', -1.0), ('flow', 1.0), ('speed', 1.0),
    ('flow.speed.x', 1.0), ('flow.wind', 1.0), ('wind.speed', 1.0), ('', 1.0), ('.', 1.0)])
def test_a_wrong_change_is_refused(name, value):
    with pytest.raises(BadInput):
        parameters.replace(parameters.load('paper'), {name: value})


@pytest.mark.parametrize('text, pair', [
    ('flow.speed=2.0', ('flow.speed', 2.0)),
    (' flow.speed =2.0', ('flow.speed', 2.0)),
    ('numerics.elements=64', ('numerics.elements', 64)),
    ('numerics.grid=fast', ('numerics.grid', 'fast')),
    ('a=b=c', ('a', 'b=c'))])
def test_assignments_are_read_as_yaml(text, pair):
    assert parameters.parse_assignment(text) == pair


@pytest.mark.parametrize('text', ['flow.speed', '=2.0', '', 'flow.speed=[', 'flow.speed={a: '])
def test_a_malformed_assignment_is_refused(text):
    with pytest.raises(BadInput) as caught:
        parameters.parse_assignment(text)
    assert '\n' not in str(caught.value)


def test_sections_can_be_read_alone():
    assert parameters.from_mapping(Flow, PAPER['flow']) == parameters.load('paper').flow


@dataclass(frozen=True)
class Extended:
    """A section of a later version, which files of an earlier one do not have."""

    gain: float = real('-', 'a gain', 0.0, 1.0, default=0.5)
    law: str = choice('a law', 'one', 'other', default='one', open=True)


@dataclass(frozen=True)
class Later:
    """A schema that has grown."""

    speed: float = real('m/s', 'a speed', 0.0, 1.0)
    extended: Extended


def test_what_an_older_file_does_not_name_takes_its_default():
    assert from_mapping(Later, {'speed': 1.0}) == Later(1.0, Extended(0.5, 'one'))
    assert from_mapping(Later, {'speed': 1.0, 'extended': {'gain': 1.0}}).extended.gain == 1.0
    with pytest.raises(BadInput, match='speed is missing'):
        from_mapping(Later, {'extended': {'gain': 1.0}})
    with pytest.raises(BadInput, match=r'extended.gain = 2.0 is out of range'):
        from_mapping(Later, {'speed': 1.0, 'extended': {'gain': 2.0}})


def test_an_open_choice_takes_a_part_from_outside_by_module_and_name():
    assert from_mapping(Extended, {'law': 'my_package.my_module:Law'}).law.endswith(':Law')
    for word in ('another', 'module:', ':Law', 'a b:Law', 'module:Law:more'):
        with pytest.raises(BadInput, match='or package.module:Name'):
            from_mapping(Extended, {'law': word})

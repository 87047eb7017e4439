# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What one field demands of another: refused with both values, described, exact at the bound."""

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.inputs.trajectory import Course
from dewing_sim.parameters import Case
from dewing_sim.schema.numerals import apart, not_above, not_below
from dewing_sysid.settings import Settings

DT = 'numerics.time_step'
BROKEN = [
    (Case, {'actuation.voltage': 600.0, 'actuation.voltage_limit': 500.0},
     'actuation.voltage = 600 V is out of range: at most 500 V with actuation.voltage_limit = '
     '500 V'),
    (Case, {'disturbance.pressure': 0.03, 'disturbance.frequency': 2000.0, DT: 5.0e-4},
     'disturbance.frequency = 2000 Hz is out of range: at most 1000 Hz, 1/(2 numerics.time_step), '
     'with numerics.time_step = 0.0005 s'),
    (Case, {'gust.shape': 'ramp', 'gust.duration': 1.0e-4, DT: 5.0e-4},
     'gust.duration = 0.0001 s is out of range: at least 0.001 s, 2 numerics.time_step, with '
     'numerics.time_step = 0.0005 s'),
    (Case, {'rigid_motion.shape': 'sine', 'rigid_motion.duration': 1.5e-3, DT: 5.0e-4},
     'rigid_motion.duration = 0.0015 s is out of range: at least 0.002 s, 4 numerics.time_step, '
     'with numerics.time_step = 0.0005 s'),
    (Settings, {'experiment.sweep_low': 500.0, 'experiment.sweep_high': 400.0},
     'experiment.sweep_low = 500 Hz is out of range: at most 400 Hz with experiment.sweep_high = '
     '400 Hz'),
]
FILES = {Case: 'paper', Settings: 'sysid'}


@pytest.mark.parametrize('schema, changes, sentence', BROKEN)
def test_a_broken_relation_is_refused_in_one_sentence(schema, changes, sentence):
    with pytest.raises(BadInput) as caught:
        parameters.load(FILES[schema], schema, changes)
    assert str(caught.value) == sentence


@pytest.mark.parametrize('schema, changes, sentence', BROKEN)
def test_what_the_sentence_advises_is_admissible(schema, changes, sentence):
    name, advised = sentence.split()[0], sentence.split('at ')[1].split()[1]
    admitted = parameters.load(FILES[schema], schema, {**changes, name: float(advised)})
    section, key = name.split('.')
    assert getattr(getattr(admitted, section), key) == float(advised)


@pytest.mark.parametrize('changes', [
    {'disturbance.pressure': 0.0, 'disturbance.frequency': 1.0e4},
    {'gust.shape': 'none', 'gust.duration': 1.0e-6},
    {'rigid_motion.shape': 'none', 'rigid_motion.duration': 1.0e-6}])
def test_what_does_not_act_may_be_anything(changes):
    parameters.load('paper', changes=changes)


@pytest.mark.parametrize('name, words', [
    ('actuation.voltage', 'at most actuation.voltage_limit'),
    ('disturbance.frequency',
     'at most 1/(2 numerics.time_step) if disturbance.pressure is not 0'),
    ('gust.duration', 'at least 2 numerics.time_step if gust.shape is not none; '
     'at least 4 numerics.time_step if gust.shape is sine'),
    ('rigid_motion.duration', 'at least 2 numerics.time_step if rigid_motion.shape is not none; '
     'at least 4 numerics.time_step if rigid_motion.shape is sine')])
def test_relations_stand_in_the_descriptions(name, words):
    assert parameters.describe(dict(parameters.fields(Case))[name]).endswith(f'; {words}')


@pytest.mark.parametrize('offset', [0.0, 0.25, 0.5, 0.75])
def test_the_shortest_courses_keep_their_content(offset):
    times = np.arange(-1, 8) + offset           # in time steps
    ramp, bump, sine = (
        np.array([Course(shape, 0.0, least)(time) for time in times])
        for shape, least in (('ramp', 2.0), ('one_minus_cosine', 2.0), ('sine', 4.0)))
    assert ramp[:, 1].sum() == pytest.approx(1.0, abs=0.07)
    assert bump[:, 0].sum() == pytest.approx(1.0, abs=1.0e-12)
    assert np.abs(sine[:, 0]).max() > 0.7


def test_numbers_in_a_sentence_differ_as_the_values_do():
    assert apart(1250.0000001, 1250.0) == ('1250.0000001', '1250')
    assert apart(2.0, 1.0) == ('2', '1')
    assert apart(1300.4, 1300.2, 4) == ('1300.4', '1300.2')
    third = 1.0 / 3.0
    assert float(not_above(third)) <= third <= float(not_below(third))
    assert float(not_above(third)) == pytest.approx(third, rel=1.0e-5)
    assert not_above(0.5 / 5.0e-4) == '1000'

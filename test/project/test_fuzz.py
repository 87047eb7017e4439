# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Cases drawn at random within their ranges: a result or one sentence, never a traceback."""

import json
import math

import pytest
import yaml
from drawn_cases import mappings
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dewing_cli import main as cli
from dewing_sim import parameters

DONE, FAILED, BAD_INPUT = 0, 1, 2
PAPER = {name: value for name, value, _ in parameters.leaves(parameters.load('paper'))}


def near(name, share=0.5):
    """Draw a number of the paper's magnitude, now and then anything in range."""
    meta = dict(parameters.fields(parameters.Case))[name].metadata
    low, high = meta['low'], meta['high']
    value = PAPER[name] or 0.01 * high
    around = st.floats(max(low, (1.0 - share) * value), min(high, (1.0 + share) * value))
    return st.integers(0, 40).flatmap(lambda k: st.floats(low, high) if k == 1 else around)


# Few elements, coarse grids, short trims, so that a case takes milliseconds.
SMALL = {
    'numerics.engine': st.sampled_from(['conformal', 'conformal', 'auto', 'finite_volume']),
    'numerics.grid': st.sampled_from(['fast', 'realtime']),
    'numerics.trim_time': st.floats(0.0, 0.02),
    'numerics.coupling_iterations': st.integers(1, 20),
    'membrane.elements': st.integers(4, 24),
    'membrane.constants': st.just({}),
    'membrane.law': st.just('gent'),        # the others need constants
    'disturbance.pressure': st.floats(-0.1, 0.1),
    **{name: near(name) for name in (
        'flow.density', 'flow.kinematic_viscosity', 'flow.speed', 'membrane.chord',
        'membrane.initial_thickness', 'membrane.prestretch_lateral',
        'membrane.density', 'membrane.shear_modulus', 'membrane.gent_limit',
        'membrane.bulk_modulus', 'membrane.relative_permittivity', 'numerics.time_step',
        'numerics.coupling_tolerance')},
    'membrane.prestretch': st.floats(1.05, 3.0),
    'actuation.voltage': st.one_of(st.just(0.0), st.floats(0.0, 300.0)),
    'actuation.voltage_limit': st.sampled_from([100.0, 300.0, 300.0, 5000.0]),
    'membrane.viscous_share': st.one_of(st.just(0.0), st.floats(0.0, 100.0)),
    'gust.shape': st.sampled_from([*6 * ['none'], 'ramp', 'one_minus_cosine', 'sine']),
    'gust.vertical': st.floats(-0.5, 0.5),
    'gust.horizontal': st.floats(-0.5, 0.5),
    'rigid_motion.shape': st.sampled_from([*6 * ['none'], 'ramp', 'one_minus_cosine', 'sine']),
    'rigid_motion.heave': st.floats(-0.01, 0.01),
}


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('fuzz')


@settings(max_examples=60, deadline=None, derandomize=True, database=None,
          suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large,
                                 HealthCheck.function_scoped_fixture])
@given(mapping=mappings(SMALL), steps=st.integers(1, 4),
       skipped=st.sampled_from([0, 0, 0, 0, 1, 4]),
       voltage=st.one_of(st.none(), st.none(), st.floats(0.0, 500.0)))
def test_a_case_gives_finite_numbers_or_one_sentence(
        folder, capsys, monkeypatch, mapping, steps, skipped, voltage):
    monkeypatch.setenv('XDG_CACHE_HOME', str(folder / 'cache'))
    case, out = folder / 'case.yaml', folder / 'out.json'
    case.write_text(yaml.safe_dump({'/**': {'ros__parameters': _writable(mapping)}}))
    out.unlink(missing_ok=True)
    dt = mapping['numerics']['time_step']
    arguments = ['simulate', '--case', str(case), '--duration', repr(steps * dt),
                 '--skip', repr(skipped * dt), '--json', str(out), '--quiet']
    if voltage is not None:
        arguments += ['--voltage', repr(voltage)]
    capsys.readouterr()
    status = cli.main(arguments)
    said = capsys.readouterr()
    complaints = [line for line in said.err.splitlines()
                  if not line.startswith('dewing: warning: ')]
    assert said.out == '' and 'Traceback' not in said.err and 'RuntimeWarning' not in said.err
    assert status in (DONE, FAILED, BAD_INPUT), said.err
    if status == DONE:
        assert complaints == []
        assert all(map(math.isfinite, _numbers(json.loads(out.read_text()))))
    else:
        assert len(complaints) == 1 and complaints[0].startswith('dewing: '), said.err
        assert status == FAILED or not out.exists()


def _writable(mapping):
    return {section: {key: value for key, value in values.items() if value != {}}
            for section, values in mapping.items()}


def _numbers(tree):
    """Yield every number of nested JSON."""
    if isinstance(tree, dict | list):
        for item in tree.values() if isinstance(tree, dict) else tree:
            yield from _numbers(item)
    elif isinstance(tree, float):
        yield tree

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""YAML that no one would write: one sentence, wherever it comes in."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dewing_cli import main as cli
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.schema import yaml_text

LAUGHS = f'- &a0 [{"lol, " * 9}]\n' + ''.join(
    f'- &a{k} [{", ".join([f"*a{k - 1}"] * 9)}]\n' for k in range(1, 9))
ABSURD = {
    'nested lists': '[' * 5000, 'nested mappings': '{a: ' * 5000, 'nested dashes': '- ' * 5000,
    'closed lists': '[' * 200 + ']' * 200, 'itself': '&a [*a]', 'a key of itself': '&a {*a : 1}',
    'laughs': LAUGHS, 'no such truth': '!!bool x', 'no such day': '2026-99-99',
    'nothing whole': "!!int ''", 'nothing real': '!!float x', 'no pairs': '!!map [a, b]',
    'digits': '9' * 5000, 'hexadecimal digits': '0x' + 'f' * 5000, 'a null byte': '\0',
    'a timestamp': '!!timestamp x', 'a list as key': '? [a, b]\n: 1'}


@pytest.mark.parametrize('text', ABSURD.values(), ids=ABSURD)
def test_absurd_yaml_ends_in_one_short_sentence(text, write, capsys):
    for make in (lambda: parameters.from_yaml(text),
                 lambda: parameters.from_yaml(f'/**:\n  ros__parameters:\n    flow: {text}'),
                 lambda: Identity.from_yaml(text)):
        with pytest.raises(BadInput) as error:
            make()
        assert len(str(error.value)) < 2000
    assert cli.main(['simulate', '--case', write(text)]) == 2
    assert cli.main(['simulate', '--set', f'flow.velocity={text}']) == 2
    for value in (text, '&a [*a],&b [*b]', f'{text},{text}'):
        assert cli.main(['sweep', '--vary', f'flow.velocity={value}', '--duration', '0.1',
                         '--out', 'never.nc']) == 2
    assert capsys.readouterr().err.count('\n') == 5


@settings(max_examples=200, deadline=None)
@given(st.text('[]{}&*a:-?!|>\'"%@`\n 0.e,#~<=', max_size=30))
def test_any_text_is_read_or_refused(text):
    try:
        yaml_text.read(text, 'x', strict=True)
    except BadInput as error:
        assert str(error).startswith('x (')


def test_a_large_value_is_shown_in_brief():
    assert parameters.shown(2.5e-4) == '0.00025' and parameters.shown('word') == "'word'"
    assert parameters.shown({'a': 1.0}) == "{'a': 1.0}"
    assert len(parameters.shown([[['x' * 9000] * 900] * 900] * 900)) < 5000
    assert parameters.shown(10**5000) == '<int>'


@pytest.mark.parametrize('strict', [False, True])
def test_no_number_is_to_the_base_of_sixty_or_eight(strict):
    """YAML 1.1 has numbers to the base of sixty, 1:30.5, and of eight, 0100."""
    read = yaml_text.read('[1:30.5, 1:30, 0100, -0_7, 1.5, 1_000, 0, 0.5, -2, 0x10, 1.0e+3, .inf]',
                          'no list', strict)
    assert read == ['1:30.5', '1:30', '0100', '-0_7', 1.5, 1000, 0, 0.5, -2, 16, 1000.0,
                    float('inf')]

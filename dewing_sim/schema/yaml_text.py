# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""YAML from outside: whatever is wrong with it is said in one sentence."""

import re
from typing import Any

import yaml

from dewing_sim.errors import BadInput


def read(text: str, what: str, strict: bool = False) -> Any:
    """Return what ``text`` says; raise `BadInput`, which begins with ``what``, if it says nothing.

    With ``strict`` a repeated key is refused; otherwise its last value counts, as YAML has it.
    """
    try:
        return yaml.load(text, _StrictLoader if strict else _Loader)
    except RecursionError:
        raise BadInput(f'{what} (nested too deeply)') from None
    except Exception as error:      # words as !!bool x end in a dozen kinds besides YAMLError
        raise BadInput(f'{what} ({_one_line(error)})') from None


class _Loader(yaml.SafeLoader):
    """A YAML loader without numbers to the base of sixty or eight.

    YAML 1.1 reads 1:30.5 as ninety and a half and 0100 as sixty-four, which nobody means here:
    they stay texts, which no number accepts.
    """

    def construct_number(self, node):
        if ':' in node.value or re.fullmatch('[-+]?0[0-9_]+', node.value):
            return node.value
        kind = 'int' if node.tag.endswith(':int') else 'float'
        return getattr(self, f'construct_yaml_{kind}')(node)


for _kind in ('int', 'float'):
    _Loader.add_constructor(f'tag:yaml.org,2002:{_kind}', _Loader.construct_number)


class _StrictLoader(_Loader):
    """A YAML loader that refuses a repeated key instead of taking its last value."""

    def construct_mapping(self, node, deep=False):
        keys = [self.construct_object(key, deep) for key, _ in node.value]
        for key in keys:
            if keys.count(key) > 1:
                raise yaml.constructor.ConstructorError(
                    None, None, f'{key} is given twice', node.start_mark)
        return super().construct_mapping(node, deep)


def _one_line(error: Exception) -> str:
    return ' '.join(str(error).split()) or type(error).__name__

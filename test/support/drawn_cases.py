# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Whole cases drawn at random within the ranges and relations that the schema declares."""

import dataclasses
import operator
from types import MappingProxyType

from hypothesis import strategies as st

from dewing_sim import parameters
from dewing_sim.parameters import Case
from dewing_sim.schema import Numbers, relations

CONSTANTS = st.dictionaries(st.from_regex('[a-z]+_[0-9]', fullmatch=True),
                            st.floats(-1.0e9, 1.0e9))


@st.composite
def mappings(draw, instead=MappingProxyType({})):
    """Draw the mapping of an admissible case; ``instead`` has strategies for some dotted names."""
    mapping = {}
    for name, field in parameters.fields(Case):
        section, key = name.split('.')
        mapping.setdefault(section, {})[key] = draw(
            instead[name] if name in instead else _of(field))
    for bound, prefix in _bounds():
        _keep(mapping, bound, prefix)
    return mapping


def _of(field):
    meta = field.metadata
    if meta['type'] is Numbers:
        return CONSTANTS
    if 'options' in meta:
        return st.sampled_from(meta['options'])
    return (st.integers if meta['type'] is int else st.floats)(meta['low'], meta['high'])


def _bounds():
    yield from ((bound, '') for bound in relations.of(Case))
    for section in dataclasses.fields(Case):
        yield from ((bound, f'{section.name}.') for bound in relations.of(section.type))


def _keep(mapping, bound, prefix):
    """Move what breaks ``bound`` onto it."""
    case = Case(**{field.name: field.type(**mapping[field.name])
                   for field in dataclasses.fields(Case)})
    part = operator.attrgetter(prefix[:-1])(case) if prefix else case
    if bound.fault(part, prefix, lambda name: ''):
        section, key = f'{prefix}{bound.name}'.split('.')
        mapping[section][key] = bound.of(operator.attrgetter(bound.by)(part))

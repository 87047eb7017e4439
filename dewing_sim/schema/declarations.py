# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Dataclasses as schemas: a field declares unit, meaning and range, and every value is checked.

`from_mapping` accepts exactly the fields of a dataclass, each with the right type and inside its
range, and otherwise raises `BadInput` naming field, value, unit and range. See also `relations`.
"""

import dataclasses
import reprlib
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, TypeVar

from dewing_sim.errors import BadInput
from dewing_sim.schema import relations
from dewing_sim.schema.named_numbers import Numbers
from dewing_sim.schema.plugins import is_plugin

Section = TypeVar('Section')
HUGE = 1.0e15       # bounds of a number whose own are not known here


def real(unit: str, meaning: str, low: float, high: float, **more: Any) -> Any:
    """Declare a floating-point field with its unit, meaning and admissible range.

    Every declaration takes ``default``, the value where a file does not name the field, as files
    of an earlier version cannot. Without it the field must be there.
    """
    return _field(float, unit, meaning, low=low, high=high, **more)


def count(meaning: str, low: int, high: int, **more: Any) -> Any:
    """Declare a whole-number field with its meaning and admissible range."""
    return _field(int, '', meaning, low=low, high=high, **more)


def flag(meaning: str, **more: Any) -> Any:
    """Declare a field that is true or false."""
    return _field(bool, '', meaning, **more)


def choice(meaning: str, *options: str, **more: Any) -> Any:
    """Declare a field that takes one of a few words.

    With ``open=True`` it takes a part from outside too, ``package.module:Name``; see `plugins`.
    With ``of='other'`` it takes any word where the field ``other`` beside it names a part from
    outside, which says itself which words it knows.
    """
    return _field(str, '', meaning, options=options, **more)


def text(meaning: str, **more: Any) -> Any:
    """Declare a free-text field, such as a path; it may be empty."""
    return _field(str, '', meaning, **more)


def numbers(meaning: str) -> Any:
    """Declare an open section of named floating-point numbers, empty by default.

    Whoever uses it knows the names and checks them with a schema of his own.
    """
    return _field(Numbers, '', meaning, default=Numbers({}))


def _field(kind: type, unit: str, meaning: str, **more: Any) -> Any:
    return dataclasses.field(metadata=dict(type=kind, unit=unit, meaning=meaning, **more))


def fields(schema: type, prefix: str = '') -> Iterator[tuple[str, dataclasses.Field]]:
    """Yield (dotted name, field) of every leaf of a schema, depth first."""
    for field in dataclasses.fields(schema):
        inner = [(prefix + field.name, field)]
        if dataclasses.is_dataclass(field.type):
            inner = fields(field.type, f'{prefix}{field.name}.')
        for name, leaf in inner:
            yield name, relations.noted(leaf, name, schema, prefix)


def leaves(section: Any) -> Iterator[tuple[str, Any, dataclasses.Field]]:
    """Yield (dotted name, value, field) of every leaf of an instance, each number by itself."""
    for name, field in fields(type(section)):
        value = section
        for key in name.split('.'):
            value = getattr(value, key)
        if isinstance(value, Numbers):
            for key, number in value.items():
                yield f'{name}.{key}', number, _number(field)
        else:
            yield name, value, field


def _number(field: dataclasses.Field) -> dataclasses.Field:
    """Return the declaration of a number in the open section ``field``."""
    return real('', field.metadata['meaning'], -HUGE, HUGE)


def shown(value: Any) -> str:
    """Return a value for the sentence of an error, abridged if it is large or deeply nested."""
    try:
        return _brief.repr(value)
    except (ValueError, RecursionError):        # Python writes no whole number of 4300 digits
        return f'<{type(value).__name__}>'


_brief = reprlib.Repr()
_brief.maxlevel, _brief.maxlist, _brief.maxdict = 2, 4, 4
_brief.maxstring = _brief.maxother = 120


def describe(field: dataclasses.Field) -> str:
    """Return meaning, unit and range of a field in one line, for descriptors and errors."""
    return '; '.join([_described(field.metadata), *field.metadata.get('relations', ())])


def _described(meta: Mapping[str, Any]) -> str:
    if 'options' in meta:
        outside = ' or package.module:Name' if meta.get('open') else ''
        return f"{meta['meaning']}; one of {', '.join(meta['options'])}{outside}"
    unit = f" [{meta['unit']}]" if meta['unit'] else ''
    if 'low' not in meta:
        return meta['meaning']
    return f"{meta['meaning']}{unit}, from {meta['low']:g} to {meta['high']:g}"


def check(name: str, field: dataclasses.Field, value: Any, beside: Mapping = MappingProxyType({}),
          ) -> Any:
    """Return ``value`` if ``field`` admits it; raise `BadInput` otherwise.

    ``beside`` has the values of the other fields of its section.
    """
    wanted = field.metadata['type']
    if wanted is Numbers:
        return _checked_numbers(name, field, value)
    if type(value) is not wanted:
        hint = _FLOAT_HINT if wanted is float else ''
        raise BadInput(f'{name} = {shown(value)} is not a {_TYPE_NAMES[wanted]}{hint}: '
                       f'{describe(field)}')
    if 'options' in field.metadata:
        word = value if field.metadata.get('open') else beside.get(field.metadata.get('of'))
        admissible = value in field.metadata['options'] or is_plugin(str(word))
    elif 'low' in field.metadata:
        admissible = field.metadata['low'] <= value <= field.metadata['high']
    else:
        admissible = True
    if not admissible:
        raise BadInput(f'{name} = {shown(value)} is out of range: {describe(field)}')
    return value


def _checked_numbers(name: str, field: dataclasses.Field, value: Any) -> Numbers:
    if not isinstance(value, Mapping):
        raise BadInput(f'{name} = {shown(value)} is not a section of numbers: {describe(field)}')
    for key, number in value.items():
        if not isinstance(key, str) or not key.isidentifier():
            raise BadInput(f'{name}.{key} is not a name: letters, digits and _')
        check(f'{name}.{key}', _number(field), number)
    return Numbers(value)


_TYPE_NAMES = {float: 'floating-point number', int: 'whole number', str: 'word',
               bool: 'truth value, true or false'}
# YAML 1.1 reads 1e-4 and 1.0e4 as words, and ROS refuses an integer for a double.
_FLOAT_HINT = ' (write it with a decimal point and a signed exponent, as in 1.0 or 2.0e+4)'


def from_mapping(schema: type[Section], mapping: Any, name: str = '') -> Section:
    """Build a schema instance from nested mappings with exactly its keys.

    A schema whose fields depend on a value has a class method ``chosen(mapping)``, which returns
    the schema to take and what of ``mapping`` is for it. Raises `BadInput` for unknown or missing
    keys, wrong types, values out of range and values that break a relation.
    """
    if not isinstance(mapping, Mapping):
        raise BadInput(f"{name or 'parameters'}: expected keys and values, got {shown(mapping)}")
    if hasattr(schema, 'chosen'):
        schema, mapping = schema.chosen(mapping)
    known = {field.name: field for field in dataclasses.fields(schema)}
    for key in mapping:
        if key not in known:
            raise BadInput(f'{_join(name, key)} is not a parameter; '
                           f"known here: {', '.join(known)}")
    values = {}
    for key, field in known.items():
        path = _join(name, key)
        if dataclasses.is_dataclass(field.type):
            value = mapping[key] if key in mapping else _default_section(path, field)
            values[key] = from_mapping(field.type, value, path)
        elif key in mapping:
            values[key] = check(path, field, mapping[key], mapping)
        elif 'default' in field.metadata:
            values[key] = field.metadata['default']
        else:
            raise BadInput(f'{path} is missing{_missing_hint(field)}')
    made = schema(**values)
    relations.require(made, name, fields(schema))
    return made


def _join(prefix: str, key: Any) -> str:
    word = key if isinstance(key, str) else shown(key)
    return f'{prefix}.{word}' if prefix else word


def _default_section(path: str, field: dataclasses.Field) -> dict:
    """Return an empty section if all that is in it has a default; raise `BadInput` otherwise."""
    if all('default' in leaf.metadata for _, leaf in fields(field.type)):
        return {}
    raise BadInput(f'{path} is missing{_missing_hint(field)}')


def _missing_hint(field: dataclasses.Field) -> str:
    return f': {describe(field)}' if field.metadata else ' (a section)'


def outside_modules(section: Any) -> tuple[str, ...]:
    """Return the modules of all parts from outside that ``section`` names."""
    return tuple(sorted({value.partition(':')[0] for _, value, field in leaves(section)
                         if field.metadata.get('open') and is_plugin(value)}))


def to_mapping(section: Any) -> dict:
    """Return the nested mapping from which `from_mapping` rebuilds ``section``."""
    return {field.name: _plain(getattr(section, field.name))
            for field in dataclasses.fields(section)}


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return to_mapping(value)
    return dict(value) if isinstance(value, Numbers) else value


def replace(section: Section, changes: Mapping[str, Any]) -> Section:
    """Return ``section`` with dotted keys changed, checked as on loading."""
    mapping = to_mapping(section)
    for name, value in changes.items():
        *path, last = name.split('.')
        target = mapping
        for key in path:
            target = target.setdefault(key, {}) if isinstance(target, dict) else None
        if not isinstance(target, dict):
            raise BadInput(f'{name} is not a parameter; known here: '
                           f'{", ".join(to_mapping(section))}')
        target[last] = value
    return from_mapping(type(section), mapping)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of a controller's parameters: what is common to all laws, and a section for each.

The sections stand in the files of the laws, see `law.registry`. Those of dewing's own laws are
always there, and lie idle where the kind does not use them; those of a law from outside are
there while it is the kind.
"""

import dataclasses
import functools
from collections.abc import Mapping
from typing import Any

from dewing_control.law import registry
from dewing_control.law.base import Command, Law, Reference
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.parameters import choice, text
from dewing_sim.schema import plugins


class _ByKind:
    """Settings whose fields depend on their ``kind``; see `parameters.from_mapping`."""

    ros_node = 'controller'

    @classmethod
    def chosen(cls, mapping: Mapping) -> tuple[type, Mapping]:
        """Return the schema for the kind in ``mapping``, and what of ``mapping`` is for it."""
        kind = mapping.get('kind')
        schema = ControllerSettings
        if isinstance(kind, str) and plugins.is_plugin(kind):
            schema = _extended(kind, registry.of_kind(kind))
        gone = _names(cls) - _names(schema)         # sections of the law it was before
        return schema, {key: value for key, value in mapping.items() if key not in gone}

    def __reduce__(self):
        """Pickle the values; the class is made again where they are read."""
        return parameters.from_mapping, (ControllerSettings, parameters.to_mapping(self))


def _names(schema: type) -> set[str]:
    return {field.name for field in dataclasses.fields(schema)}


def _own_sections() -> dict[str, type]:
    """Return the sections of dewing's own laws by name; several laws may share one."""
    return {name: section for law in registry.LAWS.values()
            for name, section in law.sections.items()}


def _with_model() -> str:
    return ' and '.join(kind for kind, law in registry.LAWS.items() if law.needs_model)


ControllerSettings = dataclasses.make_dataclass('ControllerSettings', [
    ('kind', str, choice('control law', *registry.LAWS, open=True)),
    ('model', str, text(f'npz file of the identified model, for kinds {_with_model()}')),
    ('reference', Reference), *_own_sections().items(), ('command', Command)],
    bases=(_ByKind,), frozen=True, namespace={
        '__module__': __name__,
        '__doc__': 'All parameters of a controller; idle sections are those of other kinds.'})


@functools.cache
def _extended(kind: str, law: type[Law]) -> type:
    """Return `ControllerSettings` with the sections of a ``law`` from outside."""
    known = {field.name: field.type for field in dataclasses.fields(ControllerSettings)}
    for name, section in law.sections.items():
        if known.get(name, section) is not section:
            raise BadInput(f'kind = {kind!r}: its section {name} has the name of another; '
                           f'taken are {", ".join(known)}')
    return dataclasses.make_dataclass(
        'ControllerSettings',
        [item for item in law.sections.items() if item[0] not in known],
        bases=(ControllerSettings,), frozen=True, namespace={
            '__module__': __name__, '__doc__': f'All parameters of the law {kind}.'})


def value_of(settings: Any, name: str) -> Any:
    """Return the parameter with the dotted ``name``."""
    return functools.reduce(getattr, name.split('.'), settings)

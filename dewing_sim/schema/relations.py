# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of one field that another field sets.

A section declares them as ``relations``, a class attribute without annotation. They are checked
wherever a section is made from a mapping and stand in the descriptions of the fields.
"""

import copy
import operator
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from dewing_sim.errors import BadInput
from dewing_sim.schema.numerals import apart, not_above, not_below


def same(value: float) -> float:
    """Return ``value``: the other field is the bound itself."""
    return value


def always(section: Any) -> bool:
    """Return true: the bound holds whatever else the section says."""
    return True


@dataclass(frozen=True)
class Bound:
    """The field ``name`` goes up to (or, ``least``, down to) what the field ``by`` says.

    Both are dotted names within the section that declares it. The bound is ``of(value of by)``,
    in words ``formula`` with {} for ``by``, where ``where(section)`` is true, in words ``if_``.
    """

    name: str
    by: str
    formula: str = '{}'
    of: Callable[[float], float] = field(default=same, repr=False)
    where: Callable[[Any], bool] = field(default=always, repr=False)
    if_: str = ''
    least: bool = False

    @property
    def _side(self) -> str:
        return 'at least' if self.least else 'at most'

    def meaning(self, prefix: str) -> str:
        """Return the bound in words; ``prefix`` leads to the section, with its dot."""
        bound = self.formula.format(f'{prefix}{self.by}')
        return f'{self._side} {bound}{self.if_ and f" if {self.if_}"}'

    def fault(self, section: Any, prefix: str, units: Callable[[str], str]) -> str:
        """Return the sentence that says how ``section`` breaks it; empty if it does not.

        ``units`` returns the unit of a field of the section.
        """
        value, other = (operator.attrgetter(name)(section) for name in (self.name, self.by))
        bound = self.of(other)
        if not self.where(section) or (value >= bound if self.least else value <= bound):
            return ''
        shown, _ = apart(value, bound)
        limit = (not_below if self.least else not_above)(bound)
        unit = units(self.name)
        by = f'{prefix}{self.by}'
        why = '' if self.formula == '{}' else f', {self.formula.format(by)},'
        return (f'{prefix}{self.name} = {shown} {unit} is out of range: {self._side} {limit} '
                f'{unit}{why} with {by} = {other:.10g} {units(self.by)}')


def of(schema: type) -> Iterable[Bound]:
    """Return the relations that a section declares."""
    return getattr(schema, 'relations', ())


def require(section: Any, name: str, fields: Iterable[tuple[str, Any]]) -> None:
    """Raise `BadInput` for the first relation that ``section`` breaks.

    ``name`` is its own in messages, ``fields`` yields its leaves with their declarations.
    """
    known = dict(fields) if of(type(section)) else {}
    for relation in of(type(section)):
        fault = relation.fault(section, name and f'{name}.',
                               lambda leaf: known[leaf].metadata['unit'])
        if fault:
            raise BadInput(fault)


def noted(leaf: Any, name: str, schema: type, prefix: str) -> Any:
    """Return the field ``leaf`` with the relations of ``schema`` that bound ``prefix + name``."""
    found = tuple(each.meaning(prefix) for each in of(schema) if prefix + each.name == name)
    if not found:
        return leaf
    more = copy.copy(leaf)
    more.metadata = MappingProxyType(
        {**leaf.metadata, 'relations': leaf.metadata.get('relations', ()) + found})
    return more

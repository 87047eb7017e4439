# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs as a schema: a field says what it is, and files, messages and tables follow from that.

A class of outputs is a frozen dataclass whose fields are declared with `output`. `schema` reads
them once; nothing else in the package names an output that it does not itself compute with.
"""

import dataclasses
import functools
from operator import attrgetter
from typing import Any, Iterable, NamedTuple

import numpy as np

from dewing_sim.errors import BadInput

RESERVED = ('file', 'case', 'shape_time', 'outputs')    # what else the file of a run holds


class Absent(BadInput, AttributeError):
    """An output was asked for that the plant, the file or the message does not have."""


def output(unit: str, meaning: str, *, kind: type = float, measured: bool = False,
           recorded: bool = True, topic: str = '', required: bool = False) -> Any:
    """Declare an output with its SI unit (``-`` for none) and its meaning.

    ``kind`` is float or int for a number at each step, `numpy.ndarray` for a shape. Numbers that
    are ``measured`` go to controllers and into the measurement message, in the order of the
    fields; what is ``recorded`` goes into a `History`; ``topic`` names a topic of telemetry for a
    number. An output is None where a plant does not have it, unless it is ``required``.
    """
    default = {} if required else {'default': None}
    return dataclasses.field(**default, metadata=dict(
        unit=unit, meaning=meaning, kind=kind, measured=measured, recorded=recorded,
        topic=topic, required=required))


class Quantity(NamedTuple):
    """What the declaration of an output says."""

    name: str
    unit: str
    meaning: str
    kind: type
    measured: bool
    recorded: bool
    topic: str
    required: bool

    @property
    def responds(self) -> bool:
        """Whether it is a number that answers V^2, unlike V^2 itself, time and counts."""
        return self.kind is float and not self.required

    @property
    def is_shape(self) -> bool:
        """Whether it is an array at each instant."""
        return self.kind is np.ndarray


class Schema:
    """The outputs that a class declares, and what becomes of them; names are in its order.

    ``units`` are those of what responds to V^2, and may be identified.
    """

    def __init__(self, kind: type):
        """Read the fields of ``kind``; raise `BadInput` for one that `output` did not declare."""
        self.quantities = tuple(_quantity(kind, field) for field in dataclasses.fields(kind))
        self.names = tuple(each.name for each in self.quantities)
        numbers = [each for each in self.quantities if not each.is_shape]
        self.scalars = tuple(each.name for each in numbers)
        self.measured = tuple(each.name for each in numbers if each.measured)
        self.columns = tuple(each.name for each in numbers if each.recorded)
        self.shapes = tuple(each.name for each in self.quantities
                            if each.recorded and each.is_shape)
        self.units = {each.name: each.unit for each in numbers if each.responds}
        self._values = {names: _getter(names) for names in (
            self.scalars, self.measured, self.columns, self.shapes)}

    def given(self, outputs: Any, names: tuple[str, ...]) -> tuple[tuple[str, ...], tuple]:
        """Return those of ``names`` that the plant of ``outputs`` has, not None, and their values.

        ``names`` is `scalars`, `measured` or, of what is recorded, `columns` or `shapes`.
        """
        values = self._values[names](outputs)
        held = [k for k, value in enumerate(values) if value is not None]
        if len(held) == len(names):     # of the wing, at each step
            return names, values
        return tuple(names[k] for k in held), tuple(values[k] for k in held)


@functools.cache
def schema(kind: type) -> Schema:
    """Return the schema of a class of outputs, read once."""
    return Schema(kind)


@functools.lru_cache(maxsize=64)
def extended(kind: type, units: tuple[tuple[str, str], ...]) -> type:
    """Return ``kind`` with a measured number for each (name, unit) that it does not have.

    Raises `BadInput` for a name that no field can have.
    """
    more = [(name, float | None, output(unit, name, measured=True))
            for name, unit in units if name not in schema(kind).names]
    try:
        made = dataclasses.make_dataclass(
            kind.__name__, more, bases=(kind,), frozen=True, kw_only=True) if more else kind
    except TypeError as error:
        raise BadInput(f'unusable name of an output: {error}') from None
    schema(made)
    return made


def _quantity(kind: type, field: dataclasses.Field) -> Quantity:
    said = field.metadata
    if not set(Quantity._fields[1:]) <= said.keys():
        raise BadInput(f'{kind.__name__}.{field.name} is not declared: '
                       'write dewing_sim.quantities.output(unit, meaning)')
    quantity = Quantity(field.name, *(said[name] for name in Quantity._fields[1:]))
    if field.name in RESERVED:
        raise BadInput(f'{kind.__name__}.{field.name}: the file of a run uses this name')
    if quantity.is_shape and (quantity.measured or quantity.topic):
        raise BadInput(f'{kind.__name__}.{field.name}: a shape cannot be measured or a topic')
    return quantity


def _getter(names: Iterable[str]) -> Any:
    """Return a function that takes the tuple of attributes ``names``, whatever their number."""
    names = tuple(names)
    if len(names) > 1:
        return attrgetter(*names)
    return lambda outputs: tuple(getattr(outputs, name) for name in names)

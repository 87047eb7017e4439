# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments of compiled functions that stay where they are: one reference for a tree of arrays.

At each call from Python numba looks at the type of every array in a tuple and takes the array
over, which for a solver of a hundred takes as long as some of its kernels. What never changes is
handed over once, by `hold`, and then passed as one reference.
"""

from typing import Any

from numba.core import types
from numba.experimental import structref
from numba.extending import overload

from dewing_sim.machine.kernels import kernel


@structref.register
class ResidentType(types.StructRef):
    """The type of a `Resident`, with the one field ``value``."""


class Resident(structref.StructRefProxy):
    """A value that compiled code reads as ``value``; in Python it is there as well."""

    value: Any


structref.define_boxing(ResidentType, Resident)


def hold(value: Any) -> Resident:
    """Return ``value``, a tuple of arrays, numbers and such tuples, for compiled functions.

    The arrays are shared, not copied.
    """
    made = _held(value)
    made.value = value
    return made


def _new(value):
    """Stand for the constructor in what is compiled."""


@overload(_new)
def _of_type(value):
    kind = ResidentType([('value', value)])

    def made(value):
        resident = structref.new(kind)
        resident.value = value
        return resident
    return made


@kernel
def _held(value):
    return _new(value)

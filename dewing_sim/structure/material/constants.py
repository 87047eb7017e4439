# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Classes of the tuples of constants that kernels receive, named so that caches stay right.

Numba keeps compiled kernels by the types of their arguments. The class of the constants is such a
type, and kernels take from it which law they compile, so its name says all: the law, a digest of
its functions and the fields. A changed law is another class; and an index that mentions a law can
be read where that law is not installed, because the class is made from its name alone.
"""

import dataclasses
import hashlib
import sys
from collections import namedtuple
from collections.abc import Callable
from functools import cache

from dewing_sim.machine import content

_BETWEEN = '__'
_VOLUME_AND_FIELD = ('bulk', 'eps')     # K and the permittivity, after the law's own


def tuple_of(kind: type, compiled: tuple[Callable, ...]) -> type:
    """Return the class for the constants of a law, a dataclass, with its functions in it."""
    digest = hashlib.sha256(''.join(content.digest(each, {}) for each in compiled).encode())
    names = [field.name for field in dataclasses.fields(kind)]
    made = _named(_BETWEEN.join([f'{kind.__name__}_{digest.hexdigest()[:16]}', *names,
                                 *_VOLUME_AND_FIELD]))
    made.compiled = compiled
    return made


@cache
def _named(name: str) -> type:
    made = namedtuple(name, name.split(_BETWEEN)[1:], module=__name__)
    setattr(sys.modules[__name__], name, made)      # where pickle looks for it
    return made


def __getattr__(name: str) -> type:
    """Return the class of that name, for pickle."""
    if name.startswith('_') or _BETWEEN not in name:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return _named(name)

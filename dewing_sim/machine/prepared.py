# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels compiled beforehand, for all processors of a kind: where they are and whether they fit.

The package `dewing_kernels`, or the folder that DEWING_KERNELS names, holds them as the cache of
a user does, one folder for each package of the sources, and `target.json`: the system, processor
and features that they were compiled for. They are read, never written. Python, numba, llvmlite
and the sources are told apart by the index of each kernel, as in the user's own cache.
"""

import json
import os
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType
from typing import Any

from numba.core import caching
from numba.core.registry import cpu_target

PACKAGE, VARIABLE, TARGET = 'dewing_kernels', 'DEWING_KERNELS', 'target.json'
BASELINE = 'x86-64-v3'      # AVX2: Intel from 2013 on, AMD from 2015 on
FEATURES = ','.join(f'+{name}' for name in (
    '64bit', 'avx', 'avx2', 'bmi', 'bmi2', 'cmov', 'crc32', 'cx16', 'cx8', 'f16c', 'fma', 'fxsr',
    'lzcnt', 'mmx', 'movbe', 'popcnt', 'sahf', 'sse', 'sse2', 'sse3', 'sse4.1', 'sse4.2',
    'ssse3', 'xsave'))


def folder() -> str | None:
    """Return the folder of prepared kernels, None if there is none."""
    named = os.environ.get(VARIABLE)
    if named is not None:
        return named or None
    try:
        spec = find_spec(PACKAGE)
    except (ImportError, ValueError):
        return None
    return next(iter(spec.submodule_search_locations or ()), None) if spec else None


@cache
def _target(place: str) -> tuple | None:
    try:
        found = json.loads((Path(place) / TARGET).read_text(encoding='utf-8'))
        return str(found['triple']), str(found['cpu']), str(found['features'])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def target(here: tuple[str, str, str]) -> tuple[str, str, str] | None:
    """Return what the kernels were compiled for, None where those do not run or none are.

    Both are system, processor and its features, as numba has them: ``here`` are those of this
    process. All features of the target have to be there.
    """
    place = folder()
    found = _target(place) if place else None
    if found is None or found[0] != here[0] or not _present(found[2]) <= _present(here[2]):
        return None
    return found


def host() -> tuple[str, str, str]:
    """Return system, processor and features that this process compiles for."""
    return cpu_target.target_context.codegen().magic_tuple()


def _present(features: str) -> set[str]:
    return {name for name in features.split(',') if name.startswith('+')}


def write_target(place: Path, made_for: tuple[str, str, str]) -> None:
    """Say in a folder of kernels what they were compiled for."""
    text = json.dumps(dict(zip(('triple', 'cpu', 'features'), made_for)), indent=2)
    (place / TARGET).write_text(text + '\n', encoding='utf-8')


class Locator(caching._CacheLocator):
    """Puts the kernels of a package into a folder of its name below `folder`."""

    def __init__(self, function: FunctionType):
        self._package = function.__module__.rpartition('.')[0]
        self._py_file = function.__code__.co_filename

    def get_cache_path(self) -> str:
        """Return the folder of a kernel's package."""
        return os.path.join(folder() or '', self._package)

    def get_source_stamp(self) -> Any:
        """Return nothing: kernels go by content."""

    def get_disambiguator(self) -> str:
        """Return nothing: kernels go by content."""
        return ''

    @classmethod
    def from_function(cls, py_func: FunctionType, py_file: str) -> Any:
        """Return the locator of a function, None where nothing is prepared."""
        return cls(py_func) if folder() else None


def baseline() -> dict[str, str]:
    """Return the environment of a process that compiles for `BASELINE`."""
    return {'NUMBA_CPU_NAME': BASELINE, 'NUMBA_CPU_FEATURES': FEATURES}

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled functions on disk, found by their content.

Numba itself looks at the file of a function, so that a change of what the function calls has no
effect. Here the stamp of an index is the `content.digest` of the function. What cannot be read,
for example since it names a module that an upgrade has moved, counts as not there and is replaced;
where nothing can be written, functions are compiled at each start. Before it comes to that, they
are sought among those `prepared` beforehand.
"""

import glob
import os
import pickle
import sys
import uuid
from types import FunctionType
from typing import Any

from numba.core import caching

from dewing_sim.machine import content, prepared


class _UserWide(caching.UserWideCacheLocator):
    """The folder below the user's home; none for a user who has no home."""

    @classmethod
    def from_function(cls, py_func, py_file):
        if not os.path.isabs(cls(py_func, py_file).get_cache_path()):
            return None
        return super().from_function(py_func, py_file)


class _Implementation(caching.CompileResultCacheImpl):
    """Names files after a function alone, not after its line; inner functions by content."""

    _locator_classes = [_UserWide if locator is caching.UserWideCacheLocator else locator
                        for locator in caching.CacheImpl._locator_classes]

    def __init__(self, function: FunctionType, digest: str):
        self._digest = digest
        super().__init__(function)

    def get_filename_base(self, fullname: str, abiflags: str) -> str:
        name = fullname.replace('<', '').replace('>', '')
        if name != fullname:            # several of one name may live at a time
            name = f'{name}-{self._digest[:16]}'
        return f'{name}.py{sys.version_info[0]}{sys.version_info[1]}{abiflags}'


class _Prepared(_Implementation):
    _locator_classes = [prepared.Locator]


def write_prepared() -> None:
    """Let this process keep what it compiles in `prepared.folder`, and look nowhere else."""
    _Implementation._locator_classes = [prepared.Locator]


class _Files(caching.IndexDataCacheFile):
    """An index, and data in files of names that are never used twice.

    Otherwise two processes that compile at the same time could leave the index of one with the
    data of the other.
    """

    def _load_index(self) -> dict:
        try:
            return super()._load_index()
        except Exception:               # unpickling may raise anything
            return {}

    def _data_name(self, number: int) -> str:
        return self._data_name_pattern.format(number=number).replace(
            '.nbc', f'.{self._source_stamp[:16]}-{uuid.uuid4().hex[:16]}.nbc')

    def save(self, key: Any, data: Any) -> None:
        """Save an overload; remove what was compiled of other sources."""
        if not self._load_index():
            base = os.path.join(self._cache_path, self._index_name.removesuffix('nbi'))
            for path in glob.glob(f'{glob.escape(base)}*.nbc'):
                if self._source_stamp[:16] not in path:
                    os.unlink(path)
        super().save(key, data)


class KernelCache(caching.FunctionCache):
    """The cache of one compiled function, opened at its first call: by then all is defined."""

    def __init__(self, function: FunctionType, options: dict[str, Any]):
        self._py_func, self._options = function, options
        self._name = repr(function)
        self._cache_path = self._cache_file = None
        self._digest = ''
        self.enable()

    def _open(self) -> bool:
        """Find the folder and return True, or False where there is none."""
        if self._cache_file is None and self._enabled:
            self._digest = content.digest(self._py_func, self._options)
            try:
                self._impl = _Implementation(self._py_func, self._digest)
            except (RuntimeError, OSError, TypeError):      # no folder, or no file
                self.disable()
                return False
            self._cache_path = self._impl.locator.get_cache_path()
            self._cache_file = _Files(self._cache_path, self._impl.filename_base, self._digest)
        return self._enabled

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the function compiled for a signature, None if it is not there."""
        for load in (self._load_own, self._load_prepared):
            try:
                found = load(sig, target_context)
            except Exception:           # unpickling may raise anything
                continue
            if found is not None:
                return found
        return None

    def _load_own(self, sig: Any, target_context: Any) -> Any:
        return super().load_overload(sig, target_context) if self._open() else None

    def _load_prepared(self, sig: Any, target_context: Any) -> Any:
        made_for = prepared.target(target_context.codegen().magic_tuple())
        if made_for is None:
            return None
        place = _Prepared(self._py_func, self._digest)
        files = _Files(place.locator.get_cache_path(), place.filename_base, self._digest)
        data = files.load((sig, made_for, content.classes(sig)))
        return data and place.rebuild(target_context, data)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled function where that is possible."""
        if not self._open():
            return
        try:
            super().save_overload(sig, data)
        except (OSError, pickle.PicklingError):
            return

    def flush(self) -> None:
        """Forget all that is kept of this function."""
        if self._open():
            super().flush()

    def _index_key(self, sig: Any, codegen: Any) -> tuple:
        return sig, codegen.magic_tuple(), content.classes(sig)

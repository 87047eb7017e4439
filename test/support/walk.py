# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which files a V^2 walks through: where something else comes out when only V^2 differs."""

import dataclasses
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

import dewing_sim

ROOT = Path(dewing_sim.__file__).parent


def files_of(prepare: Callable[[], Callable[[float], None]], low: float, high: float) -> list[str]:
    """Return the files of dewing_sim on the walk of V^2, in the order of entry.

    ``prepare()`` returns a function that makes one step under a V^2, always from the same state.
    A file is on the walk if its functions return something else under the other value: what takes
    a V^2 and leaves it without effect is not. Of compiled functions only what Python makes of
    their results is seen.
    """
    for v_squared in (low, high):       # so that nothing is compiled or made first later on
        prepare()(v_squared)
    first, second = _trace(prepare(), low), _trace(prepare(), high)
    return [file for file in second if first.get(file) != second[file]]


def _trace(step: Callable[[float], None], v_squared: float) -> dict[str, set]:
    """Return what came out of the functions of each file, files in the order of entry."""
    found: dict[str, set] = {}

    def profile(frame, event, argument):
        code = frame.f_code
        if not code.co_filename.startswith(str(ROOT)) or event not in ('call', 'return'):
            return
        out = found.setdefault(str(Path(code.co_filename).relative_to(ROOT)), set())
        if event == 'return':           # a set: how often it is called says nothing
            out.add((code.co_name, _digest(argument)))

    sys.setprofile(profile)
    try:
        step(v_squared)
    finally:
        sys.setprofile(None)
    return found


def _digest(value, depth: int = 4):
    """Return something to compare values by: numbers, arrays and what is made of them."""
    if isinstance(value, np.ndarray):
        return value.tobytes()
    if isinstance(value, (int, float, complex, str, np.generic)):
        return value
    if depth and isinstance(value, (tuple, list)):
        return tuple(_digest(item, depth - 1) for item in value)
    if depth and dataclasses.is_dataclass(value) and not isinstance(value, type):
        return tuple(_digest(getattr(value, field.name, None), depth - 1)
                     for field in dataclasses.fields(value))
    return type(value).__name__

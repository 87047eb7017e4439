# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which files a V^2 walks through: where arguments or results differ when only V^2 differs."""

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
    What it enters with the same arguments and leaves with the same result under both values is
    not on the walk.
    Compiled functions show that they are called, not with what; those that other compiled
    functions call do not show.
    """
    for v_squared in (low, high):       # so that nothing is compiled or made first later on
        prepare()(v_squared)
    first, second = _trace(prepare(), low), _trace(prepare(), high)
    return [file for file in second if first.get(file) != second[file]]


def _trace(step: Callable[[float], None], v_squared: float) -> dict[str, list]:
    """Return what went in and out of the functions of each file."""
    found: dict[str, list] = {}

    def profile(frame, event, argument):
        code = frame.f_code
        if not code.co_filename.startswith(str(ROOT)) or event not in ('call', 'return'):
            return
        file = str(Path(code.co_filename).relative_to(ROOT))
        values = (argument if event == 'return' else
                  tuple(frame.f_locals.get(name) for name in code.co_varnames[:code.co_argcount]))
        found.setdefault(file, []).append((code.co_name, event, _digest(values)))

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

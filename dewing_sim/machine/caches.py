# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Results kept in the user's cache folder: a convenience, never a condition.

What cannot be read is removed and computed anew; where there is no folder, or none that can be
written to, nothing is kept. Names hold a `fingerprint` of what the result depends on.
"""

import os
import tempfile
from pathlib import Path
from typing import Callable, TypeVar

from dewing_sim.errors import BadInput

Kept = TypeVar('Kept')


def folder() -> Path | None:
    """Return $XDG_CACHE_HOME/dewing, else ~/.cache/dewing; None for a user without a home."""
    named = Path(os.environ.get('XDG_CACHE_HOME', ''))
    if not named.is_absolute():         # such are to be ignored, XDG says
        try:
            named = Path.home() / '.cache'
        except RuntimeError:
            return None
    return named / 'dewing'


def recall(name: str, read: Callable[[Path], Kept]) -> Kept | None:
    """Return what ``read`` makes of the kept file ``name``; None if there is none."""
    place = folder()
    if place is None or not os.access(place / name, os.F_OK):
        return None
    try:
        return read(place / name)
    except (BadInput, OSError):
        try:
            (place / name).unlink(missing_ok=True)
        except OSError:
            pass                        # not ours to remove
        return None


def keep(name: str, write: Callable[[Path], object]) -> None:
    """Let ``write`` make a file that appears as ``name`` at once; a full disk is no failure."""
    place = folder()
    if place is None:
        return
    try:
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=place, ignore_cleanup_errors=True) as drafts:
            draft = Path(drafts) / name
            write(draft)
            draft.replace(place / name)
    except (BadInput, OSError):
        return

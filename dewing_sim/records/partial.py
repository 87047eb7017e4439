# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A run kept along the way, so that what nobody can refuse, SIGKILL or a power cut, spares it."""

from pathlib import Path
from time import monotonic

from dewing_sim.files import is_stream
from dewing_sim.records.history import Recorder

PERIOD = 5.0                # s of wall time between two saves, at least
SHARE = 0.05                # of the wall time for saving, at most


def path_of(out: str | None) -> Path | None:
    """Return where a run whose file will be ``out`` is kept meanwhile, None for a stream."""
    return Path(f'{out}.partial') if out and not is_stream(out) else None


class Partial:
    """Writes what a recorder holds to ``<out>.partial`` every few seconds, a file of `History`.

    A save is complete or not made. Without ``out`` nothing is written.
    """

    def __init__(self, out: str | None, recorder: Recorder, period: float = PERIOD):
        """Save what ``recorder`` holds every ``period`` s."""
        self.path = path_of(out)
        self._recorder, self._period = recorder, period
        self._due = monotonic() + period

    def keep(self) -> None:
        """Write the file if it is time."""
        if not self.path or monotonic() < self._due:
            return
        began = monotonic()
        self._recorder.history().save(self.path, overwrite=True)
        now = monotonic()
        self._due = now + max(self._period, (now - began) / SHARE)

    def remove(self) -> None:
        """Remove the file: the whole run is where it was wanted."""
        if self.path:
            self.path.unlink(missing_ok=True)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A loop that makes no progress says so: since when, in which state, and what it waits for."""

import time
from collections.abc import Callable
from typing import Any

from dewing_sim.ros.awake import Awake

PATIENCE = 5.0              # s, wall, without progress before it is said


class Watchdog:
    """Looks at the progress of one loop; ``warn`` is told a sentence when there has been none.

    The sentence stays the same until the loop goes on, so that it is logged once.
    """

    def __init__(self, warn: Callable[[str], None], patience: float = PATIENCE):
        """Allow ``patience`` s of wall time between two signs of progress."""
        self._warn, self._patience = warn, patience
        self._progress: Any = None
        self._awake = Awake()
        self._since, self._when = 0.0, ''

    def rest(self) -> None:
        """Allow the whole patience from the next look on: no progress was due."""
        self._progress = None

    def look(self, progress: Any, where: str) -> bool:
        """Return whether ``progress`` has been the same for too long, and warn if it has.

        ``where`` tells the state of the loop and what it waits for.
        """
        now = self._awake()
        if progress != self._progress:
            self._progress, self._since = progress, now
            self._when = time.strftime('%H:%M:%S')
        stalled = now - self._since > self._patience
        if stalled:
            self._warn(f'no progress since {self._when}: {where}')
        return stalled

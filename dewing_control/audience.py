# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The listeners of ``command`` that the first answer of a controller waits for."""

from typing import Any


class Audience:
    """Whether all listeners have been there: once they have, nobody waits for them again."""

    def __init__(self):
        """Begin before anybody was there."""
        self._complete = False

    def absent(self, publisher: Any, wanted: int) -> int:
        """Return how many of ``wanted`` listeners of ``publisher`` are waited for."""
        if self._complete:
            return 0
        absent = max(wanted - publisher.get_subscription_count(), 0)
        self._complete = not absent
        return absent

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The reference that controllers follow: from the first measured camber to the target, a ramp."""


def ramp(reference: float | None, camber: float, target: float, largest: float) -> float:
    """Return the next reference, at most ``largest`` from the last; the first is ``camber``."""
    if reference is None:
        return camber
    return reference + min(max(target - reference, -largest), largest)

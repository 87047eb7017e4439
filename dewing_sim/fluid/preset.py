# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of a named grid before an engine is made."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class GridPreset:
    """The cost of a step and its largest size; an engine adds what its own grids are made of.

    ``milliseconds`` are those of a step of a rigid plate, expected: they order computations,
    measure progress and let ``engine: auto`` take the faster engine.  ``largest_step`` (c/U) is
    the largest time step known to be sound.
    """

    milliseconds: float = 1.0
    largest_step: float = math.inf

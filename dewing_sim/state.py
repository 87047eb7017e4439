# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a wing between two steps."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dewing_sim.structure.dynamics.motion import Motion


@dataclass(frozen=True, eq=False)
class State:
    """Everything the next step depends on; lengths in chords, speeds in U.

    ``jump_history`` (0 to 3, columns) are the pressure jumps without added mass of the last
    steps, newest first: what a wall without acceleration would have felt.
    """

    step: int
    v_squared: float                # V^2 held during the last step
    flow: Any
    motion: Motion
    iterations: int = 0             # coupling iterations of the last step
    residual: float = 0.0           # its last change of the shape, relative to its deflection
    jump_history: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    clipped: int = 0                # steps so far whose V^2 was clipped, see `structure.bearable`

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a wing between two steps."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dewing_sim.coupling.iteration import Coupled
from dewing_sim.structure.dynamics.motion import Motion


@dataclass(frozen=True, eq=False)
class State:
    """Everything the next step depends on; lengths in chords, speeds in U."""

    step: int
    v_squared: float                # V^2 held during the last step
    flow: Any
    motion: Motion
    iterations: int = 0             # coupling iterations of the last step
    residual: float = 0.0           # its last relative change of shape
    jump_history: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))  # see `Coupled`

    @classmethod
    def after(cls, step: int, v_squared: float, coupled: Coupled) -> 'State':
        """Return the state at the end of a coupled step."""
        return cls(step, v_squared, coupled.flow, coupled.motion, coupled.iterations,
                   coupled.residual, coupled.jump_history)

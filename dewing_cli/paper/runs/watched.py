# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant that says how far its run is."""

from typing import Any

from dewing_cli.paper.runs.result import Tick
from dewing_sim.inputs.base import Inputs
from dewing_sim.wing import Wing

TICK_STEPS = 50             # between two reports
TRIM_SHARE = 0.1            # of a run's progress: the rest state is mostly known already


class Watched:
    """A plant that reports the progress of a run."""

    def __init__(self, plant: Wing, steps: int, tick: Tick):
        """Count ``steps`` of ``plant``."""
        self.plant, self.dt, self.observe = plant, plant.dt, plant.observe
        self.steps, self.tick = steps, tick

    def step(self, state: Any, inputs: Inputs) -> Any:
        """Return the next state of the plant."""
        if state.step % TICK_STEPS == 0:
            self.tick(TRIM_SHARE + (1.0 - TRIM_SHARE) * state.step / self.steps)
        return self.plant.step(state, inputs)

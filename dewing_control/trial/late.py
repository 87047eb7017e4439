# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that take effect late, as they do over a network in real time."""

import random
from dataclasses import dataclass
from typing import Any, NamedTuple

from dewing_control.law.supervisor import Controller
from dewing_sim.plant import Measurement


class Memory(NamedTuple):
    """Memory of the controller, V^2 of the commands under way and of that in force, the step."""

    inner: Any
    under_way: tuple[float, ...]    # oldest first
    v_squared: float
    step: int


@dataclass(frozen=True)
class Late:
    """A controller of which the plant obeys every command ``delay`` steps late.

    A share ``jitter`` of the commands, drawn from ``seed``, comes a step later still: the one
    before stays in force, and the next makes it out of date. A delay of zero with no jitter is
    the controller itself.
    """

    controller: Controller
    delay: int
    jitter: float = 0.0
    seed: int = 1

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory of a controller that takes over, without a bump, at ``v_squared``."""
        return Memory(self.controller.start(v_squared), (v_squared,) * self.delay, v_squared, 0)

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Return the next memory and the V^2 that takes effect now."""
        inner, command = self.controller.step(memory.inner, measurement)
        due, *under_way = *memory.under_way, command
        if self.jitter and random.Random(f'{self.seed} {memory.step}').random() < self.jitter:
            due = memory.v_squared
        return Memory(inner, tuple(under_way), due, memory.step + 1), due


def late(controller: Controller, delay: int, jitter: float = 0.0, seed: int = 1) -> Controller:
    """Return ``controller``, obeyed late if there is a delay or jitter."""
    return Late(controller, delay, jitter, seed) if delay or jitter else controller

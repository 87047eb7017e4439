# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What every controller has in common: a sampling period and a safe answer to bad input."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from dewing_sim.errors import DewingError, RunFailed
from dewing_sim.plant import Measurement


class Controller(Protocol):
    """A pure discrete-time feedback law; everything it remembers is in ``memory``."""

    def start(self, v_squared: float = 0.0) -> Any:
        """Return the memory of a controller that takes over at ``v_squared``."""

    def step(self, memory: Any, measurement: Measurement) -> tuple[Any, float]:
        """Return the next memory and V^2."""


class Memory(NamedTuple):
    """Memory of the controller below, V^2 in force, and two counters."""

    inner: Any                      # None until a usable measurement has come
    v_squared: float
    steps: int                      # since the last control instant
    unusable: int                   # measurements in a row


@dataclass(frozen=True)
class Supervisor:
    """Step ``controller`` every ``period`` measurements and keep V^2 safe without them.

    A measurement that is not finite repeats the last V^2; after ``hold`` of them in a row V^2 is
    zero, and the controller starts afresh from there when usable measurements return.

    What the law asks for is kept between zero and ``limit`` (V^2). Raises `RunFailed` if the law
    itself fails or asks for a V^2 that is not finite.
    """

    controller: Controller
    period: int
    hold: int
    limit: float = math.inf

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory before the first measurement; V^2 in force is ``v_squared``."""
        return Memory(None, v_squared, 0, 0)

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Answer one measurement of the plant with V^2."""
        memory = self._after(memory, measurement)
        return memory, memory.v_squared

    def _after(self, memory: Memory, measurement: Measurement) -> Memory:
        if not all(map(math.isfinite, measurement)):
            return self._without_measurement(memory)
        if memory.inner is not None and memory.steps + 1 < self.period:
            return memory._replace(steps=memory.steps + 1, unusable=0)
        try:
            inner = memory.inner
            if inner is None:
                inner = self.controller.start(memory.v_squared)
            inner, v_squared = self.controller.step(inner, measurement)
            usable = math.isfinite(v_squared)
        except DewingError:
            raise
        except Exception as error:                  # a law from outside may raise anything
            raise RunFailed(f'the control law failed at {measurement.time:g} s '
                            f'({type(error).__name__}: {" ".join(str(error).split())})') from error
        if not usable:
            raise RunFailed(f'the control law asked for V^2 = {v_squared} at '
                            f'{measurement.time:g} s')
        return Memory(inner, min(max(v_squared, 0.0), self.limit), 0, 0)

    def _without_measurement(self, memory: Memory) -> Memory:
        unusable = memory.unusable + 1
        if unusable > self.hold:
            return Memory(None, 0.0, 0, unusable)
        return memory._replace(steps=memory.steps + 1, unusable=unusable)

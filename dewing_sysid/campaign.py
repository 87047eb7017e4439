# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The runs of a plan driven by measurements: what to answer, what was recorded, what is next."""

from collections.abc import Mapping

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.lockstep import nanoseconds
from dewing_sysid.plan import BASELINE, Plan


class Campaign:
    """Goes through the runs of ``plan``, the baseline first; before each the plant is at rest.

    `answer` takes measurements in the order of their stamps; a repeated one gets the same answer.
    """

    def __init__(self, plan: Plan):
        """Stand before the first run."""
        self.plan = plan
        self.outputs = {run: np.empty((len(plan.names), len(v_squared)))
                        for run, v_squared in plan.inputs.items()}
        self._waiting = [BASELINE, *(run for run in plan.inputs if run != BASELINE)]
        self.run: str | None = self._waiting.pop(0)
        self._next, self._done = 0, 0
        self._total = sum(map(len, plan.inputs.values()))

    @property
    def progress(self) -> float:
        """Return the recorded share of all samples, from 0 to 1."""
        return (self._done + self._next) / self._total

    @property
    def run_complete(self) -> bool:
        """Return whether the present run has all its samples."""
        return self._next == len(self.plan.inputs[self.run])

    @property
    def begun(self) -> bool:
        """Return whether the present run has any sample."""
        return self._next > 0

    def answer(self, stamp: int, values: Mapping[str, float]) -> float | None:
        """Record the outputs ``values`` at ``stamp`` (ns) and return V^2 to hold, or None.

        None answers what is not the measurement awaited, nor the last one again.  Raises
        `BadInput` if a measurement was lost, if it does not have the outputs of the plan or if
        the stamp is no multiple of dt.
        """
        number = round(stamp * 1.0e-9 / self.plan.dt)
        if stamp != nanoseconds(number * self.plan.dt):
            raise BadInput(f'measurement at {stamp} ns is no multiple of dt = {self.plan.dt:g} s')
        if number > self._next and self.begun:
            raise BadInput(f'measurement {self._next} of run {self.run!r} was lost: '
                           f'{number} came after {self._next - 1}')
        if number == self._next and not self.run_complete:
            self.outputs[self.run][:, number] = self._observed(values)
            self._next += 1
        elif number != self._next - 1:
            return None
        return float(self.plan.inputs[self.run][number])

    def _observed(self, values: Mapping[str, float]) -> list[float]:
        try:
            return [values[name] for name in self.plan.names]
        except KeyError:
            missing = [name for name in self.plan.names if name not in values]
            raise BadInput(f'the simulator does not publish {", ".join(missing)}') from None

    def proceed(self) -> None:
        """Go on to the next run; ``run`` is None after the last."""
        self._done += self._next
        self._next = 0
        self.run = self._waiting.pop(0) if self._waiting else None

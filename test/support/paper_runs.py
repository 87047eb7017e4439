# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Runs that take no time and a tiny plan, for the tests of the report; processes import them."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dewing_cli.paper.plan import QUICK
from dewing_cli.paper.runs.result import Result
from dewing_sim.errors import RunFailed

TINY = replace(
    QUICK, grids={'finite_volume': 'fast', 'conformal': 'realtime'}, trim=0.2, rest=0.2,
    shed=2.0, variant=1.0, loop=0.02, averaged=0.01, long=0.2, frames=2,
    variants=((4.0, 'finite_volume', 'fast', 1.0e-4), (8.0, 'conformal', 'realtime', 1.0e-4)),
    chords=(0.030,), shares=(0.5,), swings=())


@dataclass(frozen=True)
class Sum:
    """One more than the sum of what is needed; leaves a line in ``log``."""

    needs: tuple[str, ...] = ()
    log: str = ''
    cost: float = 1.0
    fails: bool = False
    endless: bool = False

    def __call__(self, tick, inputs):
        if self.log:
            with open(Path(self.log), 'a') as file:
                file.write('run\n')
        while self.endless:
            tick(0.5)
        if self.fails:
            raise RunFailed('slack')
        tick(1.0)
        total = 1 + sum(inputs[name].values['total'] for name in self.needs)
        return Result({'total': total}, {'series': np.arange(3.0)})

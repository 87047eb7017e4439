# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow engines by name."""

from dewing_sim.fluid.base import Fluid
from dewing_sim.fluid.finite_volume.engine import FiniteVolume
from dewing_sim.fluid.memory import keep_freed_arrays

ENGINES = {'finite_volume': FiniteVolume}


def make(engine: str, grid: str, reynolds: float, alpha: float, dt: float) -> Fluid:
    """Return an engine on a grid preset; ``alpha`` in rad, ``dt`` in c/U."""
    keep_freed_arrays()
    return ENGINES[engine].preset(grid, reynolds, alpha, dt)

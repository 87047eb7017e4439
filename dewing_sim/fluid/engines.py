# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow engines by name."""

from dewing_sim.errors import BadInput
from dewing_sim.fluid.base import Fluid
from dewing_sim.fluid.conformal import engine as conformal
from dewing_sim.fluid.conformal.grid import PRESETS as CONFORMAL_GRIDS
from dewing_sim.fluid.finite_volume import engine as finite_volume
from dewing_sim.fluid.finite_volume.grid import PRESETS as FINITE_VOLUME_GRIDS
from dewing_sim.machine.memory import keep_freed_arrays

ENGINES = {'finite_volume': finite_volume.FiniteVolume, 'conformal': conformal.Conformal}
STATES = {'finite_volume': finite_volume.FlowState, 'conformal': conformal.FlowState}
GRIDS = {'finite_volume': FINITE_VOLUME_GRIDS, 'conformal': CONFORMAL_GRIDS}


def make(engine: str, grid: str, reynolds: float, alpha: float, dt: float) -> Fluid:
    """Return an engine on a grid preset; ``alpha`` in rad, ``dt`` in c/U.

    Raises `BadInput` for a grid that the engine does not have.
    """
    if grid not in GRIDS[engine]:
        raise BadInput(f'numerics.grid = {grid!r} does not go with the engine {engine}: '
                       f"one of {', '.join(GRIDS[engine])}")
    keep_freed_arrays()
    return ENGINES[engine].preset(grid, reynolds, alpha, dt)

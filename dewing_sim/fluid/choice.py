# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which flow engine goes with a case: what ``engine: auto`` stands for.

The conformal engine computes a step faster and takes longer ones; it is taken wherever it has been
verified. Everything else is for the finite-volume engine, which knows no gusts.
"""

import math
from dataclasses import dataclass

from dewing_sim.errors import BadInput
from dewing_sim.fluid.conformal.grid import LARGEST_STEP
from dewing_sim.fluid.engines import GRIDS

AUTO = 'auto'
CAMBER = 0.15               # chords
REYNOLDS = (100.0, 10000.0)
ALPHA = 12.0                # deg


@dataclass(frozen=True)
class Demand:
    """What is asked of an engine: largest expected camber (chords), ``alpha`` (rad), dt (c/U)."""

    grid: str
    camber: float
    reynolds: float
    alpha: float
    dt: float
    disturbed: bool = False     # by a gust or a rigid motion


def choose(engine: str, demand: Demand) -> str:
    """Return ``engine``, or the one for ``demand`` if it is 'auto'.

    A disturbance always asks for the conformal engine.  Raises `BadInput` for one on another
    engine, and where no engine goes with ``demand``.
    """
    if engine != AUTO:
        if demand.disturbed and engine != 'conformal':
            raise BadInput(f'numerics.engine = {engine!r} knows no gust nor rigid_motion: '
                           'conformal does')
        return engine
    reason = obstacle(demand)
    if demand.disturbed or not reason:
        return 'conformal'
    if demand.grid not in GRIDS['finite_volume']:
        raise BadInput(f'numerics.grid = {demand.grid!r} is one of the conformal engine, for '
                       f'which {reason}')
    return 'finite_volume'


def obstacle(demand: Demand) -> str | None:
    """Return why the conformal engine is not for ``demand``, None if it is."""
    degrees = abs(math.degrees(demand.alpha))
    for name, value, low, high in (
            ('camber', abs(demand.camber), 0.0, CAMBER),
            ('Reynolds number', demand.reynolds, *REYNOLDS),
            ('angle of attack in deg', degrees, 0.0, ALPHA),
            ('time step in c/U', demand.dt, 0.0, LARGEST_STEP[demand.grid])):
        if not low <= value <= high:
            return f'a {name} of {value:.4g} is outside {low:g} to {high:g}'
    return None

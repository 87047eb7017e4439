# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Which flow engine goes with a case: what ``engine: auto`` stands for.

Of the engines that have the grid, take the inflows and have been verified for the rest, it is the
one that computes a step fastest; each knows all this of itself, see `base.Fluid`.
"""

from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Demand

AUTO = 'auto'
SECTIONS = {'gust': 'gust', 'motion': 'rigid_motion'}      # of a case, by the inflow they make


def choose(engine: str, demand: Demand) -> str:
    """Return ``engine``, or the one for ``demand`` if it is 'auto'.

    With a gust or a motion it need not have been verified, as few engines take them.  Raises
    `BadInput` for an engine that does not take the inflows of ``demand``, and where none goes
    with it.
    """
    if engine != AUTO:
        _require_inflows(engine, demand)
        return engine
    able = {name: found for name, found in _built_in().items()
            if demand.grid in found.grids and demand.inflows <= found.inflows}
    obstacles = {name: found.obstacle(demand) for name, found in able.items()}
    candidates = [name for name in able if demand.inflows or obstacles[name] is None]
    if not candidates:
        reasons = '; '.join(f'one of the {name} engine, for which {reason}'
                            for name, reason in obstacles.items())
        raise BadInput(f"numerics.grid = {demand.grid!r} is {reasons or 'of no engine for this'}")
    return min(candidates, key=lambda name: able[name].grids[demand.grid].milliseconds)


def _built_in() -> dict[str, type]:
    return {name: engines.find(name) for name in engines.NAMES}


def _require_inflows(engine: str, demand: Demand) -> None:
    unknown = demand.inflows - engines.find(engine).inflows
    if unknown:
        able = [name for name, found in _built_in().items() if unknown <= found.inflows]
        raise BadInput(f"numerics.engine = {engine!r} knows no "
                       f"{' nor '.join(SECTIONS[kind] for kind in sorted(unknown))}: "
                       f"{', '.join(able)} does")

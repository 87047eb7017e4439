# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The flow engines by name.

An engine is a package of its own, which declares ``NAME`` and ``GRIDS`` and whose ``load`` returns
its class, with the kernels; one line here makes it known.  ``package.module:Class`` names an
engine from outside.  The class says all else, see `base.Fluid`.
"""

from typing import TYPE_CHECKING

from dewing_sim.errors import BadInput
from dewing_sim.fluid import conformal, finite_volume
from dewing_sim.machine.memory import keep_freed_arrays
from dewing_sim.schema import plugins

if TYPE_CHECKING:
    from dewing_sim.fluid.base import Fluid

PACKAGES = {package.NAME: package for package in (finite_volume, conformal)}
NAMES = tuple(PACKAGES)
GRIDS = tuple(dict.fromkeys(grid for package in PACKAGES.values() for grid in package.GRIDS))
WORD = 'numerics.engine'
# Of `base.Fluid`: what is on the class, and what one that has been made has beside.
CLASS_MEMBERS = ('name', 'grids', 'state', 'inflows', 'free_edges', 'preset', 'obstacle',
                 'rest', 'with_circulation', 'predict', 'correct', 'loads', 'monitor', 'slip',
                 'caution', 'field', 'suction', 'parts')
MADE_MEMBERS = ('alpha', 'dt', 'columns', 'impedance', 'cells')


def find(engine: str) -> type['Fluid']:
    """Return the class of an engine by its name, or by ``package.module:Class``.

    Raises `BadInput` if there is none, or what there is is no engine.
    """
    if engine in PACKAGES:
        return PACKAGES[engine].load()
    if not plugins.is_plugin(engine):
        raise BadInput(f"{WORD} = {engine!r} is not known; one of {', '.join(NAMES)} or "
                       'package.module:Class')
    return _checked(plugins.load(engine, WORD), engine)


def make(engine: str, grid: str, reynolds: float, alpha: float, dt: float) -> 'Fluid':
    """Return an engine on a grid preset; ``alpha`` in rad, ``dt`` in c/U.

    Raises `BadInput` for a grid that the engine does not have.
    """
    found = find(engine)
    if grid not in found.grids:
        raise BadInput(f'numerics.grid = {grid!r} does not go with the engine {engine}: '
                       f"one of {', '.join(found.grids)}")
    keep_freed_arrays()
    fluid = found.preset(grid, reynolds, alpha, dt)
    if plugins.is_plugin(engine):
        _require(fluid, engine, MADE_MEMBERS)
    return fluid


def _checked(found: object, engine: str) -> type['Fluid']:
    """Return a class from outside; raise `BadInput` unless it fulfils the protocol."""
    if not isinstance(found, type):
        raise BadInput(f'{WORD} = {engine!r} is not a class')
    _require(found, engine, CLASS_MEMBERS)
    return found


def _require(part: object, engine: str, names: tuple[str, ...]) -> None:
    missing = [name for name in names if not hasattr(part, name)
               or name in getattr(part, '__abstractmethods__', ())]
    if missing:
        raise BadInput(f"{WORD} = {engine!r} is no flow engine: it lacks {', '.join(missing)} of "
                       'dewing_sim.fluid.base.Fluid')

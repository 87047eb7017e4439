# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Static equilibrium under pressure and voltage by Newton iterations along load steps."""

import math
from typing import Callable

import numpy as np
from scipy.linalg import solve_banded

from dewing_sim.errors import Diverged, NotConverged, RunFailed
from dewing_sim.structure.base import Structure

TOLERANCE = 1.0e-12     # chords
ROUNDING = 1.0e-9       # chords, below which a correction that no longer shrinks is rounding
ITERATIONS = 40
SMALLEST_SHARE = 2.0 ** -13


def equilibrium(structure: Structure, pressure, v_squared: float, follower: bool = True,
                ) -> np.ndarray:
    """Return the static position (nodes, 2) under a pressure jump, scalar or (n,).

    Newton from the rest state, first in pressure, then in V^2, in as few load steps as converge.
    A ``follower`` pressure stays normal to the structure, otherwise to its rest state. Raises
    `Slack`, `Diverged` or `NotConverged` at the load that could not be passed.
    """
    pressure = np.asarray(pressure, dtype=float)

    def solve(start, load, square):
        try:
            position = newton(structure, start, square, load, follower)
        except RunFailed:
            structure.require_bearable(start, square)
            raise
        structure.require_taut(position, square)
        return position

    passive = march(lambda position, share: solve(position, share * pressure, 0.0),
                    structure.rest_position)
    return march(lambda position, share: solve(position, pressure, share * v_squared), passive)


def newton(structure: Structure, position: np.ndarray, v_squared: float, pressure=0.0,
           follower: bool = True, held: float | np.ndarray = 0.0) -> np.ndarray:
    """Return the position in equilibrium with pressure and dead nodal forces ``held``."""
    force = structure.pressure_force(structure.rest_position, pressure)
    previous, before = np.inf, None
    for _ in range(ITERATIONS):
        if follower:
            force = structure.pressure_force(position, pressure)
        imbalance = structure.internal_force(position, v_squared) - force - held
        band = structure.tangent(position, v_squared, pressure if follower else 0.0,
                                 before)
        correction = _solve(band, imbalance.ravel()[structure.free])
        before, position = position, position.copy()
        position.reshape(-1)[structure.free] -= correction
        size = np.abs(correction).max() / structure.chord
        if size <= TOLERANCE or 0.5 * previous < size < ROUNDING:
            return position
        previous = size
    raise NotConverged(f'static equilibrium at {math.sqrt(v_squared):.6g} V: correction '
                       f'{size:.3g} chords after {ITERATIONS} iterations; '
                       'reduce pressure or voltage')


def _solve(band: np.ndarray, imbalance: np.ndarray) -> np.ndarray:
    width = len(band) // 2
    try:
        return solve_banded((width, width), band, imbalance)
    except (np.linalg.LinAlgError, ValueError):
        raise Diverged('the stiffness is singular or not finite; '
                       'the membrane carries no tension') from None


def march(solve: Callable[[np.ndarray, float], np.ndarray], position: np.ndarray,
          smallest: float = SMALLEST_SHARE, first: float = 1.0) -> np.ndarray:
    """Raise the share of a load from 0 to 1 by steps, halved on failure, doubled after."""
    share, step = 0.0, first
    while share < 1.0:
        try:
            position = solve(position, min(1.0, share + step))
        except RunFailed:
            step *= 0.5
            if step < smallest:
                raise
        else:
            share, step = share + step, 2.0 * step
    return position

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Static equilibrium under pressure and voltage by Newton iterations along load steps.

Where the path of equilibria turns back, as it does when the end of a thick strip snaps over its
pin, no smaller step helps: there the structure slides downhill in its potential, overdamped, to
the equilibrium that it would snap to, and the path goes on from there.
"""

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
SNAP = 2.0 ** -6        # share of a load by which a structure is taken over a fold of its path
SLIDES = 2000           # most steps of a slide
DRAG, LEAST_DRAG, MOST_DRAG = 1.0e-3, 1.0e-15, 1.0e9      # of the stiffness, at first and at ends


def equilibrium(structure: Structure, pressure, v_squared: float, follower: bool = True,
                ) -> np.ndarray:
    """Return the static position (nodes, 2) under a pressure jump, scalar or (n,).

    Newton from the rest state, first in pressure, then in V^2, in as few load steps as converge,
    over folds by `slide`.
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

    def snap(start, load, square):
        structure.require_bearable(start, square)
        return solve(slide(structure, start, square, load, follower), load, square)

    passive = march(lambda position, share: solve(position, share * pressure, 0.0),
                    structure.rest_position,
                    snap=lambda position, share: snap(position, share * pressure, 0.0))
    return march(lambda position, share: solve(position, pressure, share * v_squared), passive,
                 snap=lambda position, share: snap(position, pressure, share * v_squared))


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


def slide(structure: Structure, position: np.ndarray, v_squared: float, pressure=0.0,
          follower: bool = True, held: float | np.ndarray = 0.0) -> np.ndarray:
    """Return where the structure comes to rest in a viscous medium, from ``position`` on.

    The linearly implicit Euler method on the gradient flow of the potential, with a drag that
    falls as long as steps go downhill (pseudo-transient continuation, Kelley and Keyes 1998,
    doi:10.1137/S0036142996304796). Raises `NotConverged` if it comes to no rest.
    """
    def gradient(at):
        force = structure.pressure_force(at if follower else structure.rest_position, pressure)
        return (structure.internal_force(at, v_squared) - force - held).ravel()[structure.free]

    slope, drag, stiffness = gradient(position), DRAG, 0.0
    for _ in range(SLIDES):
        band = structure.tangent(position, v_squared, pressure if follower else 0.0)
        stiffness = stiffness or float(np.abs(band[len(band) // 2]).max())
        while LEAST_DRAG < drag < MOST_DRAG:
            try:
                change, after, below = _slid(position, slope, band, drag * stiffness,
                                             structure.free, gradient)
            except RunFailed:                   # an element turned inside out, say
                drag *= 4.0
                continue
            position, slope, drag = after, below, 0.4 * drag
            break
        if drag >= MOST_DRAG:
            break
        if drag <= LEAST_DRAG or change <= TOLERANCE * structure.chord:
            return position
    raise NotConverged(f'static equilibrium at {math.sqrt(v_squared):.6g} V: no rest after '
                       'a fold of the path of equilibria; reduce pressure or voltage')


def _slid(position, slope, band, drag: float, free, gradient):
    """Return size, end and gradient there of a step downhill; raise `RunFailed` if it is not."""
    dragged = band.copy()
    dragged[len(band) // 2] += drag
    change, after = -_solve(dragged, slope), position.copy()
    after.reshape(-1)[free] += change
    descent, below = float(slope @ change), gradient(after)
    if not (descent <= 0.0 and float(below @ change) <= -0.5 * descent):
        raise NotConverged('the step leads uphill')
    return float(np.abs(change).max()), after, below


def march(solve: Callable[[np.ndarray, float], np.ndarray], position: np.ndarray,
          smallest: float = SMALLEST_SHARE, first: float = 1.0,
          snap: Callable[[np.ndarray, float], np.ndarray] | None = None) -> np.ndarray:
    """Raise the share of a load from 0 to 1 by steps, halved on failure, doubled after.

    Where the smallest step fails, ``snap`` is asked for the solution a little further on.
    """
    share, step = 0.0, first
    while share < 1.0:
        try:
            position = solve(position, min(1.0, share + step))
        except RunFailed as error:
            step *= 0.5
            if step < smallest:
                position = _snapped(snap, position, min(1.0, share + SNAP), error)
                share, step = share + SNAP, SNAP
        else:
            share, step = share + step, 2.0 * step
    return position


def _snapped(snap, position: np.ndarray, share: float, error: RunFailed) -> np.ndarray:
    """Return what ``snap`` finds; raise ``error``, which called for it, if it finds nothing."""
    if snap is None:
        raise error
    try:
        return snap(position, share)
    except RunFailed:
        raise error from None

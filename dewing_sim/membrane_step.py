# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The time step of an elastic membrane under a flow, one compiled call an iteration.

It is that of `structure.dynamics` with the same equations and the same Newton's method. What the
compiled iteration cannot do, a stretch beyond the `TensionCurve` or a share of the imbalance, is
left to the general one.
"""

from functools import lru_cache

import numba
import numpy as np

from dewing_sim.structure.band import solve
from dewing_sim.structure.dynamics import Motion, Operator, Step, Structure
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.tension_curve import POINTS, TensionCurve
from dewing_sim.transfer import Load, add_load

TAUT = 1.0e-3       # of the usual tension: more than the last correction can take


def step_of(structure: Structure, motion: Motion, dt: float, v_squared: float,
            operator: Operator, damping: float = 0.0) -> Step:
    """Return the equations of a time step, compiled as far as they can be."""
    if isinstance(structure, Membrane) and structure.viscosity is None:
        return MembraneStep(structure, motion, dt, v_squared, operator, damping)
    return Step(structure, motion, dt, v_squared, operator, damping)


class MembraneStep(Step):
    """`Step` of an elastic membrane under a `Load`."""

    def __init__(self, structure: Membrane, motion: Motion, dt: float, v_squared: float,
                 operator: Operator, damping: float = 0.0):
        """Take the curve of the tension at ``v_squared``."""
        super().__init__(structure, motion, dt, v_squared, operator, damping)
        self._curve = _curve(structure, v_squared)
        self._lowest_tension = -np.inf

    def _iterate(self, load: Load, position: np.ndarray, held: np.ndarray | None,
                 ) -> tuple[np.ndarray, float]:
        if self._curve is None or held is not None or load.has_frame_acceleration:
            return super()._iterate(load, position, held)
        curve, inverse, motion, fluid = self._curve, self._inverse, self.motion, load.fluid
        moved, size, self._lowest_tension = _iterated(
            position, motion.position, motion.position_before, motion.velocity,
            motion.velocity_before, self.structure.mass, self.dt, self.damping,
            self.structure.stretch_per_length, curve.middle, curve.half, curve.differences,
            fluid.columns, load.jump, load.velocity, fluid.resistance, load.wall_pressure,
            inverse.factors, inverse.row, inverse.column, inverse.value, inverse.answer)
        if self._lowest_tension == -np.inf:
            return super()._iterate(load, position, held)
        return moved, size

    def _require_taut(self, position: np.ndarray) -> None:
        if not (self._curve and self._lowest_tension > TAUT * self._curve.differences[0]):
            super()._require_taut(position)


@lru_cache(maxsize=2)
def _curve(membrane: Membrane, v_squared: float) -> TensionCurve | None:
    """Return the curve of one V^2, which is often held over many steps."""
    return TensionCurve.of(membrane.sheet, membrane.prestretch, v_squared)


@numba.njit(cache=True, error_model='numpy')
def _iterated(position, now, before, velocity_now, velocity_before, mass, dt, damping,
              stretch_per_length, middle, half, differences, columns, jump, reference, resistance,
              uniform, factors, row, column, value, answer):
    """Return the next position, the largest correction and the lowest tension before it.

    The tension is minus infinity, and nothing else of worth, beyond the curve.
    """
    velocity, force = np.empty(position.shape), np.empty(position.shape)
    for i in range(mass.size):
        for k in range(2):
            w = (3.0 * position[i, k] - 4.0 * now[i, k] + before[i, k]) * (0.5 / dt)
            velocity[i, k] = w
            force[i, k] = -mass[i] * (damping * w + (
                3.0 * w - 4.0 * velocity_now[i, k] + velocity_before[i, k]) * (0.5 / dt))
    lowest = _add_tension(position, stretch_per_length, middle, half, differences, force)
    add_load(columns, position, velocity, jump, reference, resistance, uniform, force)
    correction = np.empty((1, 2 * mass.size - 4))
    for i in range(1, mass.size - 1):
        correction[0, 2 * i - 2], correction[0, 2 * i - 1] = force[i, 0], force[i, 1]
    size = solve(factors, row, column, value, answer, correction)
    force[0, 0], force[0, 1] = position[0, 0], position[0, 1]
    last = mass.size - 1
    force[last, 0], force[last, 1] = position[last, 0], position[last, 1]
    for i in range(1, last):
        force[i, 0] = position[i, 0] + correction[0, 2 * i - 2]
        force[i, 1] = position[i, 1] + correction[0, 2 * i - 1]
    return force, size, lowest


@numba.njit(cache=True, error_model='numpy')
def _add_tension(position, stretch_per_length, middle, half, differences, force):
    """Add the pull of the elements on their nodes (n + 1, 2); return the lowest tension."""
    n, last = stretch_per_length.size, differences.size - 1
    x, y = np.empty(n), np.empty(n)
    per_length, place, tension = np.empty(n), np.empty(n), np.empty(n)
    lowest, farthest = np.inf, 0.0
    for k in range(n):
        x[k] = position[k + 1, 0] - position[k, 0]
        y[k] = position[k + 1, 1] - position[k, 1]
        length = np.sqrt(x[k] * x[k] + y[k] * y[k])
        per_length[k] = 1.0 / length
        place[k] = (length * stretch_per_length[k] - middle) / half
        tension[k] = differences[last]
    for i in range(last - 1, -1, -1):
        for k in range(n):
            tension[k] = differences[i] + (place[k] - POINTS[i]) * tension[k]
    for k in range(n):
        pull = tension[k] * per_length[k]
        force[k, 0] += pull * x[k]
        force[k, 1] += pull * y[k]
        force[k + 1, 0] -= pull * x[k]
        force[k + 1, 1] -= pull * y[k]
        lowest, farthest = min(lowest, tension[k]), max(farthest, abs(place[k]))
    return lowest if farthest <= 1.0 else -np.inf

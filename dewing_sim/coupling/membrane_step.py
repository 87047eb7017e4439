# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The time step of a membrane under a flow, with compiled iterations.

It is that of `structure.dynamics` with the same equations and the same Newton's method. What the
compiled iteration cannot do, accelerated axes or a share of the imbalance, is left to the general
one.
"""

import math
from functools import lru_cache

import numpy as np

from dewing_sim.coupling.transfer import Load, add_load
from dewing_sim.machine.kernels import kernel
from dewing_sim.structure.dynamics.band import solve
from dewing_sim.structure.dynamics.step import Motion, Operator, Step, Structure
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.tension_curve import TensionCurve

TAUT = 1.0e-3       # of the usual tension: more than the last correction can take


def step_of(structure: Structure, motion: Motion, dt: float, v_squared: float,
            operator: Operator, damping: float = 0.0) -> Step:
    """Return the equations of a time step, compiled as far as they can be."""
    kind = MembraneStep if isinstance(structure, Membrane) else Step
    return kind(structure, motion, dt, v_squared, operator, damping)


class MembraneStep(Step):
    """`Step` of a membrane under a `Load`; an elastic one follows its `TensionCurve`."""

    def __init__(self, structure: Membrane, motion: Motion, dt: float, v_squared: float,
                 operator: Operator, damping: float = 0.0):
        super().__init__(structure, motion, dt, v_squared, operator, damping)
        self._curve = _curve(structure, v_squared) if structure.viscosity is None else None
        self._lowest_tension = -np.inf

    def _iterate(self, load: Load, position: np.ndarray, held: np.ndarray | None,
                 ) -> tuple[np.ndarray, float]:
        if held is not None or load.has_frame_acceleration:
            return super()._iterate(load, position, held)
        inverse, motion, fluid = self._inverse, self.motion, load.fluid
        return _iterated(
            position, self._tension(position), motion.position, motion.position_before,
            motion.velocity, motion.velocity_before, self.structure.mass, self.dt, self.damping,
            fluid.columns, load.jump, load.velocity, fluid.impedance, load.wall_pressure,
            inverse.factors, inverse.row, inverse.column, inverse.value, inverse.answer)

    def _tension(self, position: np.ndarray) -> np.ndarray:
        self._lowest_tension = -np.inf
        if self._curve:
            tension, lowest, is_covered = self._curve.along(
                position, self.structure.stretch_per_length)
            if is_covered:
                self._lowest_tension = lowest
                return tension
        return self.structure.tension(position, self.v_squared)

    def _require_taut(self, position: np.ndarray) -> None:
        if not (self._curve and self._lowest_tension > TAUT * self._curve.differences[0]):
            super()._require_taut(position)


@lru_cache(maxsize=2)
def _curve(membrane: Membrane, v_squared: float) -> TensionCurve | None:
    """Return the curve of one V^2, which is often held over many steps."""
    return TensionCurve.of(membrane.sheet, membrane.prestretch, v_squared)


@kernel
def _iterated(position, tension, now, before, velocity_now, velocity_before, mass, dt, damping,
              columns, jump, reference, impedance, uniform, factors, row, column, value, answer):
    """Return the next position and the largest correction."""
    velocity, force = np.empty(position.shape), np.empty(position.shape)
    for i in range(mass.size):
        for k in range(2):
            w = (3.0 * position[i, k] - 4.0 * now[i, k] + before[i, k]) * (0.5 / dt)
            velocity[i, k] = w
            force[i, k] = -mass[i] * (damping * w + (
                3.0 * w - 4.0 * velocity_now[i, k] + velocity_before[i, k]) * (0.5 / dt))
    _add_pull(position, tension, force)
    add_load(columns, position, velocity, jump, reference, impedance, uniform, force)
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
    return force, size


@kernel
def _add_pull(position, tension, force):
    """Add the pull of the elements on their nodes (n + 1, 2)."""
    for k in range(tension.size):
        x, y = position[k + 1, 0] - position[k, 0], position[k + 1, 1] - position[k, 1]
        per_length = tension[k] / math.sqrt(x * x + y * y)
        force[k, 0] += per_length * x
        force[k, 1] += per_length * y
        force[k + 1, 0] -= per_length * x
        force[k + 1, 1] -= per_length * y

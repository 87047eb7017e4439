# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled iteration of a membrane under a flow.

It corrects a position by the same equations as `structure.dynamics.step`. Accelerated axes are
left to the general iteration. An elastic membrane follows its `TensionCurve`.
"""

import math
from functools import lru_cache

import numpy as np

from dewing_sim.coupling.transfer import Load, add_load
from dewing_sim.machine.kernels import kernel
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.band import Inverse, solve
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.tension_curve import TensionCurve

TAUT = 1.0e-3       # of the usual tension: more than the last correction can take


def iteration_of(structure: Moving, motion: Motion, v_squared: float, operator: Operator,
                 ) -> 'MembraneIteration | None':
    """Return the compiled iteration of a step that follows ``motion``, None if there is none."""
    if not isinstance(structure, Membrane):
        return None
    return MembraneIteration(structure, motion, v_squared, operator)


class MembraneIteration:
    """The `dynamics.step.Iteration` of a membrane under a `Load`."""

    def __init__(self, structure: Membrane, motion: Motion, v_squared: float,
                 operator: Operator):
        """Take the tension curve if the membrane is elastic."""
        self.structure, self.motion, self.v_squared = structure, motion, v_squared
        self.operator, self._lowest_tension = operator, -math.inf
        self._curve = curve_of(structure, v_squared) if structure.viscosity is None else None

    def takes(self, load: Load) -> bool:
        """Return whether the axes are at rest."""
        return not load.has_frame_acceleration

    def __call__(self, load: Load, position: np.ndarray, inverse: Inverse,
                 ) -> tuple[np.ndarray, float]:
        """Return the position after one correction by ``inverse``, and its largest entry."""
        motion = self.motion
        return corrected(
            position, self._tension(position), motion.history, self.structure.mass,
            (self.operator.dt, self.operator.damping), load.flow, inverse.parts)

    @property
    def is_taut(self) -> bool:
        """Whether the tension is that of the curve and far from zero."""
        return (self._curve is not None
                and self._lowest_tension > TAUT * self._curve.differences[0])

    def _tension(self, position: np.ndarray) -> np.ndarray:
        self._lowest_tension = -math.inf
        if self._curve:
            tension, lowest, is_covered = self._curve.along(
                position, self.structure.stretch_per_length)
            if is_covered:
                self._lowest_tension = lowest
                return tension
        return self.structure.tension(position, self.v_squared)


@lru_cache(maxsize=2)
def curve_of(membrane: Membrane, v_squared: float) -> TensionCurve | None:
    """Return the curve of one V^2, which is often held over many steps."""
    return TensionCurve.of(membrane.sheet, membrane.prestretch, v_squared)


@kernel
def corrected(position, tension, history, mass, scheme, load, inverse):
    """Return the next position and the largest correction.

    ``history`` is `Motion.history`, ``scheme`` dt and damping, ``load`` a `ColumnLoad` and
    ``inverse`` the `Inverse.parts`.
    """
    (now, before, velocity_now, velocity_before), (dt, damping) = history, scheme
    velocity, force = np.empty(position.shape), np.empty(position.shape)
    for i in range(mass.size):
        for k in range(2):
            w = (3.0 * position[i, k] - 4.0 * now[i, k] + before[i, k]) * (0.5 / dt)
            velocity[i, k] = w
            force[i, k] = -mass[i] * (damping * w + (
                3.0 * w - 4.0 * velocity_now[i, k] + velocity_before[i, k]) * (0.5 / dt))
    _add_pull(position, tension, force)
    add_load(load, position, velocity, force)
    correction = np.empty((1, 2 * mass.size - 4))
    for i in range(1, mass.size - 1):
        correction[0, 2 * i - 2], correction[0, 2 * i - 1] = force[i, 0], force[i, 1]
    size = solve(inverse, correction)
    last = mass.size - 1
    force[0, 0], force[0, 1] = position[0, 0], position[0, 1]
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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One implicit time step of a structure under a given load: BDF2 with chord-Newton iterations.

With d positions, w velocities and kappa = 3 / (2 dt), on the free degrees of freedom,

    w = (3 d - 4 d_n + d_n-1) / (2 dt),    a = (3 w - 4 w_n + w_n-1) / (2 dt),
    M (a + damping w) + f_int(d, V^2) = load(d, w),

second order in dt and the scheme of the flow, so that both see the same wall velocity.
"""

from dataclasses import dataclass
from typing import Callable, Protocol

import numba
import numpy as np

from dewing_sim.errors import Diverged, NotConverged
from dewing_sim.structure.band import Inverse, LowRank
from dewing_sim.structure.motion import Motion
from dewing_sim.structure.statics import march

ITERATIONS = 30
SMALLEST_SHARE = 2.0 ** -6
SHRINKAGE = 4.0     # a chord correction that shrinks by less is replaced by Newton's

Load = Callable[[np.ndarray, np.ndarray], np.ndarray]


class Structure(Protocol):
    """What a time step needs of a structure; nodal arrays are (nodes, 2), forces per span."""

    rest_position: np.ndarray
    mass: np.ndarray                    # (nodes,), lumped

    @property
    def chord(self) -> float:
        """Length to which corrections are compared."""

    @property
    def free(self) -> slice | np.ndarray:
        """Entries of a raveled nodal array that may move: m degrees of freedom."""

    def internal_force(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the nodal gradient of the potential energy."""

    def tangent(self, position: np.ndarray, v_squared: float, pressure: float = 0.0,
                before: np.ndarray | None = None) -> np.ndarray:
        """Return its derivative, a symmetric band (2 w + 1, m) on the free degrees of freedom.

        ``before`` is the position of the last iteration, if any.
        """

    def surface(self, nodal: np.ndarray) -> np.ndarray:
        """Return what the flow sees of nodal positions or velocities, (n + 1, 2), linear."""

    def spread(self, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces of forces (n + 1, 2) on the surface, its transpose."""

    def during(self, motion: Motion, dt: float, v_squared: float) -> 'Structure':
        """Return the structure with what it remembers in the step that follows ``motion``."""

    def after(self, motion: Motion, position: np.ndarray, v_squared: float, dt: float,
              ) -> np.ndarray:
        """Return the memory after a step from ``motion`` to ``position``."""

    def require_taut(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` if the structure cannot carry its state."""


@dataclass(frozen=True, eq=False)
class Operator:
    """Inverse of the iteration matrix at a reference state, made once and used in every step.

    ``resistance`` (m, m) is -d(load)/d(velocity).
    """

    resistance: LowRank
    inverse: Inverse

    @classmethod
    def of(cls, structure: Structure, dt: float, resistance: LowRank | None = None,
           damping: float = 0.0, position: np.ndarray | None = None, v_squared: float = 0.0,
           ) -> 'Operator':
        """Return the operator about ``position``, by default the structure's rest state.

        The reference only sets the speed of convergence, never the result: a state near the
        motion, such as the trimmed one, saves iterations.
        """
        position = structure.rest_position if position is None else position
        resistance = resistance or LowRank.zero(position.ravel()[structure.free].size)
        return cls(resistance, _inverse(structure, position, v_squared, dt, resistance, damping))


def _inverse(structure: Structure, position: np.ndarray, v_squared: float, dt: float,
             resistance: LowRank, damping: float, before: np.ndarray | None = None) -> Inverse:
    """Return the inverse of kappa^2 M + kappa (R + damping M) + K(position)."""
    kappa = 1.5 / dt
    band = structure.tangent(position, v_squared, 0.0, before)
    band[len(band) // 2] += kappa * (kappa + damping) * np.repeat(structure.mass, 2)[
        structure.free]
    return Inverse.of(band, resistance, kappa)


@numba.njit(cache=True)
def _imbalance(mass, velocity, now, before, dt, damping, internal, load):
    """Return M (a + damping w) + f_int - load, (nodes, 2)."""
    result = np.empty_like(velocity)
    for i in range(mass.size):
        for k in range(2):
            rate = (3.0 * velocity[i, k] - 4.0 * now[i, k] + before[i, k]) / (2.0 * dt)
            result[i, k] = (mass[i] * (rate + damping * velocity[i, k])
                            + internal[i, k] - load[i, k])
    return result


def advance(structure: Structure, motion: Motion, dt: float, v_squared: float, load: Load,
            operator: Operator, damping: float = 0.0, tolerance: float = 1.0e-10,
            guess: np.ndarray | None = None) -> Motion:
    """Return the motion one step later, a pure function of the arguments.

    ``load(position, velocity)`` returns the external nodal forces (nodes, 2), affine in velocity
    with the slope -``operator.resistance``. ``damping`` is mass-proportional (1/time). Iterates
    from ``guess`` (`Motion.predict` by default) until the largest correction falls below
    ``tolerance`` chords; where that is slow with ``operator``, with a fresh one; and where the
    guess is poor, as after a jump of voltage, by Newton's method from the present position, if
    necessary in several shares of the imbalance there. Raises `Slack`, `Diverged` or
    `NotConverged`.
    """
    structure = structure.during(motion, dt, v_squared)
    step = _Step(structure, motion, dt, v_squared, load, operator, damping, tolerance)
    start = motion.predict(dt) if guess is None else guess
    position = step.by_chords(start, operator.inverse)
    if position is None:
        position = step.by_chords(start, None)
    if position is None:
        position = march(step.by_newton, motion.position, SMALLEST_SHARE)
    structure.require_taut(position, v_squared)
    return Motion(position, motion.rate(position, dt), motion.position, motion.velocity,
                  structure.after(motion, position, v_squared, dt))


@dataclass(frozen=True)
class _Step:
    """The equations of one step, see `advance`."""

    structure: Structure
    motion: Motion
    dt: float
    v_squared: float
    load: Load
    operator: Operator
    damping: float
    tolerance: float

    def inverse(self, position: np.ndarray, before: np.ndarray | None = None) -> Inverse:
        """Return the inverse of the iteration matrix about ``position``."""
        return _inverse(self.structure, position, self.v_squared, self.dt,
                        self.operator.resistance, self.damping, before)

    def residual(self, position: np.ndarray) -> np.ndarray:
        """Return the imbalance (m,) of the free degrees of freedom."""
        velocity = self.motion.rate(position, self.dt)
        return _imbalance(
            self.structure.mass, velocity, self.motion.velocity, self.motion.velocity_before,
            self.dt, self.damping, self.structure.internal_force(position, self.v_squared),
            self.load(position, velocity)).reshape(-1)[self.structure.free]

    def by_chords(self, start: np.ndarray, inverse: Inverse | None) -> np.ndarray | None:
        """Return the position after iterations with one inverse, or None if they are slow.

        Without ``inverse`` it is made at ``start``.
        """
        position, previous = np.array(start), np.inf
        for _ in range(ITERATIONS):
            try:
                inverse = inverse or self.inverse(start, self.motion.position)
                correction = inverse(self.residual(position))
            except Diverged:
                return None
            size = np.abs(correction).max()
            if not size <= max(previous / SHRINKAGE, self._accuracy):
                return None
            position.reshape(-1)[self.structure.free] -= correction
            if size <= self._accuracy:
                return position
            previous = size
        return None

    def by_newton(self, start: np.ndarray, share: float) -> np.ndarray:
        """Return the position where ``share`` of the imbalance of the present one is gone."""
        held = (1.0 - share) * self.residual(self.motion.position) if share < 1.0 else 0.0
        position, before, inverse, previous = start, None, self.inverse(start), np.inf
        for iteration in range(ITERATIONS):
            with np.errstate(invalid='ignore'):
                residual = self.residual(position) - held
            correction = inverse(residual)
            size = np.abs(correction).max()
            if size > max(previous / SHRINKAGE, self._accuracy):
                inverse = self.inverse(position, before)
                correction = inverse(residual)
                size = np.abs(correction).max()
            if not np.isfinite(size):
                raise Diverged(f'structure: non-finite residual or correction in iteration '
                               f'{iteration}; check the load or reduce the time step',
                               self.motion)
            before, position = position, position.copy()
            position.reshape(-1)[self.structure.free] -= correction
            if size <= self._accuracy:
                return position
            previous = size
        self.structure.require_taut(position, self.v_squared)
        raise NotConverged(f'structure: largest correction {size / self.structure.chord:.3g} '
                           f'chords, residual {np.abs(residual).max():.3g} after {ITERATIONS} '
                           f'iterations (tolerance {self.tolerance:.3g}); reduce the time step',
                           self.motion)

    @property
    def _accuracy(self) -> float:
        return self.tolerance * self.structure.chord

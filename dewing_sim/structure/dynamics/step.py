# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One implicit time step of a structure under a given load: BDF2 with Newton iterations.

With d positions, w velocities and kappa = 3 / (2 dt), on the free degrees of freedom,

    w = (3 d - 4 d_n + d_n-1) / (2 dt),    a = (3 w - 4 w_n + w_n-1) / (2 dt),
    M (a + damping w) + f_int(d, V^2) = load(d, w),

second order in dt and the scheme of the flow, so that both see the same wall velocity.
"""

import math
from dataclasses import dataclass
from typing import Callable, Protocol

import numpy as np

from dewing_sim.errors import Diverged, NotConverged, RunFailed
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.band import Inverse, LowRank
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.statics import march

ITERATIONS = 30
SMALLEST_SHARE = 2.0 ** -6
SHRINKAGE = 4.0     # a correction by an old tangent that shrinks by less is replaced

Load = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Operator:
    """Inverse of the iteration matrix at a reference state, made once and used in every step.

    It belongs to one time step ``dt`` and one mass-proportional ``damping`` (1/time).
    ``impedance`` (m, m) is -d(load)/d(velocity).
    """

    dt: float
    damping: float
    impedance: LowRank
    inverse: Inverse

    @classmethod
    def of(cls, structure: Moving, dt: float, impedance: LowRank | None = None,
           damping: float = 0.0, position: np.ndarray | None = None, v_squared: float = 0.0,
           ) -> 'Operator':
        """Return the operator about ``position``, by default the structure's rest state.

        The reference only sets the speed of convergence, never the result: a state near the
        motion, such as the trimmed one, saves iterations.
        """
        position = structure.rest_position if position is None else position
        impedance = impedance or LowRank.zero(position.ravel()[structure.free].size)
        band = _band(structure, position, v_squared, dt, damping)
        return cls(dt, damping, impedance, Inverse.of(band, impedance, 1.5 / dt))


def _band(structure: Moving, position: np.ndarray, v_squared: float, dt: float,
          damping: float, before: np.ndarray | None = None) -> np.ndarray:
    """Return kappa^2 M + kappa damping M + K(position) as a band."""
    kappa = 1.5 / dt
    band = structure.tangent(position, v_squared, 0.0, before)
    band[len(band) // 2] += kappa * (kappa + damping) * np.repeat(structure.mass, 2)[
        structure.free]
    return band


class Iteration(Protocol):
    """A faster form of the iteration of a `Step`, for the loads that it takes."""

    def takes(self, load: Load) -> bool:
        """Return whether it can correct a position under ``load``."""

    def __call__(self, load: Load, position: np.ndarray, inverse: Inverse,
                 ) -> tuple[np.ndarray, float]:
        """Return the position after one correction by ``inverse``, and its largest entry."""

    @property
    def is_taut(self) -> bool:
        """Whether its last correction cannot have taken the tension; if not, look."""


def advance(structure: Moving, motion: Motion, v_squared: float, load: Load,
            operator: Operator, tolerance: float = 1.0e-10,
            guess: np.ndarray | None = None) -> Motion:
    """Return the motion one step later under one load, see `Step`. Raises `Slack` also."""
    step = Step(structure.during(motion, operator.dt, v_squared), motion, v_squared, operator)
    start = motion.predict(operator.dt) if guess is None else guess
    return step.end(step.reach(load, start, tolerance))


class Step:
    """The equations of one time step, solved for one load after another.

    ``structure`` remembers what it does during this step. Loads ``load(position, velocity)``
    return the external nodal forces (nodes, 2), affine in velocity with the slope
    -``operator.impedance``. Newton's method goes on until the largest correction falls below a
    tolerance (chords). It keeps a tangent, at first that of ``operator``, as long as corrections
    stay in the linear range of the structure and shrink well; new tangents keep the flow's part
    of the operator. The last tangent serves the next load. Where that fails, as after a jump of
    voltage, the step is made from the present position in several shares of the imbalance there.
    ``iteration`` does the work where it can.
    """

    def __init__(self, structure: Moving, motion: Motion, v_squared: float,
                 operator: Operator, iteration: Iteration | None = None):
        """Start from the operator's tangent."""
        self.structure, self.motion, self.v_squared = structure, motion, v_squared
        self.operator, self.dt, self.accuracy = operator, operator.dt, 0.0
        self._iteration = iteration
        self._inverse = None if structure.linear_range < np.inf else operator.inverse
        self._exact, self._reached = False, None

    def reach(self, load: Load, guess: np.ndarray, tolerance: float = 1.0e-10) -> np.ndarray:
        """Return the position under ``load``; raise `Diverged` or `NotConverged`.

        The first iteration starts at ``guess``, or, where a structure has a short linear range,
        at the present position; later loads start at what the one before reached.
        """
        present, keeps = self.motion.position, self.structure.linear_range == np.inf
        self.accuracy = min(tolerance * self.structure.chord, self.structure.linear_range)
        start = guess if keeps else present
        self._exact = False
        try:
            position = self._newton(load, start if self._reached is None else self._reached)
        except RunFailed:
            self._exact = True
            position = march(lambda at, share: self._share(load, at, share), present,
                             SMALLEST_SHARE, 1.0 if keeps else 0.5)
        self._reached = position
        return position

    def end(self, position: np.ndarray) -> Motion:
        """Return the motion that ends at ``position``; raise `Slack` if it has no tension."""
        if self._iteration is None or not self._iteration.is_taut:
            self.structure.require_taut(position, self.v_squared)
        motion = self.motion
        return Motion(position, motion.rate(position, self.dt), motion.position, motion.velocity,
                      self.structure.after(motion, position, self.v_squared, self.dt))

    def _residual(self, load: Load, position: np.ndarray) -> np.ndarray:
        """Return the imbalance (m,) of the free degrees of freedom."""
        motion, velocity = self.motion, self.motion.rate(position, self.dt)
        force = (self.structure.internal_force(position, self.v_squared)
                 + self.structure.mass[:, None] * motion.acceleration(
                     velocity, self.dt, self.operator.damping))
        force -= load(position, velocity)
        return force.reshape(-1)[self.structure.free]

    def _inverted(self, position: np.ndarray, before: np.ndarray | None) -> Inverse:
        """Return the inverse at ``position``; unless exact, with the operator's flow part."""
        band = _band(self.structure, position, self.v_squared, self.dt, self.operator.damping,
                     before)
        if self._exact:
            return Inverse.of(band, self.operator.impedance, 1.5 / self.dt)
        return self.operator.inverse.about(band)

    def _share(self, load: Load, start: np.ndarray, share: float) -> np.ndarray:
        """Return the position where ``share`` of the imbalance of the present one is gone."""
        held = (1.0 - share) * self._residual(load, self.motion.position) if share < 1.0 else None
        self._inverse = None
        return self._newton(load, start, held)

    def _newton(self, load: Load, start: np.ndarray, held: np.ndarray | None = None) -> np.ndarray:
        """Return the position where the imbalance is ``held`` (m,), by default zero."""
        position, before, previous = start, None, np.inf
        for iteration in range(ITERATIONS):
            moved, size = self._improved(load, position, held, before, previous)
            if not math.isfinite(size):
                raise Diverged(f'structure: non-finite residual or correction in iteration '
                               f'{iteration}; check the load or reduce the time step',
                               self.motion)
            before, position = position, moved
            if size <= self.accuracy:
                return position
            previous = size
        self.structure.require_taut(position, self.v_squared)
        raise NotConverged(f'structure: largest correction {size / self.structure.chord:.3g} '
                           f'chords after {ITERATIONS} iterations '
                           f'(tolerance {self.accuracy / self.structure.chord:.3g}); '
                           'reduce the time step', self.motion)

    def _improved(self, load: Load, position: np.ndarray, held: np.ndarray | None,
                  before: np.ndarray | None, previous: float) -> tuple[np.ndarray, float]:
        """Return `_iterate` with a new tangent if the last one is stale."""
        moved = previous if before is not None else 0.0
        if self._inverse is not None and moved <= self.structure.linear_range:
            position_after, size = self._iterate(load, position, held)
            if size <= max(previous / SHRINKAGE, self.accuracy):
                return position_after, size
        self._inverse = self._inverted(position, before)
        return self._iterate(load, position, held)

    def _iterate(self, load: Load, position: np.ndarray, held: np.ndarray | None,
                 ) -> tuple[np.ndarray, float]:
        """Return the position after one correction by the inverse at hand, and its size."""
        if self._iteration and held is None and self._iteration.takes(load):
            return self._iteration(load, position, self._inverse)
        residual = self._residual(load, position)
        if held is not None:
            with np.errstate(invalid='ignore'):
                residual -= held
        correction, size = self._inverse(residual)
        moved = position.copy()
        moved.reshape(-1)[self.structure.free] -= correction
        return moved, size

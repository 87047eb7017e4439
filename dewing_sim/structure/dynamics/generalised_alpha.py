# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One step of a structure alone by the generalised-alpha scheme (Chung and Hulbert).

With the spectral radius r of the highest frequencies (doi 10.1115/1.2900803),

    alpha_m = (2 r - 1) / (r + 1),  alpha_f = r / (r + 1),
    M ((1 - alpha_m) a1 + alpha_m a0) + (1 - alpha_f) R1 + alpha_f R0 = 0,  R = f_int(d) - load,

and Newmark's d and v with gamma = 1/2 - alpha_m + alpha_f, beta = (1 - alpha_m + alpha_f)^2 / 4:
second order, no damping at r = 1. The coupled wing keeps the BDF2 of `dynamics`: the flow's grid
velocity and added mass, 3 / (2 dt) times the change of the wall velocity, are BDF2 at the new time
level, and any other rule would let the wall move at a velocity that the flow does not see.
"""

from dataclasses import dataclass
from typing import Callable

import numpy as np

from dewing_sim.errors import BadInput, NotConverged
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.band import Inverse, LowRank
from dewing_sim.structure.dynamics.step import ITERATIONS


@dataclass(frozen=True, eq=False)
class Swing:
    """Position, velocity, acceleration and load (nodes, 2) at one time."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    load: np.ndarray

    @classmethod
    def of(cls, structure: Moving, position: np.ndarray, velocity: np.ndarray,
           v_squared: float, load: np.ndarray) -> 'Swing':
        """Return a state whose acceleration balances its forces."""
        imbalance = load - structure.internal_force(position, v_squared)
        acceleration = np.zeros_like(position)
        free = structure.free
        acceleration.reshape(-1)[free] = (imbalance / structure.mass[:, None]).reshape(-1)[free]
        return cls(position, velocity, acceleration, load)


@dataclass(frozen=True)
class Scheme:
    """The scheme's constants for ``spectral_radius`` from 0 to 1 and a time step."""

    spectral_radius: float
    dt: float

    def __post_init__(self):
        """Raise `BadInput` for a spectral radius out of range."""
        if not 0.0 <= self.spectral_radius <= 1.0:
            raise BadInput(f'spectral_radius = {self.spectral_radius} is out of range: '
                           'from 0 to 1')

    @property
    def alpha_m(self) -> float:
        """Weight of the old acceleration."""
        return (2.0 * self.spectral_radius - 1.0) / (self.spectral_radius + 1.0)

    @property
    def alpha_f(self) -> float:
        """Weight of the old forces."""
        return self.spectral_radius / (self.spectral_radius + 1.0)

    @property
    def gamma(self) -> float:
        """Newmark's gamma."""
        return 0.5 - self.alpha_m + self.alpha_f

    @property
    def beta(self) -> float:
        """Newmark's beta."""
        return 0.25 * (1.0 - self.alpha_m + self.alpha_f) ** 2

    def mean_acceleration(self, before: Swing, after: Swing) -> np.ndarray:
        """Return the acceleration that the momentum equation sees."""
        return (1.0 - self.alpha_m) * after.acceleration + self.alpha_m * before.acceleration

    def mean_force(self, before: np.ndarray, after: np.ndarray) -> np.ndarray:
        """Return the forces that it sees."""
        return (1.0 - self.alpha_f) * after + self.alpha_f * before

    def reached(self, start: Swing, position: np.ndarray, load: np.ndarray) -> Swing:
        """Return the state with Newmark's velocity and acceleration at ``position``."""
        dt, beta, gamma = self.dt, self.beta, self.gamma
        acceleration = ((position - start.position - dt * start.velocity) / (beta * dt * dt)
                        - (0.5 - beta) / beta * start.acceleration)
        velocity = start.velocity + dt * ((1.0 - gamma) * start.acceleration
                                          + gamma * acceleration)
        return Swing(position, velocity, acceleration, load)

    def advance(self, structure: Moving, start: Swing, v_squared: float,
                load: Callable[[np.ndarray], np.ndarray], tolerance: float = 1.0e-12) -> Swing:
        """Return the state after ``dt`` under V^2 and ``load(position)``, (nodes, 2).

        Newton until the largest correction falls below ``tolerance`` chords; the stiffness of the
        load is left out. Raises `NotConverged`.
        """
        free, position = structure.free, start.position
        resting = structure.internal_force(start.position, v_squared)
        before = None
        for _ in range(ITERATIONS):
            end = self.reached(start, position, load(position))
            internal = self.mean_force(resting, structure.internal_force(position, v_squared))
            residual = (structure.mass[:, None] * self.mean_acceleration(start, end) + internal
                        - self.mean_force(start.load, end.load)).reshape(-1)[free]
            correction, size = self._inverse(structure, position, v_squared, before)(residual)
            before, position = position, position.copy()
            position.reshape(-1)[free] -= correction
            if size <= tolerance * structure.chord:
                return self.reached(start, position, load(position))
        raise NotConverged(f'generalised alpha: largest correction {size / structure.chord:.3g} '
                           f'chords after {ITERATIONS} iterations; reduce the time step')

    def _inverse(self, structure: Moving, position: np.ndarray, v_squared: float,
                 before: np.ndarray | None) -> Inverse:
        band = (1.0 - self.alpha_f) * structure.tangent(position, v_squared, 0.0, before)
        inertia = (1.0 - self.alpha_m) / (self.beta * self.dt ** 2)
        band[len(band) // 2] += inertia * np.repeat(structure.mass, 2)[structure.free]
        return Inverse.of(band, LowRank.zero(band.shape[1]), 0.0)

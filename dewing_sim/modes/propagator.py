# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What becomes of a small perturbation of a steady wing: a difference of two short runs.

    P v = (F^N(x0 + h v) - F^N(x0 - h v)) / (2 h),      F^N: N steps under a constant V^2

exact but for terms of h^2, and for what solvers leave over: the membrane is solved to 1e-8 chords,
so h must move it by a thousandth of a millimetre or so. Perturbations that began as the difference
of two runs are combinations of states that a wing can have, and so keep what the fields of a state
have in common.
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.inputs.base import Inputs
from dewing_sim.modes.coordinates import Coordinates
from dewing_sim.state import State
from dewing_sim.wing import Wing

KICK = 100.0                    # V^2 s, which starts a perturbation: 450 V for half a ms


@dataclass(frozen=True, eq=False)
class Propagator:
    """Perturbations of ``base`` over ``steps`` steps of ``wing``, of the norm ``size``."""

    wing: Wing
    base: State
    steps: int
    size: float = 0.0
    weight: float = 1.0         # of the membrane in vectors

    @property
    def coordinates(self) -> Coordinates:
        """The vectors about the base."""
        return Coordinates(self.base, self.weight)

    @property
    def period(self) -> float:
        """Time in s over which it propagates."""
        return self.steps * self.wing.dt

    @property
    def dt(self) -> float:
        """The time step in c/U."""
        return self.wing.dt / self.wing.scales.time

    def march(self, state: State, kick: float = 0.0) -> State:
        """Return the state ``steps`` later; ``kick`` (V^2 s) is added to V^2, spread over them."""
        inputs = Inputs(self.wing.case.actuation.voltage**2 + kick / self.period)
        for _ in range(self.steps):
            state = self.wing.step(state, inputs)
        return state

    def kicked(self, kick: float = KICK) -> np.ndarray:
        """Return the perturbation (n,) that ``kick`` (V^2 s) has made after the steps."""
        vector, base = self.coordinates.vector, self.base
        return vector(self.march(base, kick)) - vector(self.march(base))

    def drift(self) -> float:
        """Return how far the base moves by itself, in norms of the perturbations."""
        vector = self.coordinates.vector
        return float(np.linalg.norm(vector(self.march(self.base)) - vector(self.base))) / self.size

    def __call__(self, perturbation: np.ndarray) -> np.ndarray:
        """Return P v for a real or complex ``perturbation`` v (n,), whatever its norm."""
        if np.iscomplexobj(perturbation):
            return self(perturbation.real) + 1j * self(perturbation.imag)
        norm = float(np.linalg.norm(perturbation))
        if norm == 0.0:
            return np.zeros_like(perturbation)
        middle = self.coordinates.vector(self.base)
        step = self.size / norm * perturbation
        ahead, behind = (self.coordinates.vector(self.march(self.coordinates.state(middle + each)))
                         for each in (step, -step))
        return (0.5 * norm / self.size) * (ahead - behind)


def of_kick(wing: Wing, base: State, steps: int, kick: float = KICK,
            ) -> tuple[Propagator, np.ndarray]:
    """Return the propagator for perturbations of the size of a kick, and that kick (n,).

    Its vectors weigh the membrane so that a kick moves flow and membrane equally far: else a mode
    of one of them would move it too much, or too little for the solvers to see.
    """
    first = Propagator(wing, base, steps).kicked(kick)
    balanced = Coordinates(base).balanced(first)
    vector = balanced.vector(Coordinates(base).state(first + Coordinates(base).vector(base)))
    vector = vector - balanced.vector(base)
    return Propagator(wing, base, steps, float(np.linalg.norm(vector)), balanced.weight), vector

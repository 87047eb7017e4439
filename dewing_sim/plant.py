# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What identification, control and the nodes know of a plant, whatever solves its equations."""

from dataclasses import dataclass, field
from typing import Any, Callable, Iterator, NamedTuple, Protocol

import numpy as np


@dataclass(frozen=True)
class Outputs:
    """Observable quantities at one instant; SI units, loads per unit span.

    ``x, y`` are the membrane nodes in the wing frame (x from the leading edge along the chord,
    y towards the suction side), ``pressure_jump`` the pressure below minus above at these nodes;
    all three have the same shape ``(nodes,)`` and are empty for plants without a membrane.
    """

    time: float
    v_squared: float                    # V^2 held during the step that led here
    cl: float                           # lift coefficient
    cd: float                           # drag coefficient
    cm: float                           # pitching moment about c/4, nose up
    camber_mean: float                  # m, chord average of y
    camber_max: float                   # m
    camber_max_position: float          # x/c of the largest camber
    tension: float                      # N/m, chord average
    electric_field: float = 0.0         # V/m, the largest V / h along the chord
    coupling_iterations: int = 0
    x: np.ndarray = field(default_factory=lambda: np.empty(0))
    y: np.ndarray = field(default_factory=lambda: np.empty(0))
    pressure_jump: np.ndarray = field(default_factory=lambda: np.empty(0))

    @property
    def voltage(self) -> float:
        """V = sqrt(V^2) in volt."""
        return float(np.sqrt(self.v_squared))


SCALARS = ('time', 'v_squared', 'cl', 'cd', 'cm', 'camber_mean', 'camber_max',
           'camber_max_position', 'tension', 'coupling_iterations')


class Measurement(NamedTuple):
    """What a controller sees of a plant at one instant (SI); ``v_squared`` led here.

    ``time`` is a whole number of nanoseconds, as in the stamp of a message.
    """

    time: float
    camber_mean: float
    camber_max: float
    cl: float
    cd: float
    v_squared: float

    @classmethod
    def of(cls, outputs: Outputs) -> 'Measurement':
        """Return the measured part of ``outputs``."""
        return cls(round(outputs.time * 1.0e9) * 1.0e-9,
                   *(getattr(outputs, name) for name in cls._fields[1:]))


class Plant(Protocol):
    """A discrete-time system driven by V^2, held over ``dt`` (zero-order hold, D = 0).

    ``state`` is immutable: a step returns a new one, so runs branch from any state for free.
    """

    dt: float                           # s

    def rest(self) -> Any:
        """Return the trimmed state at time 0."""

    def step(self, state: Any, v_squared: float) -> Any:
        """Return the state one ``dt`` later with ``v_squared`` (V^2, never negative) held."""

    def observe(self, state: Any) -> Outputs:
        """Return the outputs of ``state``."""


def rollout(plant: Plant, state: Any, command: Callable[[Outputs], float], steps: int,
            ) -> Iterator[tuple[Any, Outputs]]:
    """Yield (state, outputs) after each step; ``command`` maps the last outputs to V^2."""
    outputs = plant.observe(state)
    for _ in range(steps):
        state = plant.step(state, command(outputs))
        outputs = plant.observe(state)
        yield state, outputs

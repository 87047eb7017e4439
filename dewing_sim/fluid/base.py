# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the coupling knows of a flow engine.

All quantities are dimensionless (chord, free-stream speed and air density are one).  The wing is
seen as columns along the chord: heights at the column faces (n + 1,), velocities (n,) and pressure
jumps below minus above (n,) averaged over a column.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from dewing_sim.fluid.onset import Onset


@dataclass(frozen=True)
class Wall:
    """Membrane seen by the flow: heights at the column faces (n + 1,), column velocities (n,).

    ``edge_velocity`` is that of leading and trailing edge, zero where they are pinned.
    """

    height: np.ndarray
    velocity: np.ndarray
    edge_velocity: tuple[float, float] = (0.0, 0.0)

    @classmethod
    def flat(cls, columns: np.ndarray) -> 'Wall':
        """Return a flat wall at rest on the given column faces."""
        return cls(np.zeros(len(columns)), np.zeros(len(columns) - 1))


@dataclass(frozen=True)
class Prediction:
    """A flow step that is complete but for the wall velocity, on which the load depends linearly.

    ``jump`` (n,) is the pressure jump if the wall moves with ``wall.velocity``; moving it with
    another velocity w changes it by -resistance (w - wall.velocity), see `Fluid.resistance`.
    ``fields`` is the engine's own.
    """

    wall: Wall
    jump: np.ndarray
    fields: Any


@dataclass(frozen=True)
class Loads:
    """Pressure jump (n,) and coefficients of lift, drag and moment about c/4 (nose up)."""

    jump: np.ndarray
    cl: float
    cd: float
    cm: float


class Fluid(Protocol):
    """An incompressible Navier-Stokes solver about a moving wing."""

    columns: np.ndarray             # column faces from 0 to 1 (n + 1,)
    resistance: np.ndarray          # (n, n): added-mass matrix over theta = 2 dt / 3

    def rest(self, wall: Wall, circulation: float) -> Any:
        """Return a starting field with the given bound circulation (U c)."""

    def with_circulation(self, state: Any, circulation: float) -> Any:
        """Return ``state`` with the far-field values of another total circulation (U c)."""

    def predict(self, state: Any, wall: Wall, onset: Onset | None = None) -> Prediction:
        """Advance one step with the wall at its new place, short of its final velocity.

        ``onset`` is the stream at the new time, by default the undisturbed one; an engine that
        knows no other raises `BadInput`.
        """

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> Any:
        """Complete the step with the wall velocity (n,) that the coupling found."""

    def loads(self, state: Any) -> Loads:
        """Return the loads of a state."""

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

from dewing_sim.fluid.inflow import Inflow

EDGE = 0.01                 # chords around an edge where CFL numbers count apart
HIGH_SLIP = 0.75            # U: half of what stops a run of the conformal engine


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
    another velocity w changes it by -impedance (w - wall.velocity), see `Fluid.impedance`.
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


@dataclass(frozen=True)
class Monitor:
    """How near a flow is to the largest time step it bears.

    CFL numbers tell how many cells the air crosses in a step: ``courant`` is the largest further
    than `EDGE` from both edges, ``edge_courant`` the largest within.  At an edge the cells of the
    conformal engine shrink with h while the air stays fast, so that ``edge_courant`` is large by
    nature: some tens are sound there, as the sweeps are implicit.  ``slip`` is the largest that
    the membrane shed in the last step, in free-stream speeds; it grows before a flow becomes
    unstable.
    """

    courant: float
    edge_courant: float
    slip: float

    @classmethod
    def of(cls, courant: np.ndarray, distance: np.ndarray, slip: float) -> 'Monitor':
        """Return the monitor of cells with these CFL numbers and distances to an edge (c)."""
        near = distance < EDGE
        return cls(float(courant[~near].max(initial=0.0)), float(courant[near].max(initial=0.0)),
                   slip)


class Fluid(Protocol):
    """An incompressible Navier-Stokes solver about a moving wing."""

    columns: np.ndarray             # column faces from 0 to 1 (n + 1,)
    impedance: np.ndarray           # (n, n): of the interface, added mass over theta = 2 dt / 3

    def rest(self, wall: Wall, circulation: float) -> Any:
        """Return a starting field with the given bound circulation (U c)."""

    def with_circulation(self, state: Any, circulation: float) -> Any:
        """Return ``state`` with the far-field values of another total circulation (U c)."""

    def predict(self, state: Any, wall: Wall, inflow: Inflow | None = None) -> Prediction:
        """Advance one step with the wall at its new place, short of its final velocity.

        ``inflow`` is the stream at the new time, by default the undisturbed one; an engine that
        knows no other raises `BadInput`.
        """

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> Any:
        """Complete the step with the wall velocity (n,) that the coupling found."""

    def loads(self, state: Any) -> Loads:
        """Return the loads of a state."""

    def slip(self, state: Any) -> float:
        """Return the largest slip shed in the last step, in free-stream speeds; at once."""

    def monitor(self, state: Any) -> Monitor:
        """Return CFL numbers and slip of a state, in the stream without gust, heave and pitch."""

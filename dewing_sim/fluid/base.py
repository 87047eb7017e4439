# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the rest of dewing knows of a flow engine.

All quantities are dimensionless (chord, free-stream speed and air density are one).  The wing is
seen as columns along the chord: heights at the column faces (n + 1,), velocities (n,) and pressure
jumps below minus above (n,) averaged over a column.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from dewing_sim.fluid.field import FlowField
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.fluid.preset import GridPreset

EDGE = 0.01                 # chords around an edge where CFL numbers count apart
INFLOWS = frozenset({'gust', 'motion'})     # beside the steady stream, which every engine takes


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
    than `EDGE` from both edges, ``edge_courant`` the largest within, where it may be large by
    nature, see the engine.  ``slip`` is the largest that the membrane shed in the last step, in
    free-stream speeds, zero on an engine that sheds nothing.
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


@dataclass(frozen=True)
class Demand:
    """What is asked of an engine: largest expected camber (chords), ``alpha`` (rad), dt (c/U).

    ``inflows`` are those of `INFLOWS` that the wing will meet.
    """

    grid: str
    camber: float
    reynolds: float
    alpha: float
    dt: float
    inflows: frozenset[str] = frozenset()


class Fluid(Protocol):
    """An incompressible flow solver about a moving wing: a class on which every fact stands.

    An engine need not derive from it. One that does inherits what it leaves out among the methods
    that are written out here: it takes a steady stream only, is verified everywhere, does not
    slip, and has no picture.
    """

    name: ClassVar[str]
    grids: ClassVar[Mapping[str, GridPreset]]   # by name, coarsest first or as they come
    state: ClassVar[type]               # a dataclass of arrays and numbers, which a file keeps
    inflows: ClassVar[frozenset[str]] = frozenset()     # of `INFLOWS`, beside a steady stream
    free_edges: ClassVar[bool] = False  # whether the wall may leave y = 0 at its edges

    alpha: float                        # angle of attack of the undisturbed stream, rad
    dt: float                           # c/U
    columns: np.ndarray                 # column faces from 0 to 1 (n + 1,)
    impedance: np.ndarray               # (n, n): of the interface, added mass over 2 dt / 3
    cells: int                          # in which the flow is solved

    @classmethod
    @abstractmethod
    def preset(cls, grid: str, reynolds: float, alpha: float, dt: float) -> 'Fluid':
        """Return the engine on one of `grids`, for an angle of attack (rad) and dt (c/U)."""

    @classmethod
    def obstacle(cls, demand: Demand) -> str | None:
        """Return why the engine has not been verified for ``demand``, None if it has."""
        return None

    @abstractmethod
    def rest(self, wall: Wall, circulation: float) -> Any:
        """Return a starting field, a `state`, with the given bound circulation (U c)."""

    @abstractmethod
    def with_circulation(self, state: Any, circulation: float) -> Any:
        """Return ``state`` with the far-field values of another total circulation (U c).

        A state has it as ``circulation``.
        """

    @abstractmethod
    def predict(self, state: Any, wall: Wall, inflow: Inflow | None = None) -> Prediction:
        """Advance one step with the wall at its new place, short of its final velocity.

        ``inflow`` is the stream at the new time, by default the undisturbed one; an engine that
        knows no other raises `BadInput`.
        """

    @abstractmethod
    def correct(self, prediction: Prediction, velocity: np.ndarray) -> Any:
        """Complete the step with the wall velocity (n,) that the coupling found."""

    @abstractmethod
    def loads(self, state: Any) -> Loads:
        """Return the loads of a state."""

    @abstractmethod
    def monitor(self, state: Any) -> Monitor:
        """Return CFL numbers and slip of a state, in the stream without gust, heave and pitch."""

    def slip(self, state: Any) -> float:
        """Return the largest slip shed in the last step, in free-stream speeds; at once."""
        return 0.0

    def caution(self, state: Any) -> str:
        """Return a warning of a state that nears what stops a run, an empty one otherwise."""
        return ''

    def field(self, state: Any) -> FlowField | None:
        """Return vorticity and stream function, None if the engine has no picture of them."""
        return None

    def suction(self, state: Any) -> tuple[np.ndarray, np.ndarray] | None:
        """Return x and a measure of the flow next to the upper side, reversed where negative.

        None if the engine does not resolve it.
        """
        return None

    def parts(self, state: Any, wall: Wall) -> dict[str, Callable[[], Any]]:
        """Return parts of a step that can run alone, by name, for those who time them."""
        return {}

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a structure is to statics, to the time steps and to the wing, and the tension it must keep.

Nodal arrays are (nodes, 2), forces are per unit span, V^2 is in volt squared. Structures are
`membrane.Membrane` and `solid.solid.Solid`.
"""

import math
from typing import Protocol

import numpy as np

from dewing_sim.errors import Slack
from dewing_sim.structure.dynamics.motion import Motion


class Structure(Protocol):
    """A strip between two edges, which statics and energy balances take as it is."""

    rest_position: np.ndarray           # without load and voltage
    mass: np.ndarray                    # (nodes,), lumped

    @property
    def chord(self) -> float:
        """Distance between the edges, to which corrections are compared."""

    @property
    def free(self) -> slice | np.ndarray:
        """Entries of a raveled nodal array that may move: m degrees of freedom."""

    def internal_force(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return the nodal gradient of the potential energy."""

    def tangent(self, position: np.ndarray, v_squared: float, pressure: float | np.ndarray = 0.0,
                before: np.ndarray | None = None) -> np.ndarray:
        """Return d(internal - pressure force)/d(position), a band (2 w + 1, m).

        ``before`` is the position of the last iteration, if any.
        """

    def pressure_force(self, position: np.ndarray, pressure: float | np.ndarray) -> np.ndarray:
        """Return the nodal forces of a pressure jump that stays normal to the structure."""

    def energies(self, position: np.ndarray, v_squared: float) -> tuple[float, float]:
        """Return the elastic and the electrostatic energy."""

    def require_taut(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` if the structure cannot carry its state."""

    def require_bearable(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` if V^2 takes all tension at the stretch of ``position``."""


class Moving(Structure, Protocol):
    """A structure that a time step moves in a flow."""

    def surface(self, nodal: np.ndarray) -> np.ndarray:
        """Return what the flow sees of nodal positions or velocities, (n + 1, 2), linear."""

    def spread(self, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces of forces (n + 1, 2) on the surface, its transpose."""

    @property
    def linear_range(self) -> float:
        """Length of corrections beyond which a tangent made before them is of no use."""

    def during(self, motion: Motion, dt: float, v_squared: float) -> 'Moving':
        """Return the structure with what it remembers in the step that follows ``motion``."""

    def after(self, motion: Motion, position: np.ndarray, v_squared: float, dt: float,
              ) -> np.ndarray:
        """Return the memory after a step from ``motion`` to ``position``."""


class Taut:
    """Checks shared by structures with a ``sheet``, ``stretch``, ``tension`` and ``elements``."""

    def require_taut(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` with element, tension and voltages if any tension is not positive."""
        tension = self.tension(position, v_squared)
        k = int(np.argmin(tension))
        if tension[k] > 0.0:
            return
        self._raise_slack(k, tension[k], position, v_squared)

    def require_bearable(self, position: np.ndarray, v_squared: float) -> None:
        """Raise `Slack` if V^2 takes all tension at the typical stretch of ``position``."""
        stretch = float(np.median(self.stretch(position)))
        tension = float(self.sheet.respond([stretch], v_squared).tension[0])
        if tension <= 0.0:
            self._raise_slack(self.elements // 2, tension, position, v_squared)

    def _raise_slack(self, k: int, tension: float, position: np.ndarray, v_squared: float):
        limit = self.sheet.loss_of_tension_v_squared(self.stretch(position)[k])
        raise Slack(f'slack membrane: element {k} has tension {tension:.6g} at '
                    f'{math.sqrt(v_squared):.6g} V and loses it at {math.sqrt(limit):.6g} V; '
                    'lower the voltage or raise the prestretch')

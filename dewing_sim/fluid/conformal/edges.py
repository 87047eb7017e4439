# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What depends on where the edges lie on the strip, tabulated against their places.

Camber moves the edges along xi, by 2 y/c for an arc.  What they need is made when they first come
near a place and kept, so that a wing that bends to and fro does not pay again.
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.mapping import Map
from dewing_sim.fluid.conformal.noslip import Influence
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.conformal.transport import extrapolation_share

SPACING = 0.1               # steps in xi between the places


@dataclass(frozen=True)
class Edges:
    """For one place of both edges: no slip and the share of second-order extrapolation."""

    influence: Influence
    share: np.ndarray               # (n, rows)


class EdgeTable:
    """All places visited so far."""

    def __init__(self, grid: Grid, poisson: Poisson, nu: float, dt: float):
        """Prepare the table for one viscosity and dt (c/U)."""
        self._grid, self._poisson, self._nu, self._dt = grid, poisson, nu, dt
        self._table: dict[tuple[int, int], Edges] = {}

    def near(self, m: Map) -> Edges:
        """Return the entry nearest to the edges of ``m``."""
        spacing = SPACING * self._grid.step
        _, trailing, leading = m.edges.tolist()
        place = (round(trailing / spacing), round((leading - np.pi) / spacing))
        if place not in self._table:
            self._table[place] = self._make(place[0] * spacing, np.pi + place[1] * spacing)
        return self._table[place]

    def _make(self, trailing: float, leading: float) -> Edges:
        return Edges(Influence.of(self._grid, self._poisson, trailing, leading, self._nu,
                                  self._dt),
                     extrapolation_share(self._grid, trailing, leading, self._dt))

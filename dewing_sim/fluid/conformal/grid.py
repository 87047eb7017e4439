# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The computational half-strip zeta = eta + i xi around the wing.

xi is periodic and uniform: 0 at the trailing edge, pi at the leading edge, the upper side between.
Nodes lie halfway, xi_i = (i + 1/2) dxi, so that none falls on an edge.  eta grows geometrically
from the membrane, eta_j = eta(j); cell faces are at eta(j + 1/2), and the first node lies on the
membrane, in a half cell.  Arrays over the strip have the shape (n, rows): lines
of constant xi one after another, each from the membrane outwards.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.presets import Preset
from dewing_sim.roots import bracketed


class Strip(NamedTuple):
    """The grid as compiled code knows it."""

    step: float                     # in xi
    width: np.ndarray               # (rows,) of the cells, in eta
    per_width: np.ndarray           # (rows,) its inverse
    per_gap: np.ndarray             # (rows,) inverse of the distance to the next row
    sinh_face: np.ndarray           # (rows,)
    lines: np.ndarray               # (n,) 0, 1, ...: see `kernels`


@dataclass(frozen=True)
class Grid:
    """Coordinates of nodes and faces, in the units of zeta."""

    xi: np.ndarray                  # (n,)
    eta: np.ndarray                 # (rows,), starting with 0
    face: np.ndarray                # (rows,), face[j] between rows j and j + 1, then the boundary

    @classmethod
    def build(cls, preset: Preset) -> 'Grid':
        """Return the grid of a preset."""
        step = 2.0 * np.pi / preset.around
        last = preset.rows - 0.5
        ratio = bracketed(lambda r: _geometric(preset.first, r, last) - preset.outermost,
                          1.0 + 1.0e-6, 1.5)
        rows = np.arange(preset.rows)
        return cls((np.arange(preset.around) + 0.5) * step,
                   _geometric(preset.first, ratio, rows),
                   _geometric(preset.first, ratio, rows + 0.5))

    @property
    def columns(self) -> np.ndarray:
        """Faces in x of the columns on the wing: a column has one node on each side."""
        number = len(self.xi) // 2
        return 0.5 * (1.0 - np.cos(np.arange(number + 1) * self.step))

    @property
    def cells(self) -> int:
        """Number of nodes, each in a cell."""
        return len(self.xi) * len(self.eta)

    @property
    def step(self) -> float:
        """Distance of two nodes in xi."""
        return 2.0 * np.pi / len(self.xi)

    @property
    def wavenumbers(self) -> np.ndarray:
        """Wave numbers (n / 2 + 1,) of the real Fourier transform along xi."""
        return np.arange(len(self.xi) // 2 + 1.0)

    @cached_property
    def width(self) -> np.ndarray:
        """Extent in eta of each row's cells (rows,)."""
        return np.diff(self.face, prepend=0.0)

    @cached_property
    def gap(self) -> np.ndarray:
        """Distance from each row to the next (rows,), the last one to the boundary."""
        return np.diff(self.eta, append=self.face[-1])

    @property
    def strip(self) -> Strip:
        """The grid for compiled code."""
        return Strip(self.step, self.width, 1.0 / self.width, 1.0 / self.gap, np.sinh(self.face),
                     np.arange(len(self.xi)))


def _geometric(first: float, ratio: float, index) -> np.ndarray:
    return first * (ratio**index - 1.0) / (ratio - 1.0)

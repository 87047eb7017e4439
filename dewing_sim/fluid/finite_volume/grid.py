# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The computational grid: a stretched tensor product whose lines meet both edges of the plate.

Chord-wise coordinate xi, normal coordinate eta, both in chords; the plate is 0 <= xi <= 1 at
eta = 0.  Staggered unknowns: pressure at cell centres, u on faces of constant xi, v on faces of
constant eta.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.finite_volume.presets import Spacing


class Lattice(NamedTuple):
    """The grid as compiled code knows it."""

    dx: np.ndarray                  # (nx,) cell widths
    dy: np.ndarray                  # (ny,) cell heights
    dxf: np.ndarray                 # (nx + 1,) distances of centres across the xi-faces
    dyf: np.ndarray                 # (ny + 1,) and across the eta-faces
    below: np.ndarray               # (ny + 1,) share of that distance in the cell below
    leading: int                    # columns leading <= i < trailing touch the plate
    trailing: int


@dataclass(frozen=True)
class Grid:
    """Face coordinates and the 1-D quantities derived from them.

    ``x`` (nx + 1,) and ``y`` (ny + 1,) are the faces; the plate occupies columns
    ``leading <= i < trailing`` and lies on the eta-face ``middle`` (y = 0).
    """

    x: np.ndarray
    y: np.ndarray
    leading: int
    trailing: int

    @property
    def middle(self) -> int:
        """Index of the eta-face y = 0; rows middle - 1 and middle touch the plate."""
        return (len(self.y) - 1) // 2

    @property
    def cells(self) -> int:
        """Number of pressure cells."""
        return (len(self.x) - 1) * (len(self.y) - 1)

    @property
    def plate(self) -> slice:
        """The columns of cells that touch the plate."""
        return slice(self.leading, self.trailing)

    @property
    def columns(self) -> np.ndarray:
        """Faces of the columns on the plate, from 0 to 1."""
        return self.x[self.leading:self.trailing + 1]

    @cached_property
    def dx(self) -> np.ndarray:
        """Cell widths (nx,)."""
        return np.diff(self.x)

    @cached_property
    def dy(self) -> np.ndarray:
        """Cell heights (ny,)."""
        return np.diff(self.y)

    @cached_property
    def xc(self) -> np.ndarray:
        """Cell centres (nx,)."""
        return 0.5 * (self.x[1:] + self.x[:-1])

    @cached_property
    def yc(self) -> np.ndarray:
        """Cell centres (ny,)."""
        return 0.5 * (self.y[1:] + self.y[:-1])

    @cached_property
    def dxf(self) -> np.ndarray:
        """Distance of the cell centres on both sides of each xi-face (nx + 1,)."""
        return _centre_distances(self.dx)

    @cached_property
    def dyf(self) -> np.ndarray:
        """Distance of the cell centres on both sides of each eta-face (ny + 1,)."""
        return _centre_distances(self.dy)

    @cached_property
    def lattice(self) -> Lattice:
        """The grid for compiled code."""
        below = 0.5 * np.concatenate(([0.0], self.dy)) / self.dyf
        return Lattice(self.dx, self.dy, self.dxf, self.dyf, below, self.leading, self.trailing)

    @cached_property
    def following_f(self) -> np.ndarray:
        """How far the xi-faces (nx + 1,) follow the nearest edge of the membrane: 1 on it."""
        return self._following(self.x)

    @cached_property
    def following_c(self) -> np.ndarray:
        """How far the column centres (nx,) follow the nearest edge of the membrane."""
        return self._following(self.xc)

    def _following(self, x: np.ndarray) -> np.ndarray:
        outside = np.maximum(self.x[self.leading] - x, x - self.x[self.trailing])
        return np.exp(-np.maximum(0.0, outside)**2)


def _centre_distances(cells: np.ndarray) -> np.ndarray:
    """Return centre-to-centre distances; half a cell at both ends."""
    padded = np.concatenate(([0.0], cells, [0.0]))
    return 0.5 * (padded[1:] + padded[:-1])


def build(spacing: Spacing) -> Grid:
    """Return the grid of ``spacing``: faces on both plate edges, symmetric about the plate."""
    s = spacing
    upstream = -graded(0.0, s.extent, lambda r: s.leading_edge + s.growth_upstream * r)[::-1]
    plate = graded(0.0, 1.0, lambda r: np.minimum(s.chordwise, np.minimum(
        s.leading_edge + s.growth_plate * r, s.trailing_edge + s.growth_plate * (1.0 - r))))
    wake = 1.0 + graded(0.0, s.extent, lambda r: s.trailing_edge + s.growth_wake * r)
    above = graded(0.0, s.extent, lambda r: (
        s.wall + s.growth_near * np.minimum(r, s.near)
        + s.growth_far * np.maximum(r - s.near, 0.0)))
    x = np.concatenate((upstream[:-1], plate, wake[1:]))
    y = np.concatenate((-above[:0:-1], above))
    leading = len(upstream) - 1
    return Grid(x, y, leading, leading + len(plate) - 1)


def graded(start: float, end: float, size, samples: int = 20_001) -> np.ndarray:
    """Return faces from ``start`` to ``end`` whose cell size follows ``size(distance)``.

    The faces are equidistant in the integral of 1/size, rounded to whole cells.
    """
    fraction = np.linspace(0.0, 1.0, samples)**3        # samples crowd where cells are small
    if size(np.array(end - start)) <= 1.5 * size(np.array(0.0)):
        fraction = np.linspace(0.0, 1.0, samples)
    r = (end - start) * fraction
    density = 1.0 / size(r)
    number = np.concatenate(
        ([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(r))))
    cells = max(2, round(number[-1]))
    faces = start + np.interp(np.linspace(0.0, number[-1], cells + 1), number, r)
    faces[0], faces[-1] = start, end
    return faces

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The vorticity that the membrane must shed so that the flow does not slip along it.

A wall vorticity g spreads within a step as the solution of

    (3 h^2 / (2 dt) - nu Laplace) w = 0,   w = g at the membrane.

On a flat plate h^2 is a sum of functions of xi and eta, so one eigenproblem in xi and a
tridiagonal system in eta for each of its modes give the response; the slip it removes is a dense
matrix, inverted once.  For a cambered membrane h^2 is that of the circular arc with the same
edges, to which the response is fitted by a sum.  On another shape the w of the arc is shed, which
leaves a little slip, and then the h^2 w of the arc for that: slip depends on h^2 w only, so that
it is gone.  The latter alone would do, but near the edges its w jumps where the table of arcs
changes place, and the lift with it.

Camber moves the edges along xi, by 2 y/c for an arc.  What they need is made when they first come
near a place and kept, so that a wing that bends to and fro does not pay again.
"""

from typing import NamedTuple

import numpy as np
from numpy import fft
from scipy.linalg import eigh

from dewing_sim.fluid.conformal.geometry.mapping import Map
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.conformal.transport import extrapolation_share
from dewing_sim.machine.kernels import stage
from dewing_sim.machine.resident import Resident, hold

BLOCK = 4                   # modes added at once; divides the number of nodes
NEGLIGIBLE_SLIP = 1.0e-6
LARGEST_SLIP = 1.5      # shed in one step: 0.8 at an impulsive start, 0.15 later in a sound run
HIGH_SLIP = 0.5 * LARGEST_SLIP
SPACING = 0.1               # steps in xi between the places of edges that are tabulated
NEGLIGIBLE = 1.0e-8         # share of a wall vorticity beyond which its response is cut off


class Influence(NamedTuple):
    """Responses in the eigenbasis along xi."""

    modes: np.ndarray               # (n, n) modes[m] is the m-th eigenvector
    decay: np.ndarray               # (reach, n) response of each mode, 1 at the membrane
    active: np.ndarray              # (reach,) modes that reach each row
    inverse: np.ndarray             # (n, n), transposed: slip to coefficients of the modes
    h2: np.ndarray                  # (n, rows) of the arc

    @classmethod
    def of(cls, grid: Grid, poisson: Poisson, trailing: float, leading: float, nu: float,
           dt: float) -> 'Influence':
        """Return the influence of wall vorticity for edges at xi = ``trailing``, ``leading``."""
        h2 = _metric_of_arc(grid, trailing, leading)
        values, vectors = eigh(_diffusion(grid, 1.5 * h2[:, 0] / dt, nu))
        # Next to a strongly bent membrane the mean falls below 0: some mode would resonate.
        potential = np.maximum(np.mean(h2 - h2[:, :1], axis=0), 0.0)
        decay = _responses(grid, values, 1.5 / dt * potential, nu)
        decay[decay < NEGLIGIBLE] = 0.0
        active = np.count_nonzero(decay, axis=1)
        reach = 2 * ((np.count_nonzero(active) + 1) // 2)       # even, see `shed`
        matrix = np.zeros_like(vectors)
        for j in range(reach):
            vorticity = h2[:, j, None] * vectors * decay[j]
            weight = poisson.decay[j, :len(values) // 2 + 1, None]
            matrix += fft.irfft(weight * fft.rfft(vorticity, axis=0), len(values), axis=0)
        return cls(np.ascontiguousarray(vectors.T), decay[:reach], active[:reach],
                   np.ascontiguousarray(np.linalg.inv(matrix).T), h2)


def _metric_of_arc(grid: Grid, trailing: float, leading: float) -> np.ndarray:
    """Return h^2 (n, rows) of the circular arc with these edges, by Joukowski's map.

    z = Z + c^2 / Z, with the circle Z = a exp(zeta) + i a sin(b) through Z = +-c and
    c = a cos(b) = 1/4.
    """
    bend = 0.5 * (leading - np.pi - trailing)
    xi = grid.xi[:, None] - 0.5 * (leading - np.pi + trailing)
    eta = grid.eta
    pole = 1.0 + np.sin(bend) * np.exp(-eta) * (2.0 * np.sin(xi) + np.sin(bend) * np.exp(-eta))
    zeros = (np.cosh(eta) - np.cos(xi + bend)) * (np.cosh(eta) + np.cos(xi - bend))
    return 0.25 * zeros / (np.cos(bend) * pole)**2


def _diffusion(grid: Grid, potential: np.ndarray, nu: float) -> np.ndarray:
    n = len(potential)
    conductance = nu / grid.step**2
    matrix = np.diag(potential + 2.0 * conductance)
    neighbour = np.arange(n)
    matrix[neighbour, (neighbour + 1) % n] -= conductance
    matrix[neighbour, (neighbour - 1) % n] -= conductance
    return matrix


def _responses(grid: Grid, values: np.ndarray, potential: np.ndarray, nu: float) -> np.ndarray:
    """Return the decay of each mode along eta, from 1 at the membrane to 0 at the boundary."""
    rows = len(grid.eta)
    ratio = np.zeros((rows + 1, len(values)))
    for j in range(rows - 1, 0, -1):
        inner, outer = nu / (grid.gap[j - 1] * grid.width[j]), nu / (grid.gap[j] * grid.width[j])
        ratio[j] = inner / (values + potential[j] + inner + outer * (1.0 - ratio[j + 1]))
    return np.cumprod(np.concatenate((np.ones((1, len(values))), ratio[1:rows])), axis=0)


@stage
def remove(influence, slip, h2, w, h2_w, exactly):
    """Add to ``w`` and ``h2_w`` = h^2 w what removes ``slip`` (n,); return the rows reached.

    Either the w of the arc, smooth in the shape of the membrane, or ``exactly`` its h^2 w.
    """
    decay, modes = influence.decay, influence.modes
    reach, n = decay.shape
    coefficients, shed = np.zeros(n), np.zeros((reach, n))
    for k in range(n):
        for m in range(n):
            coefficients[m] -= slip[k] * influence.inverse[k, m]
    for j in range(0, reach, 2):            # two rows and four modes at once: fewer loads
        for m in range(0, influence.active[j], BLOCK):      # beyond them decay is zero
            a, b = coefficients[m] * decay[j, m], coefficients[m + 1] * decay[j, m + 1]
            c, d = coefficients[m + 2] * decay[j, m + 2], coefficients[m + 3] * decay[j, m + 3]
            e, f = coefficients[m] * decay[j + 1, m], coefficients[m + 1] * decay[j + 1, m + 1]
            g, h = (coefficients[m + 2] * decay[j + 1, m + 2],
                    coefficients[m + 3] * decay[j + 1, m + 3])
            for i in range(n):
                p, q, r, s = modes[m, i], modes[m + 1, i], modes[m + 2, i], modes[m + 3, i]
                shed[j, i] += a * p + b * q + c * r + d * s
                shed[j + 1, i] += e * p + f * q + g * r + h * s
    h2_shed = influence.h2 if exactly else h2
    for i in range(n):
        for j in range(reach):
            change = h2_shed[i, j] * shed[j, i]
            h2_w[i, j] += change
            w[i, j] += change / h2[i, j]
    return reach


class Edges(NamedTuple):
    """For one place of both edges: no slip and the share of second-order extrapolation."""

    influence: Influence
    share: np.ndarray               # (n, rows)


class EdgeTable:
    """All places visited so far."""

    def __init__(self, grid: Grid, poisson: Poisson, nu: float, dt: float):
        """Prepare the table for one viscosity and dt (c/U)."""
        self._grid, self._poisson, self._nu, self._dt = grid, poisson, nu, dt
        self._table: dict[tuple[int, int], Resident] = {}

    def near(self, m: Map) -> Resident:
        """Return the `Edges` nearest to those of ``m``."""
        spacing = SPACING * self._grid.step
        _, trailing, leading = m.edges.tolist()
        place = (round(trailing / spacing), round((leading - np.pi) / spacing))
        if place not in self._table:
            self._table[place] = self._make(place[0] * spacing, np.pi + place[1] * spacing)
        return self._table[place]

    def _make(self, trailing: float, leading: float) -> Resident:
        return hold(Edges(Influence.of(self._grid, self._poisson, trailing, leading, self._nu,
                                       self._dt),
                          extrapolation_share(self._grid, trailing, leading, self._dt)))

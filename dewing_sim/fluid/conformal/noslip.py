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
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.linalg import eigh

from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.kernels import kernel

BLOCK = 4                   # modes added at once; divides the number of nodes
NEGLIGIBLE = 1.0e-8         # share of a wall vorticity beyond which its response is cut off


@dataclass(frozen=True)
class Influence:
    """Responses in the eigenbasis along xi."""

    modes: np.ndarray               # (n, n) modes[m] is the m-th eigenvector
    decay: np.ndarray               # (rows, n) response of each mode, 1 at the membrane
    active: np.ndarray              # (rows,) modes that reach each row
    inverse: np.ndarray             # (n, n), transposed: slip to coefficients of the modes
    h2: np.ndarray                  # (rows, n) of the arc

    @classmethod
    def of(cls, poisson: Poisson, trailing: float, leading: float, nu: float, dt: float,
           ) -> 'Influence':
        """Return the influence of wall vorticity for edges at xi = ``trailing``, ``leading``."""
        grid = poisson.grid
        h2 = _metric_of_arc(grid, trailing, leading)
        values, vectors = eigh(_diffusion(grid, 1.5 * h2[0] / dt, nu))
        # Next to a strongly bent membrane the mean falls below 0: some mode would resonate.
        potential = np.maximum(np.mean(h2 - h2[0], axis=1), 0.0)
        decay = _responses(grid, values, 1.5 / dt * potential, nu)
        decay[decay < NEGLIGIBLE] = 0.0
        active = np.count_nonzero(decay, axis=1)
        reach = np.count_nonzero(active)
        decay, active = decay[:reach], active[:reach]
        matrix = np.zeros_like(vectors)
        for j in range(reach):
            vorticity = h2[j][:, None] * vectors * decay[j]
            weight = grid.width[j] * poisson.decay[j]
            matrix += fft.irfft(weight[:, None] * fft.rfft(vorticity, axis=0), len(values), axis=0)
        return cls(np.ascontiguousarray(vectors.T), decay, active,
                   np.ascontiguousarray(np.linalg.inv(matrix).T), h2[:reach])

    def remove(self, slip: np.ndarray, h2: np.ndarray, w: np.ndarray, q: np.ndarray,
               exactly: bool) -> int:
        """Add to ``w`` and ``q`` = h^2 w what removes ``slip`` (n,); return the rows reached.

        Either the w of the arc, smooth in the shape of the membrane, or ``exactly`` its h^2 w.
        """
        coefficients = _multiply(self.inverse, slip)
        _add_response(self.modes, self.decay, self.active, coefficients,
                      self.h2 if exactly else h2, h2, w, q)
        return len(self.decay)


def _metric_of_arc(grid: Grid, trailing: float, leading: float) -> np.ndarray:
    """Return h^2 (rows, n) of the circular arc with these edges, by Joukowski's map.

    z = Z + c^2 / Z, with the circle Z = a exp(zeta) + i a sin(b) through Z = +-c and
    c = a cos(b) = 1/4.
    """
    bend = 0.5 * (leading - np.pi - trailing)
    xi = grid.xi - 0.5 * (leading - np.pi + trailing)
    eta = grid.eta[:, None]
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


@kernel
def _multiply(transposed, vector):
    result = np.zeros(vector.size)
    for k in range(vector.size):
        for i in range(vector.size):
            result[i] -= vector[k] * transposed[k, i]
    return result


@kernel
def _add_response(modes, decay, active, coefficients, h2_arc, h2, w, q):
    """Add the modes with a decay along eta; ascending eigenvalues reach less and less far."""
    rows, n = decay.shape
    shed = np.empty(n)
    for j in range(rows):
        for i in range(n):
            shed[i] = 0.0
        for m in range(0, active[j], BLOCK):        # beyond the active modes decay is zero
            a, b = coefficients[m] * decay[j, m], coefficients[m + 1] * decay[j, m + 1]
            c, d = coefficients[m + 2] * decay[j, m + 2], coefficients[m + 3] * decay[j, m + 3]
            for i in range(n):
                shed[i] += (a * modes[m, i] + b * modes[m + 1, i]
                            + c * modes[m + 2, i] + d * modes[m + 3, i])
        for i in range(n):
            change = h2_arc[j, i] * shed[i]
            q[j, i] += change
            w[j, i] += change / h2[j, i]

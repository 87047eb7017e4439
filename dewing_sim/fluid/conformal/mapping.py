# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal map from the half-strip to the plane outside the membrane y = Y(x).

    z = 2 a cosh(zeta) + sum_k>=0 b_k exp(-k zeta),

a flat plate being a = 1/4, b_0 = 1/2.  On the membrane y is a periodic function of xi and x - 2 a
cos(xi) - x_0 its conjugate function, so that y(xi) = Y(x(xi)) is a fixed-point equation, which
contracts for every membrane less than some 25 % cambered; a and x_0 keep the edges at x = 1 and 0.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.errors import NotConverged
from dewing_sim.fluid.conformal.exterior import Exterior, wall_series
from dewing_sim.fluid.conformal.spectral import line_modes
from dewing_sim.fluid.conformal.stockham import Buffers
from dewing_sim.fluid.kernels import kernel

TOLERANCE = 1.0e-8          # chords, of the last change; the next would be a hundredth of it
PASSES = 300


class Map(NamedTuple):
    """One shape; complex ``shape`` (modes,) holds b_k, ``edges`` a, trailing and leading xi."""

    shape: np.ndarray
    edges: np.ndarray

    @property
    def scale(self) -> float:
        """The radius a."""
        return float(self.edges[0])


class Mapping:
    """Solves for maps on one grid and evaluates them on the membrane."""

    def __init__(self, exterior: Exterior):
        """Prepare for the grid of ``exterior``."""
        self._exterior = exterior
        self._buffers = Buffers.of(len(exterior.xi))

    def flat(self) -> Map:
        """Return the map of a flat plate."""
        shape = np.zeros(len(self._exterior.start), dtype=complex)
        shape[0] = 0.5
        return Map(shape, np.array([0.25, 0.0, np.pi]))

    def follow(self, height: np.ndarray, near: Map) -> Map:
        """Return the map of a membrane with heights at the column faces, starting from ``near``.

        Raises `NotConverged` for a shape that this map cannot describe.
        """
        m = Map(near.shape.copy(), near.edges.copy())
        require_settled(iterate(height, m.shape, m.edges, self._exterior, self._buffers))
        return m

    def wall(self, m: Map) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return z, z_zeta, theta and theta - xi (n,) on the membrane.

        The angle theta of a node, x = (1 + cos theta) / 2, is below pi on the upper side.
        """
        return wall(m.shape, m.edges, self._exterior, self._buffers)


def require_settled(change: float) -> None:
    """Raise `NotConverged` if the last change of the map is too large (or no number)."""
    if not change <= TOLERANCE:
        raise NotConverged(f'conformal map: the shape still changes by {change:.3g} chords '
                           f'after {PASSES} passes; the membrane is too strongly cambered '
                           'for this engine')


@kernel
def wall(shape, edges, exterior, b):
    """Return z, z_zeta, theta and theta - xi (n,) on the membrane."""
    n = exterior.xi.size
    place, slope = np.empty(n, dtype=np.complex128), np.empty(n, dtype=np.complex128)
    theta = np.empty(n)
    x, y = wall_series(shape, exterior, b)
    for i in range(n):
        place[i] = complex(x[i] + 2.0 * edges[0] * exterior.cos[i], y[i])
        angle = np.arccos(min(1.0, max(-1.0, 2.0 * place[i].real - 1.0)))
        upper = edges[1] < exterior.xi[i] < edges[2]
        theta[i] = angle if upper else 2.0 * np.pi - angle
    x, y = wall_series(shape * np.arange(shape.size), exterior, b)
    for i in range(n):
        slope[i] = complex(-x[i], 2.0 * edges[0] * exterior.sin[i] - y[i])
    return place, slope, theta, theta - exterior.xi


@kernel
def _edge(shape, scale, xi):
    """Return the conjugate function, x_xi and x_xixi at one xi, by recurrence."""
    x, first, second = 0.0, -2.0 * scale * np.sin(xi), -2.0 * scale * np.cos(xi)
    turn = complex(np.cos(xi), np.sin(xi))
    e = turn
    for k in range(1, shape.size):
        p, q = shape[k].real, shape[k].imag
        even, odd = p * e.real + q * e.imag, q * e.real - p * e.imag
        x += even
        first += k * odd
        second -= k * k * even
        e *= turn
    return x, first, second


@kernel
def _pin(shape, edges):
    """Move the edges to where x is extreme, then stretch and shift so that they are 1 and 0."""
    ends = np.empty(2)
    for side in range(2):
        for _ in range(2):
            value, first, second = _edge(shape, edges[0], edges[1 + side])
            edges[1 + side] -= first / second
        ends[side] = _edge(shape, edges[0], edges[1 + side])[0]
    span = np.cos(edges[1]) - np.cos(edges[2])
    edges[0] = 0.5 * (1.0 - ends[0] + ends[1]) / span
    return -2.0 * edges[0] * np.cos(edges[2]) - ends[1]


@kernel
def iterate(height, shape, edges, exterior, b):
    """Repeat y <- Y(x), x <- conjugate of y until y settles; return its last change."""
    n = exterior.xi.size
    y, change = wall_series(shape, exterior, b)[1].copy(), np.inf
    for _ in range(PASSES):
        x, _ = wall_series(shape, exterior, b)
        change = 0.0
        for i in range(n):
            place = x[i] + 2.0 * edges[0] * exterior.cos[i]
            new = interpolate_even(height, np.arccos(min(1.0, max(-1.0, 1.0 - 2.0 * place))))
            change = max(change, abs(new - y[i]))
            y[i] = new
        x0, scale = shape[0].real, edges[0]
        _conjugate(y, exterior, b, shape)
        shape[0] = complex(x0, 0.5 * shape[0].imag)
        x0 = _pin(shape, edges)
        change = max(change, abs(x0 - shape[0].real), abs(edges[0] - scale))
        shape[0] = complex(x0, shape[0].imag)
        if not change > TOLERANCE:
            break
    return change if np.isfinite(edges.sum()) else np.nan


@kernel
def _conjugate(y, exterior, b, shape):
    """Write 2 i / n sum_j y_j exp(i k xi_j): the series with the imaginary part ``y`` (n,)."""
    modes = line_modes(y, b, exterior.plan)
    for k in range(shape.size):
        mode = exterior.start[k] * modes[k]
        shape[k] = complex(mode.imag, mode.real) * (2.0 / y.size)


@kernel
def interpolate_even(values, angle):
    """Interpolate cubically an even function given at equidistant angles from 0 to pi."""
    last = values.size - 1
    position = angle * last / np.pi
    first = min(int(position), last - 1)
    s = position - first
    below = values[abs(first - 1)]
    above = values[first + 2] if first + 2 <= last else values[2 * last - first - 2]
    return (-s * (s - 1.0) * (s - 2.0) / 6.0 * below
            + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * values[first]
            - (s + 1.0) * s * (s - 2.0) / 2.0 * values[first + 1]
            + (s + 1.0) * s * (s - 1.0) / 6.0 * above)

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
from dewing_sim.fluid.conformal.fourier.modes import line_modes
from dewing_sim.fluid.conformal.fourier.stockham import Buffers
from dewing_sim.fluid.conformal.geometry.exterior import Exterior, wall_series
from dewing_sim.machine.kernels import kernel, stage
from dewing_sim.machine.resident import hold

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

    def places(self, eta: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Return z, complex (n, rows), at all ``eta`` (rows,) and ``xi`` (n,)."""
        k = np.arange(len(self.shape))
        around = np.exp(-1j * np.outer(xi, k))
        series = around @ (self.shape[:, None] * np.exp(-np.outer(k, eta)))
        return 2.0 * self.scale * np.cosh(eta + 1j * xi[:, None]) + series


class Mapping:
    """Solves for maps on one grid and evaluates them on the membrane."""

    def __init__(self, exterior: Exterior):
        """Prepare for the grid of ``exterior``."""
        self._exterior = exterior
        self._tables = hold((exterior, Buffers.of(len(exterior.xi))))

    def flat(self) -> Map:
        """Return the map of a flat plate."""
        shape = np.zeros(len(self._exterior.start), dtype=complex)
        shape[0] = 0.5
        return Map(shape, np.array([0.25, 0.0, np.pi]))

    def follow(self, height: np.ndarray, near: Map) -> Map:
        """Return the map of a membrane with heights at the column faces, starting from ``near``.

        Raises `NotConverged` for a shape that this map cannot describe.
        """
        return self.move(height, np.full_like(height, np.nan), near, near, 1.0)[0]

    def wall(self, m: Map) -> 'Line':
        """Return the line of the membrane."""
        same = np.zeros(1)
        return self.move(same, same, m, m, 1.0)[3]

    def move(self, height: np.ndarray, height_now: np.ndarray, now: Map, before: Map, dt: float,
             ) -> tuple[Map, np.ndarray, float, 'Line']:
        """Return the map one step after ``now``, the rates of b_k and a, and the membrane.

        It is the map of ``height``; where this is that of ``now``, the map stays as it is.
        """
        change, shape, edges, shape_rate, scale_rate, *line = _move(
            height, height_now, *now, *before, dt, self._tables)
        if not change <= TOLERANCE:
            raise NotConverged(f'conformal map: the shape still changes by {change:.3g} chords '
                               f'after {PASSES} passes; the membrane is too strongly cambered '
                               'for this engine')
        return Map(shape, edges), shape_rate, scale_rate, Line(*line)


class Line(NamedTuple):
    """The membrane at the nodes, each (n,)."""

    place: np.ndarray               # z
    slope: np.ndarray               # z_zeta
    angles: np.ndarray              # theta, x = (1 + cos theta) / 2, below pi on the upper side
    shift: np.ndarray               # theta - xi


@kernel
def _move(height, height_now, shape, edges, shape_before, edges_before, dt, tables):
    """Return the last change of the map, its shape, edges and rates, and the membrane."""
    exterior, b = tables.value
    moves = False
    for i in range(height.size):
        moves = moves or height[i] != height_now[i]
    new_shape, new_edges = np.empty(shape.size, dtype=np.complex128), np.empty(edges.size)
    change = 0.0
    ahead = 1.0 if moves else 0.0
    for k in range(shape.size):
        new_shape[k] = shape[k] + ahead * (shape[k] - shape_before[k])
    for k in range(edges.size):
        new_edges[k] = edges[k] + ahead * (edges[k] - edges_before[k])
    if moves:
        change = _iterate(height, new_shape, new_edges, exterior, b)
    shape_rate = np.empty(shape.size, dtype=np.complex128)
    for k in range(shape.size):
        shape_rate[k] = (3.0 * new_shape[k] - 4.0 * shape[k] + shape_before[k]) / (2.0 * dt)
    scale_rate = (3.0 * new_edges[0] - 4.0 * edges[0] + edges_before[0]) / (2.0 * dt)
    place, slope, angles, shift = _line(new_shape, new_edges, exterior, b)
    return change, new_shape, new_edges, shape_rate, scale_rate, place, slope, angles, shift


@stage
def _line(shape, edges, exterior, b):
    """Return z, z_zeta, theta and theta - xi (n,) on the membrane."""
    n = exterior.xi.size
    place, slope = np.empty(n, dtype=np.complex128), np.empty(n, dtype=np.complex128)
    theta, shift = np.empty(n), np.empty(n)
    x, y = wall_series(shape, exterior, b)
    for i in range(n):
        xi = exterior.xi[i]
        place[i] = complex(x[i] + 2.0 * edges[0] * exterior.cos[i], y[i])
        angle = np.arccos(min(1.0, max(-1.0, 2.0 * place[i].real - 1.0)))
        theta[i] = angle if xi < edges[2] else 2.0 * np.pi - angle
        shift[i] = theta[i] - xi
    modes = np.empty(shape.size, dtype=np.complex128)
    for k in range(shape.size):
        modes[k] = k * shape[k]
    x, y = wall_series(modes, exterior, b)
    for i in range(n):
        slope[i] = complex(-x[i], 2.0 * edges[0] * exterior.sin[i] - y[i])
    return place, slope, theta, shift


@stage
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


@stage
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


@stage
def _iterate(height, shape, edges, exterior, b):
    """Repeat y <- Y(x), x <- conjugate of y until y settles; return its last change."""
    n = exterior.xi.size
    y, change = np.empty(n), np.inf
    for trial in range(PASSES):
        x, y_series = wall_series(shape, exterior, b)
        change = 0.0
        for i in range(n):
            if trial == 0:
                y[i] = y_series[i]
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
    return change if np.isfinite(edges[0] + edges[1] + edges[2]) else np.nan


@stage
def _conjugate(y, exterior, b, shape):
    """Write 2 i / n sum_j y_j exp(i k xi_j): the series with the imaginary part ``y`` (n,)."""
    modes = line_modes(y, b, exterior.plan)
    for k in range(shape.size):
        mode = exterior.start[k] * modes[k]
        shape[k] = complex(mode.imag, mode.real) * (2.0 / y.size)


@stage
def interpolate_even(values, angle):
    """Interpolate cubically an even function given at equidistant angles from 0 to pi."""
    last = values.size - 1
    position = angle * last / np.pi
    first = min(np.intp(position), last - 1)
    s = position - first
    below = values[abs(first - 1)]
    above = values[first + 2] if first + 2 <= last else values[2 * last - first - 2]
    return (-s * (s - 1.0) * (s - 2.0) / 6.0 * below
            + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * values[first]
            - (s + 1.0) * s * (s - 2.0) / 2.0 * values[first + 1]
            + (s + 1.0) * s * (s - 1.0) / 6.0 * above)

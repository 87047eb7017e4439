# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal map from the half-strip to the plane outside the membrane y = Y(x).

    z = 2 a cosh(zeta) + sum_k>=0 b_k exp(-k zeta),

a flat plate being a = 1/4, b_0 = 1/2.  On the membrane y is a periodic function of xi and x - 2 a
cos(xi) - x_0 its conjugate function, so that y(xi) = Y(x(xi)) is a fixed-point equation, which
contracts for every membrane less than some 25 % cambered; a and x_0 keep the edges at x = 1 and 0.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft

from dewing_sim.errors import NotConverged
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.kernels import kernel

TOLERANCE = 1.0e-10         # chords, of the last change; the next would be far smaller
PASSES = 300


@dataclass(frozen=True)
class Map:
    """One shape; complex ``shape`` (modes,) holds b_k, ``edges`` a, trailing and leading xi."""

    shape: np.ndarray
    edges: np.ndarray

    @property
    def scale(self) -> float:
        """The radius a."""
        return float(self.edges[0])


class Mapping:
    """Solves for maps on one grid and evaluates them there."""

    def __init__(self, grid: Grid):
        """Prepare the transforms of ``grid``."""
        k = grid.wavenumbers[:-1]
        self.grid = grid
        self._cos = np.cos(np.outer(k, grid.xi))
        self._sin = np.sin(np.outer(k, grid.xi))
        self._waves = np.ascontiguousarray(np.stack((self._sin.T, self._cos.T), axis=1))
        self._exp = np.exp(-np.outer(grid.eta, k) - 0.5j * k * grid.step)
        self._k = k
        self._axes = (np.sinh(grid.eta), np.cosh(grid.eta), np.cos(grid.xi), np.sin(grid.xi))

    def flat(self) -> Map:
        """Return the map of a flat plate."""
        shape = np.zeros(len(self._k), dtype=complex)
        shape[0] = 0.5
        return Map(shape, np.array([0.25, 0.0, np.pi]))

    def follow(self, height: np.ndarray, near: Map) -> Map:
        """Return the map of a membrane with heights at the column faces, starting from ``near``.

        Raises `NotConverged` for a shape that this map cannot describe.
        """
        shape, edges = near.shape.copy(), near.edges.copy()
        change = _iterate(np.ascontiguousarray(height), shape, edges, self._cos, self._sin,
                          self._waves, TOLERANCE, PASSES)
        if not (change <= TOLERANCE and np.isfinite(edges).all()):
            raise NotConverged(f'conformal map: the shape still changes by {change:.3g} chords '
                               f'after {PASSES} passes; the membrane is too strongly cambered '
                               'for this engine')
        return Map(shape, edges)

    def metric(self, m: Map) -> np.ndarray:
        """Return h^2 = |z_zeta|^2 (rows, n) on the nodes."""
        return _metric(self._series(np.array([self._k * m.shape]))[0], m.scale, *self._axes)

    def metric_and_flux(self, m: Map, scale: float, shape: np.ndarray,
                        ) -> tuple[np.ndarray, np.ndarray]:
        """Return h^2 and the grid flux z_t conj(z_zeta) for the rates of a and of b_k."""
        slope, rate = self._series(np.array([self._k * m.shape, shape]))
        return _metric_and_flux(slope, rate, m.scale, scale, *self._axes)

    def wall(self, m: Map) -> tuple[np.ndarray, np.ndarray]:
        """Return z and z_zeta (n,) on the membrane."""
        place = 2.0 * m.scale * self._axes[2] + _on_wall(m.shape, self._cos, self._sin)
        return place, self.slope(m)

    def slope(self, m: Map) -> np.ndarray:
        """Return z_zeta (n,) on the membrane."""
        series = _on_wall(self._k * m.shape, self._cos, self._sin)
        return 2.0j * m.scale * self._axes[3] - series

    def angles(self, m: Map) -> np.ndarray:
        """Return theta (n,) of the nodes: x = (1 + cos theta) / 2, upper side below pi."""
        return _angles(_abscissa(m.shape, m.edges, self._cos, self._sin), m.edges, self.grid.xi)

    def _series(self, modes: np.ndarray) -> np.ndarray:
        """Return sum_k modes_k exp(-k zeta) (sets, rows, n) for each set of modes (sets, k)."""
        spectrum = _spectra(self._exp, modes, len(self.grid.xi))
        return fft.fft(spectrum, axis=2, overwrite_x=True)


@kernel
def _spectra(exp, modes, n):
    rows, count = exp.shape
    out = np.zeros((modes.shape[0], rows, n), dtype=np.complex128)
    for m in range(modes.shape[0]):
        for j in range(rows):
            for k in range(count):
                out[m, j, k] = exp[j, k] * modes[m, k]
    return out


@kernel
def _metric(slope, scale, sinh, cosh, cos, sin):
    """Return |2 a sinh(zeta) - slope|^2."""
    rows, n = slope.shape
    h2 = np.empty((rows, n))
    for j in range(rows):
        s, c = 2.0 * scale * sinh[j], 2.0 * scale * cosh[j]
        for i in range(n):
            x, y = s * cos[i] - slope[j, i].real, c * sin[i] - slope[j, i].imag
            h2[j, i] = x * x + y * y
    return h2


@kernel
def _metric_and_flux(slope, rate, scale, scale_rate, sinh, cosh, cos, sin):
    """Return |s|^2 and (2 a_t cosh(zeta) + rate) conj(s) of s = 2 a sinh(zeta) - slope."""
    rows, n = slope.shape
    h2, flux = np.empty((rows, n)), np.empty((rows, n), dtype=np.complex128)
    for j in range(rows):
        s, c = 2.0 * scale * sinh[j], 2.0 * scale * cosh[j]
        s_rate, c_rate = 2.0 * scale_rate * sinh[j], 2.0 * scale_rate * cosh[j]
        for i in range(n):
            x, y = s * cos[i] - slope[j, i].real, c * sin[i] - slope[j, i].imag
            u, v = c_rate * cos[i] + rate[j, i].real, s_rate * sin[i] + rate[j, i].imag
            h2[j, i] = x * x + y * y
            flux[j, i] = complex(u * x + v * y, v * x - u * y)
    return h2, flux


@kernel
def _on_wall(modes, cos, sin):
    """Return sum_k modes_k exp(-i k xi), (n,)."""
    count, n = cos.shape
    real, imag = np.zeros(n), np.zeros(n)
    for k in range(count):
        p, q = modes[k].real, modes[k].imag
        for i in range(n):
            real[i] += p * cos[k, i] + q * sin[k, i]
            imag[i] += q * cos[k, i] - p * sin[k, i]
    return real + 1j * imag


@kernel
def _abscissa(shape, edges, cos, sin):
    """Return x (n,) of the nodes on the membrane."""
    x = 2.0 * edges[0] * cos[1] + shape[0].real
    for k in range(1, shape.size):
        p, q = shape[k].real, shape[k].imag
        for i in range(x.size):
            x[i] += p * cos[k, i] + q * sin[k, i]
    return x


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
def _iterate(height, shape, edges, cos, sin, waves, tolerance, passes):
    """Repeat y <- Y(x), x <- conjugate of y until y settles; return its last change."""
    modes, n = cos.shape
    y = np.zeros(n)
    for k in range(modes):
        p, q = shape[k].real, shape[k].imag
        for i in range(n):
            y[i] += q * cos[k, i] - p * sin[k, i]
    change = np.inf
    for _ in range(passes):
        x = _abscissa(shape, edges, cos, sin)
        change = 0.0
        for i in range(n):
            new = interpolate_even(height, np.arccos(min(1.0, max(-1.0, 1.0 - 2.0 * x[i]))))
            change = max(change, abs(new - y[i]))
            y[i] = new
        x0, scale = shape[0].real, edges[0]
        odd, even = np.zeros(modes), np.zeros(modes)
        for i in range(n):
            for k in range(modes):
                odd[k] += y[i] * waves[i, 0, k]
                even[k] += y[i] * waves[i, 1, k]
        for k in range(modes):
            shape[k] = complex(-odd[k], even[k]) * (2.0 / n)
        shape[0] = complex(x0, 0.5 * shape[0].imag)
        x0 = _pin(shape, edges)
        change = max(change, abs(x0 - shape[0].real), abs(edges[0] - scale))
        shape[0] = complex(x0, shape[0].imag)
        if not change > tolerance:
            break
    return change


@kernel
def _angles(x, edges, xi):
    theta = np.empty(x.size)
    for i in range(x.size):
        angle = np.arccos(min(1.0, max(-1.0, 2.0 * x[i] - 1.0)))
        theta[i] = angle if edges[1] < xi[i] < edges[2] else 2.0 * np.pi - angle
    return theta


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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Exact and asymptotic results that the solvers are compared with; c = U = rho = 1."""

import numpy as np

# Wagner's function at s semichords after an impulsive start (converged quadrature).
WAGNER = {1.0: 0.60061, 2.0: 0.66929, 4.0: 0.75797, 10.0: 0.87504}
TRIPLE_DECK = -0.375     # exponent of Re in the loss of lift at a trailing edge
QUADRATURE = 2000


def plate_drag(reynolds: float) -> float:
    """Return Cd of both sides of a flat plate along the stream.

    Blasius' boundary layer and the triple deck at its end: 2.656 Re^-1/2 + 5.34 Re^-7/8
    (Jobe and Burggraf 1974; Messiter 1970).
    """
    return 2.656 / np.sqrt(reynolds) + 5.34 * reynolds**-0.875


def wagner(s: np.ndarray) -> np.ndarray:
    """Return R. T. Jones' approximation of Wagner's function, within 1 %: a line for figures."""
    return 1.0 - 0.165 * np.exp(-0.0455 * s) - 0.335 * np.exp(-0.3 * s)


def theodorsen(k: float) -> complex:
    """Return C(k) at the reduced frequency k = omega c / 2 U (Theodorsen 1935)."""
    from scipy.special import hankel2
    first, zeroth = hankel2(1, k), hankel2(0, k)
    return complex(first / (first + 1j * zeroth))


def oscillating_plate(omega: float, heave: complex = 0.0, pitch: complex = 0.0,
                      pivot: float = 0.0, gust: complex = 0.0) -> complex:
    """Return Cl of a plate in ideal flow, all multiplied by exp(i omega t) (Theodorsen 1935).

    ``heave`` is up, ``pitch`` nose up about x/c = ``pivot``, ``gust`` a vertical velocity that is
    uniform in space: w being the upwash at mid-chord and q = d pitch / dt,
    pi/2 dw/dt + 2 pi C(k) (w + q / 4), w = pitch + gust - d heave / dt + (1/2 - pivot) q.
    """
    rate = 1j * omega
    turning = rate * pitch
    upwash = pitch + gust - rate * heave + (0.5 - pivot) * turning
    added = 0.5 * np.pi * rate * upwash
    return added + 2.0 * np.pi * theodorsen(0.5 * omega) * (upwash + 0.25 * turning)


def oscillating_camber(amplitude: float, omega: float) -> complex:
    """Return Cl of the camber ``amplitude`` exp(i omega t) of a parabola in ideal flow.

    Added mass and Theodorsen's circulatory part (k = omega / 2):
    (3 pi / 8) omega^2 a + 2 pi a (2 - i omega / 2) C(k).
    """
    return complex(amplitude * (0.375 * np.pi * omega**2 + 2.0 * np.pi * (2.0 - 0.5j * omega)
                                * theodorsen(0.5 * omega)))


def _theta() -> np.ndarray:
    """Return the midpoints of [0, pi]; x = (1 - cos theta) / 2."""
    return np.pi * (np.arange(QUADRATURE) + 0.5) / QUADRATURE


def _sines(modes: int) -> np.ndarray:
    """Return sin(n pi x) at the quadrature points (modes, points)."""
    x = 0.5 * (1.0 - np.cos(_theta()))
    return np.sin(np.pi * np.outer(np.arange(1, modes + 1), x))


def strip_added_mass(modes: int) -> np.ndarray:
    """Return the added mass (modes, modes) of sine modes of a strip, in rho c^2.

    A wall velocity w with w sin(theta) = sum_n b_n sin(n theta) makes the potential jump
    sum_n (b_n / n) sin(n theta), hence M_jk = pi/4 sum_n b_n^j b_n^k / n; heave gives pi/4.
    """
    theta = _theta()
    n = np.arange(1, 200)
    weights = np.sin(np.outer(n, theta)) * np.sin(theta) * (2.0 / QUADRATURE)
    b = _sines(modes) @ weights.T
    return 0.25 * np.pi * (b / n) @ b.T


def frequencies_in_air(tension: float, mass: float, count: int, modes: int = 24) -> np.ndarray:
    """Return natural frequencies of a pinned membrane in still ideal air, in U/c.

    ``tension`` is in rho U^2 c and ``mass`` in rho c. Galerkin's method with sine modes.
    """
    from scipy.linalg import eigh
    n = np.arange(1, modes + 1)
    stiffness = np.diag(0.5 * tension * (n * np.pi)**2)
    inertia = 0.5 * mass * np.eye(modes) + strip_added_mass(modes)
    return np.sqrt(eigh(stiffness, inertia, eigvals_only=True)[:count]) / (2.0 * np.pi)


def _sail(modes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return Galerkin stiffness per C_T, load per deflection and load per angle of attack.

    Thin-aerofoil theory: dcp / 4 = A_0 (1 + cos) / sin + sum_n A_n sin(n theta) with A_0 = alpha -
    mean of y_x and A_n = 2 mean of y_x cos(n theta).
    """
    theta = _theta()
    n = np.arange(1, modes + 1)
    x = 0.5 * (1.0 - np.cos(theta))
    slope = np.pi * n[:, None] * np.cos(np.pi * np.outer(n, x))
    first = (1.0 + np.cos(theta)) / np.sin(theta)
    harmonics = np.arange(1, 200)
    a = 2.0 * slope @ np.cos(np.outer(harmonics, theta)).T / QUADRATURE
    pressure = 4.0 * (a @ np.sin(np.outer(harmonics, theta))
                      - slope.mean(axis=1)[:, None] * first)
    weight = _sines(modes) * np.sin(theta) * (0.5 * np.pi / QUADRATURE)
    return np.diag(0.5 * (n * np.pi)**2), weight @ pressure.T, weight @ (4.0 * first)


def sail_divergence(modes: int = 48) -> float:
    """Return the tension C_T = T / (q c) below which a flat membrane diverges, 1.7275."""
    from scipy.linalg import eigvals
    stiffness, load, _ = _sail(modes)
    values = eigvals(load, stiffness)
    return float(values.real[np.abs(values.imag) < 1.0e-9].max())


def sail_deflection(tension: float, modes: int = 24) -> tuple[float, float]:
    """Return the largest y / alpha of a membrane of C_T = ``tension`` in ideal flow and its x.

    Sail theory (Thwaites 1961, Nielsen 1963): C_T y'' + dcp = 0.
    """
    stiffness, load, angle = _sail(modes)
    amplitude = np.linalg.solve(tension * stiffness - load, angle)
    x = np.linspace(0.0, 1.0, 2001)
    y = np.sin(np.pi * np.outer(x, np.arange(1, modes + 1))) @ amplitude
    return float(y.max()), float(x[np.argmax(y)])

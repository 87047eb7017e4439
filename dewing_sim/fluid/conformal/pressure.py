# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Wall pressure and loads from the Lamb vector, without any wall-normal derivative of vorticity.

With P = p + q^2 / 2 the momentum equation is u_t + omega x u + grad P = -nu curl omega.  Its
component normal to the membrane, and the Poisson equation of P weighted with exp(-k eta), give

    k P_k = A_k + i nu k w_k - k integral exp(-k eta) [(w U)_k - i (w V)_k] d eta,   k > 0,

where A = Re(a conj(z_zeta)) is the acceleration a of the membrane through its own surface: the
first term is the added mass.  The others pass a filter of fourth order in k dxi: the pressure of
the two sides differs up to the very edge, a step in xi that would ring.
"""

from typing import NamedTuple

import numpy as np
from numpy import fft

from dewing_sim.fluid.conformal.fourier.modes import line_modes, line_values
from dewing_sim.fluid.conformal.fourier.stockham import transform
from dewing_sim.fluid.conformal.geometry.wall import motion_along
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.machine.kernels import kernel, stage, summing_kernel


class WallPressure(NamedTuple):
    """Quadrature of exp(-k eta) over the rows and the inverse of the wave number."""

    weight: np.ndarray              # (modes, rows)
    inverse: np.ndarray             # (modes,) 1 / k, 0 for mode 0
    viscous: np.ndarray             # (modes,) i nu
    added_mass: np.ndarray          # (n, n) P of a normal acceleration A, symmetric

    @classmethod
    def of(cls, grid: Grid, nu: float) -> 'WallPressure':
        """Return the operator on ``grid``."""
        k = grid.wavenumbers
        inverse = np.zeros(len(k))
        inverse[1:] = 1.0 / k[1:]
        faces = np.concatenate(([0.0], grid.face))
        weight = -np.diff(np.exp(-np.outer(k, faces)), axis=1) * inverse[:, None]
        viscous = np.full(len(k), 1j * nu)
        viscous[0] = 0.0
        smooth = 1.0 - np.sin(0.5 * k * grid.step)**4
        unit = fft.rfft(np.eye(len(grid.xi)), axis=0)
        return cls(weight * smooth[:, None], inverse, viscous * smooth,
                   fft.irfft(inverse[:, None] * unit, axis=0))


@kernel
def added_mass(matrix, change, dt, angles, slope):
    """Return the change of P (n,) by a ``change`` of the wall's velocity (columns,).

    ``matrix`` is `WallPressure.added_mass`; ``angles`` and ``slope`` are of the `mapping.Line`.
    """
    still = np.zeros(change.size)
    acceleration = motion_along(change, still, still, dt, angles, slope)[2]
    out = np.zeros(acceleration.size)
    for k in range(out.size):
        for i in range(out.size):
            out[i] += matrix[k, i] * acceleration[k]
    return out


@kernel
def completed(pressure, velocity, predicted, matrix, dt, angles, slope):
    """Return P (n,) at a wall velocity (columns,) from P at the ``predicted`` one."""
    change, moves = np.empty(velocity.size), False
    for i in range(velocity.size):
        change[i] = velocity[i] - predicted[i]
        moves = moves or change[i] != 0.0
    if not moves:
        return pressure
    out = added_mass(matrix, change, dt, angles, slope)
    for i in range(out.size):
        out[i] += pressure[i]
    return out


@stage
def wall_head(p, w, v, u, motion, b, plan):
    """Return P (n,) on the membrane less its mean, for its motion, see `WallMotion`.

    ``v`` and ``u`` (n, rows) are the fluxes through the cell faces.
    """
    _lamb_vector(w, v, u, motion.v, motion.u, b)
    head = _weighted_modes(p.weight, w.shape[0], b, plan)
    vorticity = np.empty(w.shape[0])
    for i in range(w.shape[0]):
        vorticity[i] = w[i, 0]
    head += p.inverse * line_modes(motion.acceleration, b, plan)
    head += p.viscous * line_modes(vorticity, b, plan)
    return line_values(head, b, plan)


@stage
def _weighted_modes(weight, n, b, plan):
    """Return -sum_j weight_kj X_kj of the modes X_k of the field in ``b``, complex (n / 2 + 1,).

    X_k = E_k + W^k O_k, with the transforms E of even and O of odd lines side by side.
    """
    last, rows = n // 2, weight.shape[1]
    re, im = transform(b, last, 2 * rows, plan.half)
    total = np.empty(last + 1, dtype=np.complex128)
    for k in range(last + 1):
        x, y, factors = re[k % last], im[k % last], weight[k]
        even = complex(_dot(factors, x[:rows]), _dot(factors, y[:rows]))
        odd = complex(_dot(factors, x[rows:]), _dot(factors, y[rows:]))
        total[k] = -even - complex(plan.cos[k], plan.sin[k]) * odd
    return total


@stage
def _lamb_vector(w, v, u, v_wall, u_wall, b):
    """Write w (U - i V) (n, rows) on the nodes from the fluxes through the cell faces."""
    n, rows = w.shape
    re, im = b.re[:n * rows].reshape((n, rows)), b.im[:n * rows].reshape((n, rows))
    for i in range(n):
        before = i - 1 if i else n - 1
        re[i, 0], im[i, 0] = w[i, 0] * u_wall[i], -w[i, 0] * v_wall[i]
        for j in range(1, rows):
            re[i, j] = 0.5 * w[i, j] * (u[i, j] + u[before, j])
            im[i, j] = -0.5 * w[i, j] * (v[i, j] + v[i, j - 1])


@summing_kernel
def _dot(a, b):
    total = 0.0
    for j in range(a.size):
        total += a[j] * b[j]
    return total


@kernel
def force(pressure, w, place, slope, nu, step):
    """Return Fx + i Fy of the flow on the membrane, and the moment about c/4, nose down.

    They integrate (-p + i nu w) z_zeta over xi, ``step`` apart; ``w`` (n, rows) is vorticity.
    """
    total, moment = complex(0.0, 0.0), 0.0
    for i in range(pressure.size):
        traction = complex(-pressure[i], nu * w[i, 0]) * slope[i]
        total += traction
        moment += (place[i].real - 0.25) * traction.imag - place[i].imag * traction.real
    return total * step, moment * step

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

from dataclasses import dataclass

import numpy as np
from scipy import fft

from dewing_sim.fluid.conformal.fourier import Line
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.kernels import kernel


@dataclass(frozen=True)
class WallPressure:
    """Quadrature of exp(-k eta) over the rows and the inverse of the wave number."""

    line: Line
    weight: np.ndarray              # (rows, modes)
    inverse: np.ndarray             # (modes,) 1 / k, 0 for mode 0
    viscous: np.ndarray             # (modes,) i nu

    @classmethod
    def of(cls, grid: Grid, nu: float) -> 'WallPressure':
        """Return the operator on ``grid``."""
        k = grid.wavenumbers
        inverse = np.zeros(len(k))
        inverse[1:] = 1.0 / k[1:]
        faces = np.concatenate(([0.0], grid.face))
        weight = -np.diff(np.exp(-np.outer(faces, k)), axis=0) * inverse
        viscous = np.full(len(k), 1j * nu)
        viscous[0] = 0.0
        smooth = 1.0 - np.sin(0.5 * k * grid.step)**4
        return cls(Line.of(len(grid.xi)), weight * smooth, inverse, viscous * smooth)

    def __call__(self, vorticity: np.ndarray, lamb: np.ndarray, acceleration: np.ndarray,
                 ) -> np.ndarray:
        """Return P (n,) on the membrane less its mean; ``lamb`` (rows, n) is w (U - i V), lost."""
        spectrum = fft.fft(lamb, axis=1, overwrite_x=True)
        head = (self.inverse * self.line.modes(acceleration)
                + self.viscous * self.line.modes(vorticity[0])
                - _integral(self.weight, spectrum))
        return self.line.values(head)

    def added_mass(self, flux: np.ndarray) -> np.ndarray:
        """Return the change of P (n,) by a normal acceleration A (n,)."""
        return self.line.values(self.inverse * self.line.modes(flux))


@kernel
def _integral(weight, spectrum):
    rows, modes = weight.shape
    total = np.zeros(modes, dtype=np.complex128)
    for j in range(rows):
        for k in range(modes):
            total[k] += weight[j, k] * spectrum[j, k]
    return total


@kernel
def lamb_vector(w, v, u, v_wall, u_wall):
    """Return w (U - i V) (rows, n) on the nodes from the fluxes through the cell faces."""
    rows, n = w.shape
    out = np.empty((rows, n), dtype=np.complex128)
    for i in range(n):
        out[0, i] = w[0, i] * complex(u_wall[i], -v_wall[i])
    for j in range(1, rows):
        out[j, 0] = 0.5 * w[j, 0] * complex(u[j, 0] + u[j, n - 1], -v[j, 0] - v[j - 1, 0])
        for i in range(1, n):
            out[j, i] = 0.5 * w[j, i] * complex(u[j, i] + u[j, i - 1], -v[j, i] - v[j - 1, i])
    return out


def force(pressure: np.ndarray, vorticity: np.ndarray, slope: np.ndarray, nu: float,
          ) -> np.ndarray:
    """Return d(Fx + i Fy) / d xi = (-p + i nu w) z_zeta (n,) of the flow on the membrane."""
    return (-pressure + 1j * nu * vorticity) * slope

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Dielectric elastomer: Gent + volumetric + electrostatic energy, and its thin-sheet reduction.

Energy per unit volume of unstretched material at a given voltage, in principal stretches l_i with
the field along l_3 (Buoso and Palacios, IFASD-2015-072, section 2; Gent, doi 10.5254/1.3538357):

    W = -(mu Jm / 2) log(1 - (I1bar - 3) / Jm) + K (J - 1)^2 - (eps / 2) J E^2,   E = V / (H l_3)

Its derivatives with respect to e_i = log l_i are the Kirchhoff stresses tau_i = J sigma_i, which
contain the Maxwell stress: +eps E^2/2 along the field and -eps E^2/2 across. Any consistent units.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np

from dewing_sim.errors import BadInput, Diverged

VACUUM_PERMITTIVITY = 8.8541878128e-12     # F/m, CODATA 2018


@numba.njit(cache=True)
def potential(l1, l2, l3, field_squared, mu, jm, bulk, eps):
    """Return W for the square of the nominal field V / H."""
    j = l1 * l2 * l3
    i1 = (l1 * l1 + l2 * l2 + l3 * l3) * j ** (-2.0 / 3.0)
    return (-0.5 * mu * jm * np.log(1.0 - (i1 - 3.0) / jm) + bulk * (j - 1.0) ** 2
            - 0.5 * eps * field_squared * j / (l3 * l3))


@numba.njit(cache=True)
def gent(i1, mu, jm):
    """Return the first and second derivative of the Gent energy in I1bar."""
    room = jm - (i1 - 3.0)
    first = 0.5 * mu * jm / room
    return first, first / room


@numba.njit(cache=True)
def volumetric(j, bulk):
    """Return the first and second derivative of K (J - 1)^2 in log J."""
    return 2.0 * bulk * (j - 1.0) * j, 2.0 * bulk * (2.0 * j - 1.0) * j


@numba.njit(cache=True)
def kirchhoff(l1, l2, l3, field_squared, mu, jm, bulk, eps):
    """Return tau_1, tau_2, tau_3, the moduli d tau_i / d e_k for ik = 11, 13, 33, and I1bar."""
    j = l1 * l2 * l3
    scale = j ** (-2.0 / 3.0)
    b1, b2, b3 = scale * l1 * l1, scale * l2 * l2, scale * l3 * l3
    i1 = b1 + b2 + b3
    s1, s2, s3 = b1 - i1 / 3.0, b2 - i1 / 3.0, b3 - i1 / 3.0
    g1, g2 = gent(i1, mu, jm)
    u1, u2 = volumetric(j, bulk)
    electric = -0.5 * eps * field_squared * j / (l3 * l3)
    trace = 2.0 * i1 / 9.0
    c11 = 4.0 * g2 * s1 * s1 + 2.0 * g1 * (2.0 * b1 / 3.0 + trace) + u2 + electric
    c13 = 4.0 * g2 * s1 * s3 + 2.0 * g1 * (trace - 2.0 * (b1 + b3) / 3.0) + u2 - electric
    c33 = 4.0 * g2 * s3 * s3 + 2.0 * g1 * (2.0 * b3 / 3.0 + trace) + u2 + electric
    return (2.0 * g1 * s1 + u1 + electric, 2.0 * g1 * s2 + u1 + electric,
            2.0 * g1 * s3 + u1 - electric, c11, c13, c33, i1)


_BALANCED, _LOCKED, _PULLED_IN = 0, 1, 2


@numba.njit(cache=True)
def _balance_thickness(l1, l2, l3, field_squared, mu, jm, bulk, eps):
    """Solve tau_3 = 0 for l_3; return tau_1, d tau_1/d e_1, d tau_1/d field_squared, l_3, status.

    Newton from the given l_3. The last correction is condensed into tau_1, which leaves an error
    of its square.
    """
    for _ in range(60):
        t1, _t2, t3, c11, c13, c33, i1 = kirchhoff(l1, l2, l3, field_squared, mu, jm, bulk, eps)
        if not i1 - 3.0 < jm:
            return t1, c11, 0.0, l3, _LOCKED
        if not c33 > 0.0:
            return t1, c11, 0.0, l3, _PULLED_IN
        change = -t3 / c33
        if abs(change) < 1.0e-8:
            slope = -0.5 * eps * l1 * l2 / l3 * (1.0 + c13 / c33)
            return (t1 + c13 * change, c11 - c13 * c13 / c33, slope, l3 * (1.0 + change),
                    _BALANCED)
        l3 *= math.exp(min(max(change, -0.5), 0.5))
    return t1, c11, 0.0, l3, _PULLED_IN


@numba.njit(cache=True)
def _respond(stretch, lateral, thickness, v_squared, mu, jm, bulk, eps):
    """Fill rows tension, its slopes in stretch and V^2, thickness; return status and element."""
    response = np.empty((4, stretch.size))
    field_squared = v_squared / thickness ** 2
    volume = 1.0        # J of the neighbour is the best first guess
    for k in range(stretch.size):
        l1 = stretch[k]
        tau, modulus, slope, l3, status = _balance_thickness(
            l1, lateral, volume / (l1 * lateral), field_squared, mu, jm, bulk, eps)
        if status != _BALANCED:
            return response, status, k
        volume = l1 * lateral * l3
        scale = thickness / (l1 * lateral)
        response[0, k] = scale * tau
        response[1, k] = scale * (modulus - tau) / l1
        response[2, k] = scale * slope / thickness ** 2
        response[3, k] = thickness * l3
    return response, _BALANCED, -1


@dataclass(frozen=True)
class Elastomer:
    """Shear modulus mu, Gent limit Jm, bulk modulus K of K (J-1)^2, permittivity eps."""

    shear_modulus: float
    gent_limit: float
    bulk_modulus: float
    permittivity: float

    @property
    def constants(self) -> tuple[float, float, float, float]:
        """(mu, Jm, K, eps), the order in which the kernels take them."""
        return self.shear_modulus, self.gent_limit, self.bulk_modulus, self.permittivity

    def free_energy(self, stretches, field_squared: float = 0.0) -> float:
        """Return W at principal ``stretches`` (3,) and nominal field squared (V/H)^2."""
        return potential(*stretches, field_squared, *self.constants)

    def cauchy_stress(self, stretches, field_squared: float = 0.0) -> np.ndarray:
        """Return the total principal Cauchy stresses (3,), Maxwell stress included."""
        tau = kirchhoff(*stretches, field_squared, *self.constants)[:3]
        return np.array(tau) / np.prod(stretches)


class Response(NamedTuple):
    """State of a sheet at given stretches, each of shape (n,)."""

    tension: np.ndarray             # T = sigma_1 h, force per unit deformed span
    stiffness: np.ndarray           # dT / d stretch at constant V
    voltage_slope: np.ndarray       # dT / dV^2 at constant stretch, -eps/h when incompressible
    thickness: np.ndarray           # h


@dataclass(frozen=True)
class Sheet:
    """A thin layer of elastomer between compliant electrodes, with traction-free faces.

    The through-thickness stress vanishes, sigma_3 = 0 with Maxwell stress included, which
    determines the thickness stretch; the lateral stretch is fixed (1: plane strain).
    """

    elastomer: Elastomer
    initial_thickness: float
    lateral_stretch: float = 1.0

    def respond(self, stretch, v_squared: float) -> Response:
        """Return tension, slopes and thickness at total stretches (n,) and the given V^2.

        Raises `BadInput` for a negative or non-finite V^2, `Diverged` beyond the Gent limit or
        where the field squeezes the thickness to nothing.
        """
        if not 0.0 <= v_squared < math.inf:
            raise BadInput(f'v_squared = {v_squared} V^2 is out of range: from 0 to infinity')
        stretch = np.asarray(stretch, dtype=float)
        response, status, k = _respond(stretch, self.lateral_stretch, self.initial_thickness,
                                       float(v_squared), *self.elastomer.constants)
        if status != _BALANCED:
            raise Diverged(self._describe_failure(status, k, stretch[k], v_squared))
        return Response(*response)

    def _describe_failure(self, status: int, element: int, stretch: float, v_squared: float,
                          ) -> str:
        where = f'element {element} at stretch {stretch:.6g} and {math.sqrt(v_squared):.6g} V'
        if not math.isfinite(stretch):
            return f'{where}: the deformation is not finite; reduce the time step or the load'
        if status == _LOCKED:
            return (f'{where}: I1bar - 3 reaches the Gent limit '
                    f'{self.elastomer.gent_limit:.6g}; reduce the load or the prestretch')
        return f'{where}: no thickness balances the Maxwell stress; reduce the voltage'

    def loss_of_tension_v_squared(self, stretch: float) -> float:
        """Return the V^2 at which the tension vanishes at the given total stretch.

        In the incompressible limit h^2 sigma/eps; zero where there is no tension to lose.
        """
        v_squared = 0.0
        for _ in range(100):
            response = self.respond([stretch], v_squared)
            change = -float(response.tension[0] / response.voltage_slope[0])
            v_squared = max(0.0, v_squared + change)
            if abs(change) <= 1.0e-12 * v_squared or v_squared == 0.0:
                return v_squared
        raise Diverged(f'no loss of tension found at stretch {stretch:.6g}: V^2 = {v_squared:.6g} '
                       f'still changes by {change:.3g}; the thickness pulls in before')

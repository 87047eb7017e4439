# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The thin-sheet reduction of the material: principal stretches, traction-free faces.

With the field along l_3 the derivatives of W with respect to e_i = log l_i are the Kirchhoff
stresses tau_i = J sigma_i, which contain the Maxwell stress: +eps E^2/2 along the field and
-eps E^2/2 across. They follow from `material.elastomer` with I1 = sum l_i^2, J = l_1 l_2 l_3 and
Y = l_1 l_2 V / H.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.machine.kernels import kernel
from dewing_sim.scales import Scales
from dewing_sim.structure.material import law, registry
from dewing_sim.structure.material.elastomer import Elastomer, energy, modulus, slopes, stress
from dewing_sim.structure.material.viscosity import Overstress

SI = Scales(length=1.0, speed=1.0, density=1.0, viscosity=1.0)
NO_OVERSTRESS = Overstress(0.0, np.zeros((2, 0)))


@kernel
def kirchhoff(l1, l2, l3, field_squared, k):
    """Return tau_1, tau_3, the moduli d tau_i / d e_k for ik = 11, 13, 33, and 2 dW/dI1.

    ``k`` are the `Elastomer.constants`, here as in the other kernels.
    """
    j = l1 * l2 * l3
    b1, b3 = l1 * l1, l3 * l3
    i1 = b1 + l2 * l2 + b3
    y = (l1 * l2) ** 2 * field_squared
    s = slopes(i1, j, y, l2, k)
    # By logarithms: dJ = J, d(I1)/2 = l_i^2, d(Y^2)/2 = Y^2 for i = 1 and 0 for i = 3.
    return (stress(s, b1, j, y), stress(s, b3, j, 0.0),
            modulus(s, b1, j, y, b1, j, y, 2.0 * b1, j, 2.0 * y),
            modulus(s, b1, j, y, b3, j, 0.0, 0.0, j, 0.0),
            modulus(s, b3, j, 0.0, b3, j, 0.0, 2.0 * b3, j, 0.0),
            s.f)


BALANCED, _LOCKED, _PULLED_IN = 0, 1, 2
NEARLY_BALANCED = 1.0e-8    # logarithm of the thickness stretch


@kernel
def _balance_thickness(l1, l2, l3, field_squared, extra1, extra3, k):
    """Solve tau_3 = 0 for l_3; return tau_1, d tau_1/d e_1, d tau_1/d field_squared, l_3, status.

    ``extra1`` and ``extra3`` are second Piola-Kirchhoff stresses on top, held fixed. Newton from
    the given l_3. The last correction is condensed into tau_1, which leaves an error of its
    square; the bulk modulus has no part in that, for it cancels from tau_1 - tau_3.
    """
    for _ in range(60):
        t1, t3, c11, c13, c33, softness = kirchhoff(l1, l2, l3, field_squared, k)
        t1, c11 = t1 + extra1 * l1 * l1, c11 + 2.0 * extra1 * l1 * l1
        t3, c33 = t3 + extra3 * l3 * l3, c33 + 2.0 * extra3 * l3 * l3
        if not 0.0 < softness < math.inf:       # the law locks up or fails
            return t1, c11, 0.0, l3, _LOCKED
        if not c33 > 0.0:
            return t1, c11, 0.0, l3, _PULLED_IN
        change, ratio = -t3 / c33, c13 / c33
        if abs(change) < NEARLY_BALANCED:
            slope = -0.5 * k.eps * l1 * l2 / l3 * (1.0 + ratio)
            return (t1 + c13 * change, c11 - c13 * ratio, slope, l3 * (1.0 + change), BALANCED)
        l3 *= math.exp(min(max(change, -0.5), 0.5))
    return t1, c11, 0.0, l3, _PULLED_IN


@kernel
def respond(stretch, lateral, thickness, v_squared, extra, constants):
    """Fill rows tension, its slopes in stretch and V^2, thickness; return status and element.

    ``extra`` (2, n) are stresses on top, see `_balance_thickness`, or (2, 0) without.
    """
    response = np.empty((4, stretch.size))
    field_squared = v_squared / thickness ** 2
    volume = 1.0        # J of the neighbour is the best first guess
    extra1, extra3 = 0.0, 0.0
    for k in range(stretch.size):
        l1 = stretch[k]
        per_area = 1.0 / (l1 * lateral)
        if extra.shape[1] > 0:
            extra1, extra3 = extra[0, k], extra[1, k]
        tau, modulus, slope, l3, status = _balance_thickness(
            l1, lateral, volume * per_area, field_squared, extra1, extra3, constants)
        if status != BALANCED:
            return response, status, k
        volume = l1 * lateral * l3
        scale = thickness * per_area
        response[0, k] = scale * tau
        response[1, k] = scale * (modulus - tau) * (per_area * lateral)
        response[2, k] = per_area * slope / thickness
        response[3, k] = thickness * l3
    return response, BALANCED, -1


@kernel
def _deviatoric_stresses(along, through, lateral, constants):
    """Return S_11 and S_33 (2, n) of squared stretches (n,)."""
    stresses = np.empty((2, along.size))
    for i in range(along.size):
        stresses[0, i], stresses[1, i], _ = law.deviatoric(
            along[i], through[i], 0.0, lateral, constants)
    return stresses


@kernel
def _energies(i1, j, y_squared, lateral, constants):
    """Return elastic and electrostatic energies (n,)."""
    elastic, electric = np.empty(j.size), np.empty(j.size)
    for i in range(j.size):
        elastic[i] = energy(i1[i], j[i], 0.0, lateral, constants)
        electric[i] = elastic[i] - energy(i1[i], j[i], y_squared[i], lateral, constants)
    return elastic, electric


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

    @classmethod
    def from_parameters(cls, section: parameters.Membrane, scales: Scales = SI) -> 'Sheet':
        """Return the sheet of a parameter section in the units of ``scales``, see `registry`."""
        return cls(registry.elastomer_of(section, scales),
                   section.initial_thickness / scales.length, section.prestretch_lateral)

    def respond(self, stretch, v_squared: float, overstress: Overstress | None = None,
                ) -> Response:
        """Return tension, slopes and thickness at total stretches (n,) and the given V^2.

        Raises `BadInput` for a negative or non-finite V^2, `Diverged` where the law locks up or
        where the field squeezes the thickness to nothing.
        """
        stretch = np.asarray(stretch, dtype=float)
        response, status, k = respond(
            stretch, *self.constants(v_squared, overstress))
        if status != BALANCED:
            raise Diverged(self._describe_failure(status, k, stretch[k], v_squared))
        return Response(*response)

    def constants(self, v_squared: float, overstress: Overstress | None = None) -> tuple:
        """Return what the compiled `respond` takes after the stretches.

        Raises `BadInput` for a negative or non-finite V^2.
        """
        if not 0.0 <= v_squared < math.inf:
            raise BadInput(f'v_squared = {v_squared} V^2 is out of range: from 0 to infinity')
        gain, held = overstress or NO_OVERSTRESS
        return (self.lateral_stretch, self.initial_thickness, float(v_squared), held,
                self.elastomer.stiffened(gain))

    def deviatoric_stress(self, stretch, thickness) -> np.ndarray:
        """Return the deviatoric second Piola-Kirchhoff stress of the law, (2, n).

        The components are those along the stretch and through ``thickness`` (n,).
        """
        through, lateral = np.square(thickness / self.initial_thickness), self.lateral_stretch ** 2
        along, k = np.square(stretch), self.elastomer.constants
        if self.elastomer.law.TAKES_ARRAYS:
            return np.stack(law.deviatoric(along, through, 0.0, lateral, k)[:2])
        return _deviatoric_stresses(along, through, lateral, k)

    def energies(self, stretch, v_squared: float) -> tuple[np.ndarray, np.ndarray]:
        """Return elastic and electrostatic energy eps J E^2 / 2 per unstretched volume, (n,)."""
        stretch = np.asarray(stretch, dtype=float)
        l3 = self.respond(stretch, v_squared).thickness / self.initial_thickness
        i1 = stretch ** 2 + self.lateral_stretch ** 2 + l3 ** 2
        j = stretch * self.lateral_stretch * l3
        y_squared = (stretch * self.lateral_stretch / self.initial_thickness) ** 2 * v_squared
        elastomer, lateral = self.elastomer, self.lateral_stretch
        if not elastomer.law.TAKES_ARRAYS:
            return _energies(i1, j, y_squared, lateral, elastomer.constants)
        elastic = energy(i1, j, 0.0, lateral, elastomer.constants)
        return elastic, elastic - energy(i1, j, y_squared, lateral, elastomer.constants)

    def _describe_failure(self, status: int, element: int, stretch: float, v_squared: float,
                          ) -> str:
        where = f'element {element} at stretch {stretch:.6g} and {math.sqrt(v_squared):.6g} V'
        if not math.isfinite(stretch):
            return f'{where}: the deformation is not finite; reduce the time step or the load'
        if status == _LOCKED:
            return (f'{where}: {self.elastomer.law.limit}; '
                    'reduce the load, the prestretch or the time step')
        return f'{where}: no thickness balances the Maxwell stress; reduce the voltage'

    def loss_of_tension_v_squared(self, stretch: float) -> float:
        """Return the least V^2 at which the tension vanishes at the given total stretch.

        In the incompressible limit h^2 sigma/eps; zero where there is no tension to lose. Raises
        `Diverged` where no V^2 takes it: the thickness pulls in before, or, next to the locking of
        a compressible law, the squeezed sheet stiffens faster than the field relieves it.
        """
        taut, beyond, v_squared = 0.0, math.inf, 0.0
        tension, slope = self._tension_and_slope(stretch, v_squared)
        if tension <= 0.0:
            return 0.0
        while True:
            if tension > 0.0 and slope < 0.0:
                taut = v_squared
            else:
                beyond = v_squared
            if taut >= (1.0 - 1.0e-12) * beyond:
                break
            better = v_squared - tension / slope if slope < 0.0 else math.nan
            if abs(better - v_squared) <= 1.0e-12 * better:
                return better
            # Newton, where that stays between what is known to be taut and what is not
            v_squared = better if taut < better < beyond else 0.5 * (taut + beyond)
            try:
                tension, slope = self._tension_and_slope(stretch, v_squared)
            except Diverged:
                tension, slope = math.inf, math.inf
        raise Diverged(f'no voltage takes the tension at stretch {stretch:.6g}: it falls up to '
                       f'{math.sqrt(taut):.6g} V, beyond which the sheet stiffens, locks up or '
                       'pulls in; reduce the prestretch')

    def _tension_and_slope(self, stretch: float, v_squared: float) -> tuple[float, float]:
        response = self.respond([stretch], v_squared)
        return float(response.tension[0]), float(response.voltage_slope[0])

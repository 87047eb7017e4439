# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Dielectric elastomer: isochoric + volumetric + electrostatic energy, its stresses and moduli.

Energy per unit volume of unstretched material at a given voltage (Buoso and Palacios,
IFASD-2015-072, section 2), for the deformation gradient F and the nominal field E0 (the field
times the stretch along it):

    W = W_law + K (J - 1)^2 - (eps / 2) Y^2 / J,   J = det F,   Y = cof(F) E0,

where W_law is that of a `law.Law` and Y^2 / J = J E^2 with the true field E = F^-T E0, so that
dW/dF contains the Maxwell stress. At a prescribed third stretch W depends on the motion through
I1 = tr(F^T F), J and Y^2 only: `slopes` differentiates it by these three, `stress` and `modulus`
carry the result to any coordinates. The principal stretches of a `sheet.Sheet` and the solid
element use the same three functions, plain in Python and compiled inside compiled code. Any
consistent system of units.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dewing_sim.machine.kernels import formula
from dewing_sim.structure.material import law as laws
from dewing_sim.structure.material import tensors
from dewing_sim.structure.material.law import Law

VACUUM_PERMITTIVITY = 8.8541878128e-12     # F/m, CODATA 2018


class Slopes(NamedTuple):
    """Factors of first and second derivatives of W, see `stress` and `modulus`."""

    f: float
    c: float
    y: float
    ff: float
    fc: float
    cc: float
    yc: float


@formula
def energy(i1, j, y_squared, lateral, k):
    """Return W at I1, J, Y^2 and the prescribed stretch; ``k`` are an `Elastomer.constants`."""
    return (laws.energy(i1, j, lateral, k) + k.bulk * (j - 1.0) ** 2
            - 0.5 * k.eps * y_squared / j)


@formula
def slopes(i1, j, y_squared, lateral, k):
    """Return the factors of the derivatives of W at I1, J and Y^2."""
    return completed(laws.slopes(i1, j, lateral, k), j, y_squared, k)


@formula
def completed(s, j, y_squared, k):
    """Return the slopes of a `law.Plane` with those of volume and field."""
    specific = 1.0 / j
    electric = k.eps * specific * specific
    return Slopes(
        s.f, 2.0 * k.bulk * (j - 1.0) + s.c + 0.5 * electric * y_squared, -k.eps * specific,
        s.ff, s.fc, s.cc + 2.0 * k.bulk - electric * y_squared * specific, electric)


@formula
def stress(s, f, c, y):
    """Return dW/dx from f = d(I1)/dx / 2, c = dJ/dx, y = d(Y^2)/dx / 2."""
    return s.f * f + s.c * c + s.y * y


@formula
def modulus(s, f, c, y, f_other, c_other, y_other, f_both, c_both, y_both):
    """Return d2W/dx dx' from the derivatives by x, by x' and the second derivatives by both.

    ``f_both`` and ``y_both`` are halves like ``f`` and ``y``.
    """
    return (s.f * f_both + s.c * c_both + s.y * y_both
            + s.ff * f * f_other + s.fc * (f * c_other + c * f_other)
            + s.cc * c * c_other + s.yc * (y * c_other + c * y_other))


@dataclass(frozen=True)
class Elastomer:
    """A law, the bulk modulus K of K (J-1)^2 and the permittivity eps.

    Methods take deformation gradients F (..., 3, 3) and nominal fields E0 (..., 3), any leading
    shape: integration points are vectorised.
    """

    law: Law
    bulk_modulus: float
    permittivity: float

    @cached_property
    def constants(self) -> tuple:
        """The one tuple that kernels take, whose type tells them the law."""
        return self.law.constants(self.bulk_modulus, self.permittivity)

    def stiffened(self, gain: float) -> tuple:
        """Return the constants with the energy of the law times 1 + ``gain``."""
        return (self.law.constants(self.bulk_modulus, self.permittivity, gain) if gain
                else self.constants)

    def energy(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return W, (...)."""
        motion = tensors.motion(gradient, field)
        if self.law.OF_I1_ALONE:
            return energy(motion.i1, motion.j, motion.y_squared, 1.0, self.constants)
        return (tensors.principal(gradient, self.constants).energy
                + self.bulk_modulus * (motion.j - 1.0) ** 2
                - 0.5 * self.permittivity * motion.y_squared / motion.j)

    def first_piola(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return P = dW/dF, (..., 3, 3)."""
        motion = tensors.motion(gradient, field)
        s = self._slopes(motion, 2)
        found = stress(s, motion.f, motion.c, motion.y)
        if self.law.OF_I1_ALONE:
            return found
        return found + tensors.stress_of(tensors.principal(gradient, self.constants))

    def tangent(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return dP/dF, (..., 3, 3, 3, 3)."""
        motion = tensors.motion(gradient, field)
        first = [part[..., :, :, None, None] for part in (motion.f, motion.c, motion.y)]
        other = [part[..., None, None, :, :] for part in (motion.f, motion.c, motion.y)]
        identity = np.einsum('ik,jl->ijkl', np.eye(3), np.eye(3))
        found = modulus(self._slopes(motion, 4), *first, *other, identity,
                        motion.c_both, motion.y_both)
        if self.law.OF_I1_ALONE:
            return found
        return found + tensors.tangent_of(tensors.principal(gradient, self.constants))

    def kirchhoff_stress(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return tau = P F^T, (..., 3, 3)."""
        return np.einsum('...ij,...kj->...ik', self.first_piola(gradient, field), gradient)

    def cauchy_stress(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return sigma = tau / J with the Maxwell stress included, (..., 3, 3)."""
        volume = np.linalg.det(gradient)[..., None, None]
        return self.kirchhoff_stress(gradient, field) / volume

    def _slopes(self, motion: tensors.Motion, axes: int) -> Slopes:
        """Return the slopes with ``axes`` trailing axes of length one.

        A law that is not of I1bar alone has no part in them.
        """
        if self.law.OF_I1_ALONE:
            s = slopes(motion.i1, motion.j, motion.y_squared, 1.0, self.constants)
        else:
            nothing = laws.Plane(*np.zeros((5, *np.shape(motion.j))))
            s = completed(nothing, motion.j, motion.y_squared, self.constants)
        return Slopes(*(np.reshape(part, np.shape(part) + (1,) * axes) for part in s))


def diagonal(stretches) -> np.ndarray:
    """Return deformation gradients (..., 3, 3) of principal stretches (..., 3)."""
    return np.asarray(stretches)[..., :, None] * np.eye(3)

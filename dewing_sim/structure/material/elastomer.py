# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Dielectric elastomer: Gent + volumetric + electrostatic energy, its stresses and moduli.

Energy per unit volume of unstretched material at a given voltage (Buoso and Palacios,
IFASD-2015-072, section 2; Gent, doi 10.5254/1.3538357), for the deformation gradient F and the
nominal field E0 (the field times the stretch along it):

    W = -(mu Jm / 2) log(1 - (I1bar - 3) / Jm) + K (J - 1)^2 - (eps / 2) Y^2 / J,
    I1bar = J^(-2/3) tr(F^T F),   J = det F,   Y = cof(F) E0,

where Y^2 / J = J E^2 with the true field E = F^-T E0, so that dW/dF contains the Maxwell stress.
W depends on the motion through I1 = tr(F^T F), J and Y^2 only: `slopes` differentiates it by these
three, `stress` and `modulus` carry the result to any coordinates. The full tensors here, the
principal stretches of a `sheet.Sheet` and the solid element use the same three functions, plain
in Python and compiled inside compiled code. Any consistent system of units.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.machine.kernels import formula

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
def energy(i1, j, y_squared, mu, jm, bulk, eps):
    """Return W."""
    room = 1.0 - (i1 * j ** (-2.0 / 3.0) - 3.0) / jm
    return -0.5 * mu * jm * np.log(room) + bulk * (j - 1.0) ** 2 - 0.5 * eps * y_squared / j


@formula
def gent(i1bar, mu, jm):
    """Return the first and second derivative of the Gent energy in I1bar."""
    room = jm - (i1bar - 3.0)
    first = 0.5 * mu * jm / room
    return first, first / room


@formula
def slopes(i1, j, y_squared, mu, jm, bulk, eps):
    """Return the factors of the derivatives of W at I1, J and Y^2."""
    scale = np.exp(np.log(j) / -1.5)        # twice as fast as a power
    g1, g2 = gent(scale * i1, mu, jm)
    specific = 1.0 / j
    h = scale * i1 * specific / 1.5
    electric = eps * specific * specific
    return Slopes(
        2.0 * scale * g1,
        2.0 * bulk * (j - 1.0) - h * g1 + 0.5 * electric * y_squared,
        -eps * specific,
        4.0 * scale * scale * g2,
        -2.0 * scale * (h * g2 + g1 * specific / 1.5),
        h * h * g2 + h * g1 * specific / 0.6 + 2.0 * bulk - electric * y_squared * specific,
        electric)


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


@formula
def deviatoric_stress(c11, c22, c12, c33, mu, jm):
    """Return S_11, S_22, S_12 (second Piola-Kirchhoff) of the Gent energy.

    ``c11`` to ``c33`` are those of F^T F, of which the third axis is a principal one.
    """
    plane = c11 * c22 - c12 * c12
    i1 = c11 + c22 + c33
    scale = np.exp(np.log(plane * c33) / -3.0)
    first, _ = gent(scale * i1, mu, jm)
    factor, part = 2.0 * scale * first, i1 / (3.0 * plane)
    return factor * (1.0 - part * c22), factor * (1.0 - part * c11), factor * part * c12


_LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    _LEVI_CIVITA[_i, _j, _k], _LEVI_CIVITA[_i, _k, _j] = 1.0, -1.0


def _cofactor(gradient: np.ndarray) -> np.ndarray:
    """Return dJ/dF, (..., 3, 3)."""
    return 0.5 * np.einsum('iab,jcd,...ac,...bd->...ij', _LEVI_CIVITA, _LEVI_CIVITA,
                           gradient, gradient, optimize=True)


def _cofactor_slope(gradient: np.ndarray) -> np.ndarray:
    """Return d2J/dF dF, (..., 3, 3, 3, 3)."""
    return np.einsum('ika,jlb,...ab->...ijkl', _LEVI_CIVITA, _LEVI_CIVITA, gradient,
                     optimize=True)


class _Motion(NamedTuple):
    """I1, J and Y^2 of deformation gradients with their (half) derivatives by F."""

    i1: np.ndarray
    j: np.ndarray
    y_squared: np.ndarray
    f: np.ndarray           # (..., 3, 3), F itself
    c: np.ndarray           # cof F
    y: np.ndarray
    c_both: np.ndarray      # (..., 3, 3, 3, 3)
    y_both: np.ndarray


def _motion(gradient, field) -> _Motion:
    gradient, field = np.asarray(gradient), np.asarray(field)
    cofactor = _cofactor(gradient)
    c_both = _cofactor_slope(gradient)
    electric = np.einsum('...ij,...j->...i', cofactor, field)
    slope = np.einsum('...ijkl,...j->...ikl', c_both, field)        # dY_i / dF_kl
    # Y is quadratic in F: its second derivative is that of the cofactor, a constant.
    bend = np.einsum('ikm,jln,...j,...i->...klmn', _LEVI_CIVITA, _LEVI_CIVITA, field, electric,
                     optimize=True)
    return _Motion(
        np.einsum('...ij,...ij->...', gradient, gradient),
        np.einsum('...ij,...ij->...', gradient, cofactor) / 3.0,
        np.einsum('...i,...i->...', electric, electric),
        gradient, cofactor, np.einsum('...i,...ikl->...kl', electric, slope), c_both,
        np.einsum('...ikl,...imn->...klmn', slope, slope) + bend)


@dataclass(frozen=True)
class Elastomer:
    """Shear modulus mu, Gent limit Jm, bulk modulus K of K (J-1)^2, permittivity eps.

    Methods take deformation gradients F (..., 3, 3) and nominal fields E0 (..., 3), any leading
    shape: integration points are vectorised.
    """

    shear_modulus: float
    gent_limit: float
    bulk_modulus: float
    permittivity: float

    @property
    def constants(self) -> tuple[float, float, float, float]:
        """(mu, Jm, K, eps), the order in which the kernels take them."""
        return self.shear_modulus, self.gent_limit, self.bulk_modulus, self.permittivity

    def energy(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return W, (...)."""
        motion = _motion(gradient, field)
        return energy(motion.i1, motion.j, motion.y_squared, *self.constants)

    def first_piola(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return P = dW/dF, (..., 3, 3)."""
        motion = _motion(gradient, field)
        s = self._slopes(motion, 2)
        return stress(s, motion.f, motion.c, motion.y)

    def tangent(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return dP/dF, (..., 3, 3, 3, 3)."""
        motion = _motion(gradient, field)
        first = [part[..., :, :, None, None] for part in (motion.f, motion.c, motion.y)]
        other = [part[..., None, None, :, :] for part in (motion.f, motion.c, motion.y)]
        identity = np.einsum('ik,jl->ijkl', np.eye(3), np.eye(3))
        return modulus(self._slopes(motion, 4), *first, *other, identity,
                       motion.c_both, motion.y_both)

    def kirchhoff_stress(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return tau = P F^T, (..., 3, 3)."""
        return np.einsum('...ij,...kj->...ik', self.first_piola(gradient, field), gradient)

    def cauchy_stress(self, gradient, field=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Return sigma = tau / J with the Maxwell stress included, (..., 3, 3)."""
        volume = np.linalg.det(gradient)[..., None, None]
        return self.kirchhoff_stress(gradient, field) / volume

    def _slopes(self, motion: _Motion, axes: int) -> Slopes:
        """Return the slopes with ``axes`` trailing axes of length one."""
        s = slopes(motion.i1, motion.j, motion.y_squared, *self.constants)
        return Slopes(*(np.reshape(part, np.shape(part) + (1,) * axes) for part in s))


def diagonal(stretches) -> np.ndarray:
    """Return deformation gradients (..., 3, 3) of principal stretches (..., 3)."""
    return np.asarray(stretches)[..., :, None] * np.eye(3)

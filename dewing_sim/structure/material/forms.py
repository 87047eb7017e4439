# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Forms of laws: from derivatives by invariants, or from exponents, to the plane of the strip.

With s = J^(-2/3), d = J / lambda_z and I2 = d^2 + lambda_z^2 (I1 - lambda_z^2), the isochoric
invariants are I1bar = s I1 and I2bar = s^2 I2 (the sum of the squared inverse stretches).
"""

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from dewing_sim.machine.kernels import formula
from dewing_sim.structure.material.law import Compiled, Law, Plane
from dewing_sim.structure.material.powers import power_sum


class FirstInvariantLaw(Law):
    """W(I1bar).

    ``density(i1, k)`` returns W at I1bar, ``derivatives(i1, k)`` its first and second
    derivative; ``k`` has the constants by name. Both are static.
    """

    OF_I1_ALONE = TAKES_ARRAYS = True
    density: ClassVar[Callable]
    derivatives: ClassVar[Callable]

    @classmethod
    def compile(cls) -> Compiled:
        """See `Law`."""
        density, derivatives = formula(cls.density), formula(cls.derivatives)

        def energy(i1, j, lateral, k):
            return density(i1 * j ** (-2.0 / 3.0), k)

        def slopes(i1, j, lateral, k):
            scale = np.exp(np.log(j) / -1.5)        # twice as fast as a power
            g1, g2 = derivatives(scale * i1, k)
            specific = 1.0 / j
            h = scale * i1 * specific / 1.5
            return Plane(2.0 * scale * g1, -h * g1, 4.0 * scale * scale * g2,
                         -2.0 * scale * (h * g2 + g1 * specific / 1.5),
                         h * h * g2 + h * g1 * specific / 0.6)

        def deviatoric(c11, c22, c12, c33, k):
            plane = c11 * c22 - c12 * c12
            i1 = c11 + c22 + c33
            scale = np.exp(np.log(plane * c33) / -3.0)
            first, _ = derivatives(scale * i1, k)
            factor, part = 2.0 * scale * first, i1 / (3.0 * plane)
            return factor * (1.0 - part * c22), factor * (1.0 - part * c11), factor * part * c12
        return Compiled(formula(energy), formula(slopes), formula(deviatoric))


class InvariantLaw(Law):
    """W(I1bar, I2bar).

    ``density(i1, i2, k)`` returns W, ``derivatives(i1, i2, k)`` returns W_1, W_2, W_11, W_12,
    W_22; ``k`` has the constants by name. Both are static.
    """

    TAKES_ARRAYS = True
    density: ClassVar[Callable]
    derivatives: ClassVar[Callable]

    @classmethod
    def compile(cls) -> Compiled:
        """See `Law`."""
        density, derivatives = formula(cls.density), formula(cls.derivatives)

        def energy(i1, j, lateral, k):
            square = lateral * lateral
            scale = np.exp(np.log(j) / -1.5)
            i2 = j * j / square + square * (i1 - square)
            return density(scale * i1, scale * scale * i2, k)

        def slopes(i1, j, lateral, k):
            square, per = lateral * lateral, 1.0 / j
            s = np.exp(np.log(j) / -1.5)
            s2 = s * s
            i2 = j * j / square + square * (i1 - square)
            w1, w2, w11, w12, w22 = derivatives(s * i1, s2 * i2, k)
            # Derivatives of I1bar (p) and I2bar (q) by I1 and J; those by I1 are linear.
            p_j, q_i = -s * i1 * per / 1.5, s2 * square
            q_j = s2 * (2.0 * j / square - i2 * per / 0.75)
            p_ij, p_jj = -s * per / 1.5, s * i1 * per * per / 0.9
            q_ij = -q_i * per / 0.75
            q_jj = s2 * (28.0 / 9.0 * i2 * per * per - 10.0 / 3.0 / square)
            return Plane(
                2.0 * (w1 * s + w2 * q_i), w1 * p_j + w2 * q_j,
                4.0 * (w11 * s * s + 2.0 * w12 * s * q_i + w22 * q_i * q_i),
                2.0 * (w1 * p_ij + w2 * q_ij + w11 * s * p_j + w12 * (s * q_j + q_i * p_j)
                       + w22 * q_i * q_j),
                w1 * p_jj + w2 * q_jj + w11 * p_j * p_j + 2.0 * w12 * p_j * q_j
                + w22 * q_j * q_j)
        return _with_deviatoric(energy, slopes)


class StretchLaw(Law):
    """W = sum_p mu_p / alpha_p (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3), isochoric l_i.

    ``terms(k)``, static, returns a tuple of pairs (mu_p, alpha_p); mu_p = 0 leaves a term out.
    """

    terms: ClassVar[Callable]

    @classmethod
    def compile(cls) -> Compiled:
        """See `Law`."""
        terms = formula(cls.terms)

        def energy(i1, j, lateral, k):
            total = 0.0
            for mu, alpha in terms(k):
                if mu != 0.0:
                    total += power_sum(i1, j, lateral, mu, alpha)[0]
            return total

        def slopes(i1, j, lateral, k):
            f, c, ff, fc, cc = 0.0, 0.0, 0.0, 0.0, 0.0
            for mu, alpha in terms(k):
                if mu != 0.0:
                    part = power_sum(i1, j, lateral, mu, alpha)
                    f, c, ff = f + part[1], c + part[2], ff + part[3]
                    fc, cc = fc + part[4], cc + part[5]
            return Plane(f, c, ff, fc, cc)
        return _with_deviatoric(energy, slopes)


def _with_deviatoric(energy: Callable, slopes: Callable) -> Compiled:
    """Return the functions with S = f 1 + c J C^-1 in the plane."""
    energy, slopes = formula(energy), formula(slopes)

    def deviatoric(c11, c22, c12, c33, k):
        plane = c11 * c22 - c12 * c12
        volume = np.sqrt(plane * c33)
        s = slopes(c11 + c22 + c33, volume, np.sqrt(c33), k)
        part = s.c * volume / plane
        return s.f + part * c22, s.f + part * c11, -part * c12
    return Compiled(energy, slopes, formula(deviatoric))

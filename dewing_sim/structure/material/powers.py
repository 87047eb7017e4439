# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Sums of powers of the principal stretches without the stretches, exact where two are equal.

The stretches in the plane have the product d = J / lambda_z and half the sum of squares
u d, u = (I1 - lambda_z^2) / (2 d) >= 1. Written as sqrt(d) e^(+-x) with cosh(2 x) = u,

    l_1^alpha + l_2^alpha = 2 d^nu cosh(alpha x) = 2 d^nu T_nu(u),   nu = alpha / 2,

with Chebyshev's function T_nu of any real order. It is analytic at u = 1, equal stretches, where
formulas with the stretches divide by their difference: from the equation
(1 - u^2) T'' - u T' + nu^2 T = 0 follows (Abramowitz and Stegun, 22.5 and 15.1)

    T_nu(1 + w) = sum_n c_n w^n,   c_0 = 1,   c_(n+1) = c_n (nu^2 - n^2) / ((n + 1) (2 n + 1)).
"""

import math

from dewing_sim.machine.kernels import formula

SERIES = 0.1        # of w: beyond, closed forms lose no more than two digits in T''
TERMS = 60


@formula
def chebyshev(nu, u):
    """Return T_nu(u), its first and second derivative for u >= 1 (up to rounding)."""
    w, square = u - 1.0, nu * nu
    if w > SERIES:
        y = math.log(u + math.sqrt(w * (u + 1.0)))
        value = math.cosh(nu * y)
        first = nu * math.sinh(nu * y) / math.sqrt(w * (u + 1.0))
        return value, first, (square * value - u * first) / (w * (u + 1.0))
    value, first, second = 1.0 + square * w, square, 0.0
    factor, power = square, 1.0             # c_n and w^(n - 1)
    for n in range(1, TERMS):
        factor *= (square - n * n) / ((n + 1.0) * (2.0 * n + 1.0))
        last = factor * (n + 1.0) * n * power
        second += last
        first += factor * (n + 1.0) * power * w
        value += factor * power * w * w
        if abs(last) <= 1.0e-17 * abs(second):
            break
        power *= w
    return value, first, second


@formula
def power_sum(i1, j, lateral, mu, alpha):
    """Return a term of `forms.StretchLaw` and its derivatives f, c, ff, fc, cc, see `law.Plane`.

    The isochoric sum is A(J) T_nu(u) + B(J) with A = 2 J^(alpha/6) lambda_z^(-nu) and
    B = J^(-alpha/3) lambda_z^alpha.
    """
    nu, per = 0.5 * alpha, 1.0 / j
    u_i = 0.5 * lateral * per
    u = u_i * (i1 - lateral * lateral)
    t, t1, t2 = chebyshev(nu, u)
    size, k, m = math.log(j), alpha / 6.0, alpha / 3.0
    a = 2.0 * math.exp(k * size - nu * math.log(lateral))
    b = math.exp(alpha * math.log(lateral) - m * size)
    factor = mu / alpha
    return (factor * (a * t + b - 3.0),
            2.0 * factor * a * t1 * u_i,
            factor * per * (k * a * t - a * t1 * u - m * b),
            4.0 * factor * a * t2 * u_i * u_i,
            2.0 * factor * u_i * per * a * ((k - 1.0) * t1 - t2 * u),
            factor * per * per * (k * (k - 1.0) * a * t + (2.0 - 2.0 * k) * a * t1 * u
                                  + a * t2 * u * u + m * (m + 1.0) * b))

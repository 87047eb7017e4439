# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Roots of functions of one variable.

`scipy.optimize` holds the same method, but to import it takes longer than to import numba.
"""

import math
from typing import Callable

LEAST_STEP = 2.0e-12
ROUNDING = 4.0 * 2.0 ** -52
MOST_STEPS = 100


def bracketed(function: Callable[[float], float], low: float, high: float,
              xtol: float = LEAST_STEP) -> float:
    """Return a root of ``function`` between ``low`` and ``high``, by Brent's method.

    R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4: the secant or
    the inverse quadratic through the last three points where that is short, else a bisection.
    Every operation is that of `scipy.optimize.brentq`, and so is every bit of the result. The
    root is within ``xtol`` and four units of rounding.

    Raises `ValueError` if the function has one sign at both ends, `ArithmeticError` if it is NaN
    somewhere or the method takes too many steps, as it may at a multiple root.
    """
    before, here, across = float(low), float(high), 0.0
    f_before, f_here, f_across = float(function(before)), float(function(here)), 0.0
    if f_before == 0.0:
        return before
    if f_here == 0.0:
        return here
    if not _apart(f_before, f_here):
        raise ValueError(f'the function has one sign at {low:g} and at {high:g}')
    last = move = 0.0
    for _ in range(MOST_STEPS):
        if f_before != 0.0 and _apart(f_before, f_here):
            across, f_across = before, f_before
            last = move = here - before
        if abs(f_across) < abs(f_here):
            before, here, across = here, across, here
            f_before, f_here, f_across = f_here, f_across, f_here
        least = 0.5 * (xtol + ROUNDING * abs(here))
        middle = 0.5 * (across - here)
        if f_here == 0.0 or abs(middle) < least:
            return here
        guess = math.inf
        if abs(last) > least and abs(f_here) < abs(f_before):
            guess = _guess((before, f_before), (here, f_here), (across, f_across))
        if 2.0 * abs(guess) < min(abs(last), 3.0 * abs(middle) - least):
            last, move = move, guess
        else:
            last = move = middle
        before, f_before = here, f_here
        here += move if abs(move) > least else math.copysign(least, middle)
        f_here = float(function(here))
        if math.isnan(f_here):
            raise ArithmeticError(f'the function is NaN at {here:g}')
    raise ArithmeticError(f'no root found between {low:g} and {high:g} in {MOST_STEPS} steps')


def _apart(a: float, b: float) -> bool:
    return math.copysign(1.0, a) != math.copysign(1.0, b)


def _guess(before: tuple, here: tuple, across: tuple) -> float:
    """Return the step from ``here`` to where the curve through the points (x, f) is zero."""
    (x0, f0), (x1, f1), (x2, f2) = before, here, across
    if x0 == x2:
        return -f1 * (x1 - x0) / (f1 - f0)
    slope0 = (f0 - f1) / (x0 - x1)
    slope2 = (f2 - f1) / (x2 - x1)
    below = slope2 * slope0 * (f2 - f0)
    return -f1 * (f2 * slope2 - f0 * slope0) / below if below else math.inf

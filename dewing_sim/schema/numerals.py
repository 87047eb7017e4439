# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers in sentences: short, but with enough digits to say what is meant."""

SHORT, EXACT = 6, 17        # significant digits: at least, and those that give a float back


def apart(value: float, bound: float, short: int = SHORT) -> tuple[str, str]:
    """Return both numbers, with more than ``short`` digits if they need them to differ."""
    for digits in range(short, EXACT + 1):
        first, second = f'{value:.{digits}g}', f'{bound:.{digits}g}'
        if first != second:
            break
    return first, second


def not_above(bound: float) -> str:
    """Return ``bound`` with as many digits as it takes not to be rounded up."""
    return next(text for text in _rounded(bound) if float(text) <= bound)


def not_below(bound: float) -> str:
    """Return ``bound`` with as many digits as it takes not to be rounded down."""
    return next(text for text in _rounded(bound) if float(text) >= bound)


def _rounded(bound: float):
    return (f'{bound:.{digits}g}' for digits in range(SHORT, EXACT + 1))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Roots are those of scipy, bit for bit."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from dewing_sim.roots import bracketed

FUNCTIONS = [lambda x, r: x ** 3 + x - r ** 3 - r, lambda x, r: math.atan(30.0 * (x - r)),
             lambda x, r: math.exp(x) - math.exp(r), lambda x, r: 1.0 if x > r else -1.0]


@given(st.sampled_from(FUNCTIONS), st.floats(-0.9, 0.9), st.sampled_from([2e-12, 1e-15, 1e-3]),
       st.booleans())
def test_roots_are_those_of_scipy(function, root, xtol, turned):
    ends = (1.0, -1.1) if turned else (-1.1, 1.0)
    calls = []

    def watched(x):
        calls.append(x)
        return function(x, root)
    found = bracketed(watched, *ends, xtol)
    mine, calls = calls, []
    assert found == brentq(watched, *ends, xtol=xtol)
    assert mine == calls


def test_a_root_at_an_end_is_taken():
    assert bracketed(lambda x: x - 2.0, 2.0, 3.0) == 2.0
    assert bracketed(lambda x: x - 3.0, 2.0, 3.0) == 3.0


def test_one_sign_nan_and_slow_roots_are_refused():
    with pytest.raises(ValueError, match='one sign at 1 and at 2'):
        bracketed(lambda x: x, 1.0, 2.0)
    with pytest.raises(ArithmeticError, match='in 100 steps'):
        bracketed(lambda x: x ** 3, -1.1, 1.0)          # as scipy does
    with pytest.raises(ArithmeticError, match='NaN at 0'):
        bracketed(lambda x: x if abs(x) == 1.0 else math.nan, -1.0, 1.0)

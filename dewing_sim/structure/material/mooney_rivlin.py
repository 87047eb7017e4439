# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Mooney and Rivlin's law (doi 10.1063/1.1712836, 10.1098/rsta.1948.0024), of both invariants."""

from dataclasses import dataclass

from dewing_sim.schema import real
from dewing_sim.structure.material.forms import InvariantLaw


def density(i1, i2, k):
    """Return W at I1bar, I2bar."""
    return k.c10 * (i1 - 3.0) + k.c01 * (i2 - 3.0)


def derivatives(i1, i2, k):
    """Return W_1, W_2, W_11, W_12, W_22."""
    return k.c10, k.c01, 0.0, 0.0, 0.0


@dataclass(frozen=True)
class MooneyRivlin(InvariantLaw):
    """W = C10 (I1bar - 3) + C01 (I2bar - 3), which never locks up; mu = 2 (C10 + C01)."""

    TITLE = 'Mooney-Rivlin'
    density = staticmethod(density)
    derivatives = staticmethod(derivatives)

    c10: float = real('Pa', 'C10 of I1bar - 3', -1.0e8, 1.0e8)
    c01: float = real('Pa', 'C01 of I2bar - 3', -1.0e8, 1.0e8, default=0.0)

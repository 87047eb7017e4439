# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Gent's law: rubber whose chains have a greatest length (doi 10.5254/1.3538357)."""

from dataclasses import dataclass

import numpy as np

from dewing_sim.schema import real
from dewing_sim.structure.material.forms import FirstInvariantLaw


def density(i1, k):
    """Return W at I1bar."""
    room = 1.0 - (i1 - 3.0) / k.gent_limit
    return -0.5 * k.shear_modulus * k.gent_limit * np.log(room)


def derivatives(i1, k):
    """Return the first and second derivative of W by I1bar."""
    room = k.gent_limit - (i1 - 3.0)
    first = 0.5 * k.shear_modulus * k.gent_limit / room
    return first, first / room


@dataclass(frozen=True)
class Gent(FirstInvariantLaw):
    """W = -(mu Jm / 2) log(1 - (I1bar - 3) / Jm), which locks up where I1bar - 3 reaches Jm."""

    TITLE = 'Gent'
    density = staticmethod(density)
    derivatives = staticmethod(derivatives)

    shear_modulus: float = real('Pa', 'Gent shear modulus mu', 1.0e2, 1.0e8)
    gent_limit: float = real('-', 'Gent limit Jm of I1 - 3', 1.0, 1.0e6)

    def overrun(self, i1: float, i2: float) -> float:
        """Return I1bar - 3 less Jm."""
        return i1 - 3.0 - self.gent_limit

    @property
    def limit(self) -> str:
        """Name Jm."""
        return f'I1bar - 3 reaches the Gent limit {self.gent_limit:.6g}'

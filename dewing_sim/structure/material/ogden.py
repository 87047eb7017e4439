# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Ogden's law of up to three terms (doi 10.1098/rspa.1972.0026), of the principal stretches."""

from dataclasses import dataclass

from dewing_sim.errors import BadInput
from dewing_sim.schema import real
from dewing_sim.structure.material.forms import StretchLaw

LARGEST = 50.0      # of the exponents


def terms(k):
    """Return the pairs mu_p, alpha_p."""
    return (k.mu_1, k.alpha_1), (k.mu_2, k.alpha_2), (k.mu_3, k.alpha_3)


@dataclass(frozen=True)
class Ogden(StretchLaw):
    """W = sum mu_p / alpha_p (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3), isochoric stretches.

    The initial shear modulus is mu = sum mu_p alpha_p / 2. Each mu_p has the sign of its alpha_p
    in a law that is stable everywhere; other signs are admitted as long as mu is positive.
    """

    TITLE = 'Ogden'
    terms = staticmethod(terms)

    mu_1: float = real('Pa', 'mu_1', -1.0e8, 1.0e8)
    alpha_1: float = real('-', 'alpha_1', -LARGEST, LARGEST)
    mu_2: float = real('Pa', 'mu_2, 0: no such term', -1.0e8, 1.0e8, default=0.0)
    alpha_2: float = real('-', 'alpha_2', -LARGEST, LARGEST, default=2.0)
    mu_3: float = real('Pa', 'mu_3, 0: no such term', -1.0e8, 1.0e8, default=0.0)
    alpha_3: float = real('-', 'alpha_3', -LARGEST, LARGEST, default=2.0)

    def __post_init__(self):
        """Raise `BadInput` for an exponent of zero or an unstable law."""
        for p, (mu, alpha) in enumerate(terms(self), start=1):
            if mu != 0.0 and alpha == 0.0:
                raise BadInput(f'alpha_{p} = 0 of Ogden is out of range: any other number')
        super().__post_init__()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A material of your own: Yeoh's law (doi 10.5254/1.3538343) in one file, flown beside Gent's.

In a case it is ``law: own_material:Yeoh`` with its constants below ``membrane: constants:``.
"""

from dataclasses import dataclass

from dewing_sim import parameters
from dewing_sim.schema import real
from dewing_sim.structure.material.forms import FirstInvariantLaw
from dewing_sim.wing import Wing


def density(i1, k):
    """Return W at I1bar, J/m^3."""
    x = i1 - 3.0
    return k.c1 * x + k.c2 * x**2 + k.c3 * x**3


def derivatives(i1, k):
    """Return the first and second derivative of W by I1bar."""
    x = i1 - 3.0
    return k.c1 + 2.0 * k.c2 * x + 3.0 * k.c3 * x**2, 2.0 * k.c2 + 6.0 * k.c3 * x


@dataclass(frozen=True)
class Yeoh(FirstInvariantLaw):
    """W = c1 x + c2 x^2 + c3 x^3 with x = I1bar - 3; its shear modulus at rest is 2 c1."""

    TITLE = 'Yeoh'
    density = staticmethod(density)
    derivatives = staticmethod(derivatives)

    c1: float = real('Pa', 'c1 of x', 1.0, 1.0e8)
    c2: float = real('Pa', 'c2 of x^2', -1.0e8, 1.0e8)
    c3: float = real('Pa', 'c3 of x^3', 0.0, 1.0e8)


COARSE = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
          'numerics.time_step': 5.0e-4}
CONSTANTS = {'c1': 1.0e4, 'c2': 2.0e3, 'c3': 20.0}      # Pa; Gent's mu is 2 c1

if __name__ == '__main__':
    wings = {'gent': Wing(parameters.load('paper', changes=COARSE)),
             'yeoh': Wing(parameters.load('paper', changes=COARSE | {
                 'membrane.law': 'own_material:Yeoh', 'membrane.constants': CONSTANTS}))}
    rest = {name: wing.observe(wing.rest()) for name, wing in wings.items()}
    for name, outputs in rest.items():
        print(f'{name}: tension {outputs.tension:.3f} N/m, camber {1e6 * outputs.camber_max:.1f} '
              f'um, slack at {wings[name].v_squared_slack**0.5:.0f} V')

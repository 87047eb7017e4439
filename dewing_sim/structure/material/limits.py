# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How far a dielectric elastomer can go: voltage-stretch curves, pull-in, locking, breakdown.

The curves are followed in the stretch, which passes the voltage's maxima. At a maximum the
thickness pulls in under constant voltage; the sheet snaps to the branch beyond, if the Gent limit
makes the voltage rise again (Zhao and Suo, doi 10.1063/1.2768641).
"""

from typing import Callable, NamedTuple

import numpy as np
from scipy.optimize import brentq

from dewing_sim.errors import BadInput
from dewing_sim.structure.material.elastomer import Elastomer, diagonal

TRACE = 4000            # points of a voltage-stretch curve
NEARLY = 1.0 - 1.0e-6   # of the stretch at which the Gent limit locks


class PullIn(NamedTuple):
    """Stretch and nominal field V/H where the thickness pulls in, and where it snaps to."""

    stretch: float
    field: float
    snapped_stretch: float      # not a number if nothing holds the sheet before it locks


def equibiaxial_field(elastomer: Elastomer, stretch, load: float = 0.0) -> np.ndarray:
    """Return the nominal field V/H that holds free sheets at equal in-plane stretches (n,).

    The sheet is incompressible; ``load`` is the dead nominal stress of its edges in both
    directions. Not a number where no field could.
    """
    stretch = np.asarray(stretch, dtype=float)
    thickness = stretch ** -2
    stress = elastomer.cauchy_stress(diagonal(np.stack([stretch, stretch, thickness], axis=-1)))
    # sigma_1 - sigma_3 = load stretch + eps E^2, with E = (V / H) / thickness stretch.
    square = (stress[..., 0, 0] - stress[..., 2, 2] - load * stretch) / elastomer.permittivity
    return np.sqrt(np.where(square >= 0.0, square, np.nan)) * thickness


def locking_stretch(elastomer: Elastomer, i1: Callable[[float], float]) -> float:
    """Return the stretch at which ``i1(stretch)`` = I1bar reaches the Gent limit."""
    return brentq(lambda stretch: i1(stretch) - 3.0 - elastomer.gent_limit, 1.0, 1.0e6)


def equibiaxial_pull_in(elastomer: Elastomer, load: float = 0.0) -> PullIn:
    """Return the first pull-in of a free sheet under a dead load, see `equibiaxial_field`.

    Raises `BadInput` if its voltage rises all the way to the Gent limit.
    """
    end = NEARLY * locking_stretch(elastomer, lambda s: 2.0 * s * s + s ** -4)
    start = _passive_stretch(elastomer, load, end)
    stretch = np.geomspace(start, end, TRACE)
    field = equibiaxial_field(elastomer, stretch, load)
    falling = np.flatnonzero(np.diff(field) < 0.0)
    if not falling.size:
        raise BadInput(f'no pull-in: the voltage rises up to the Gent limit '
                       f'{elastomer.gent_limit:g} at stretch {end:.4g}')
    k = max(int(falling[0]), 1)
    peak = _maximum(lambda s: float(equibiaxial_field(elastomer, s, load)),
                    stretch[k - 1], stretch[k + 1])
    height = float(equibiaxial_field(elastomer, peak, load))
    beyond = np.flatnonzero(field[k + 1:] > height)
    snapped = float(stretch[k + 1 + beyond[0]]) if beyond.size else np.nan
    return PullIn(peak, height, snapped)


def _passive_stretch(elastomer: Elastomer, load: float, end: float) -> float:
    """Return the stretch under the load alone."""
    def excess(stretch):
        stress = elastomer.cauchy_stress(diagonal((stretch, stretch, stretch ** -2)))
        return stress[0, 0] - stress[2, 2] - load * stretch
    return brentq(excess, 1.0, end, xtol=1e-14) if load > 0.0 else 1.0


def _maximum(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where ``function`` is largest, by golden sections to the accuracy of its slope."""
    def slope(stretch):
        step = 1.0e-6 * stretch
        return function(stretch + step) - function(stretch - step)
    return float(brentq(slope, low, high, xtol=1e-12))


def breakdown_warning(electric_field: float, threshold: float) -> str | None:
    """Return a sentence if the true field (V/m) is above ``threshold``, else None."""
    if electric_field <= threshold:
        return None
    return (f'a field of {electric_field / 1.0e6:.1f} MV/m in the membrane; above '
            f'{threshold / 1.0e6:g} MV/m the elastomer may break down')

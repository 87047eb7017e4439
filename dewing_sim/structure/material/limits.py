# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How far a dielectric elastomer can go: voltage-stretch curves, pull-in, locking, breakdown.

The curves are followed in the stretch, which passes the voltage's maxima. At a maximum the
thickness pulls in under constant voltage; the sheet snaps to the branch beyond, if the law
stiffens enough to make the voltage rise again (Zhao and Suo, doi 10.1063/1.2768641).
"""

import math
from collections.abc import Mapping
from typing import Callable, NamedTuple

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.roots import bracketed
from dewing_sim.schema.numerals import apart
from dewing_sim.structure.material.elastomer import Elastomer, diagonal
from dewing_sim.structure.material.law import Law

TRACE = 4000            # points of a voltage-stretch curve
NEARLY = 1.0 - 1.0e-6   # of the stretch at which the law locks up
FARTHEST = 8.0          # stretch to which a law is followed that never does


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


def equibiaxial(stretch: float) -> tuple[float, float]:
    """Return I1bar and I2bar of an incompressible sheet stretched alike both ways."""
    return 2.0 * stretch * stretch + stretch ** -4, 2.0 * stretch ** -2 + stretch ** 4


def plane_strain(stretch: float) -> tuple[float, float]:
    """Return I1bar and I2bar, which are equal, of a sheet held across the stretch."""
    return (stretch * stretch + stretch ** -2 + 1.0,) * 2


def locking_stretch(law: Law, invariants: Callable[[float], tuple[float, float]]) -> float:
    """Return the stretch at which the law locks up, infinite if it never does.

    ``invariants(stretch)`` are I1bar and I2bar.
    """
    def overrun(stretch):
        return law.overrun(*invariants(stretch))
    return bracketed(overrun, 1.0, 1.0e6) if overrun(1.0e6) > 0.0 else np.inf


def equibiaxial_pull_in(elastomer: Elastomer, load: float = 0.0) -> PullIn:
    """Return the first pull-in of a free sheet under a dead load, see `equibiaxial_field`.

    Raises `BadInput` if its voltage rises until the law locks up, or up to `FARTHEST`.
    """
    law = elastomer.law
    locking = locking_stretch(law, equibiaxial)
    end = NEARLY * locking if np.isfinite(locking) else FARTHEST
    start = _passive_stretch(elastomer, load, end)
    stretch = np.geomspace(start, end, TRACE)
    field = equibiaxial_field(elastomer, stretch, load)
    falling = np.flatnonzero(np.diff(field) < 0.0)
    if not falling.size:
        until = f'until {law.limit} at' if np.isfinite(locking) else 'up to'
        raise BadInput(f'no pull-in: the voltage rises {until} stretch {end:.4g}')
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
    return bracketed(excess, 1.0, end, xtol=1e-14) if load > 0.0 else 1.0


def _maximum(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where ``function`` is largest, by golden sections to the accuracy of its slope."""
    def slope(stretch):
        step = 1.0e-6 * stretch
        return function(stretch + step) - function(stretch - step)
    return float(bracketed(slope, low, high, xtol=1e-12))


def require_tension(prestretch: float, slack_voltage: float, voltages: Mapping[str, float],
                    margin: float = 0.0) -> None:
    """Raise `BadInput` unless a membrane that is slack from ``slack_voltage`` on (V) is taut.

    ``voltages`` (V) are those that it has to bear, by the names under which they are given; at
    all of them the share ``margin`` of V^2 at the loss of tension is to be left.
    """
    if slack_voltage == 0.0:
        raise BadInput(f'membrane.prestretch = {prestretch:g} leaves the flat membrane without '
                       'tension: raise it')
    largest = slack_voltage * math.sqrt(1.0 - margin)
    for name, value in voltages.items():
        if value >= slack_voltage:
            shown, least = apart(value, slack_voltage, 4)
            raise BadInput(f'{name} {shown} V is out of range: the membrane loses its tension '
                           f'at {least} V')
        if value > largest:
            shown, most = apart(value, largest, 4)
            raise BadInput(f'{name} {shown} V is out of range: at most {most} V with '
                           f'actuation.slack_margin = {margin:g}')


def breakdown_warning(electric_field: float, threshold: float) -> str | None:
    """Return a sentence if the true field (V/m) is above ``threshold``, else None."""
    if electric_field <= threshold:
        return None
    return (f'a field of {electric_field / 1.0e6:.1f} MV/m in the membrane; above '
            f'{threshold / 1.0e6:g} MV/m the elastomer may break down')

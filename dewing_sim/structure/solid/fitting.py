# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The length to which a strip is cut that hangs from pins at its lower side.

Its ends give way by some thicknesses under the tension, so it is cut shorter by that much: at rest
and without voltage its interior carries the prestretch, as a strip held in the middle does.
"""

from dataclasses import replace
from typing import TypeVar

import numpy as np

from dewing_sim.structure.base import Structure
from dewing_sim.structure.dynamics import statics
from dewing_sim.structure.solid.pins import LOWER
from dewing_sim.structure.solid.strip import nodal_mass

FITS = 10                   # of the reference length

Strip = TypeVar('Strip', bound=Structure)       # a `solid.Solid`


def fitted(solid: Strip, density: float) -> Strip:
    """Return a strip on lower pins, with the prestretch inside, from one held in the middle."""
    target = solid.rest_tension(0.0)
    slope = float(solid.sheet.respond([solid.prestretch], 0.0).stiffness[0]) * solid.prestretch
    hanging = _released(solid)
    for _ in range(FITS):
        tension = float(np.median(hanging.tension(hanging.rest_position, 0.0)))
        if abs(tension - target) <= 1.0e-9 * target:
            break
        hanging = _cut(hanging, (target - tension) / slope, density)
    return hanging


def _cut(hanging: Strip, shortening: float, density: float) -> Strip:
    """Return the strip at rest, its reference shorter by the part ``shortening``."""
    def shorter(share):
        length = hanging.length * (1.0 - share * shortening)
        return replace(hanging, length=length,
                       mass=nodal_mass(length, hanging.sheet, density))

    def snap(start, share):
        strip = shorter(share)
        return statics.newton(strip, statics.slide(strip, start, 0.0), 0.0)

    position = statics.march(lambda start, share: statics.newton(shorter(share), start, 0.0),
                             hanging.rest_position, snap=snap)
    return replace(shorter(1.0), rest_position=position)


def _released(solid: Strip) -> Strip:
    """Return the strip on lower pins, at rest: the reaction on the upper sides fades away."""
    lower = replace(solid, support=LOWER)
    position = statics.newton(solid, solid.rest_position, 0.0)
    reaction = np.zeros_like(position)
    reaction[[1, -1]] = lower.internal_force(position, 0.0)[[1, -1]]

    def snap(start, share):
        held = (1.0 - share) * reaction
        return statics.newton(lower, statics.slide(lower, start, 0.0, held=held), 0.0, held=held)

    position = statics.march(
        lambda start, share: statics.newton(lower, start, 0.0, held=(1.0 - share) * reaction),
        position, snap=snap)
    return replace(lower, rest_position=position - position[0])

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
        length = hanging.length * (1.0 - (target - tension) / slope)
        cut = replace(hanging, length=length, mass=nodal_mass(length, solid.sheet, density))
        hanging = replace(cut, rest_position=statics.newton(cut, hanging.rest_position, 0.0))
    return hanging


def _released(solid: Strip) -> Strip:
    """Return the strip on lower pins, at rest: the reaction on the upper sides fades away."""
    lower = replace(solid, support=LOWER)
    position = statics.newton(solid, solid.rest_position, 0.0)
    reaction = np.zeros_like(position)
    reaction[[1, -1]] = lower.internal_force(position, 0.0)[[1, -1]]
    position = statics.march(
        lambda start, share: statics.newton(lower, start, 0.0, held=(1.0 - share) * reaction),
        position)
    return replace(lower, rest_position=position - position[0])

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The choice of element: a 2-node membrane or solid elements behind the same methods."""

from dewing_sim import parameters
from dewing_sim.scales import Scales
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.sheet import SI
from dewing_sim.structure.solid.solid import Solid

ELEMENTS = {'membrane': Membrane, 'solid': Solid}


def make(section: parameters.Membrane, scales: Scales = SI) -> Membrane | Solid:
    """Return the structure of a parameter section in the units of ``scales``."""
    return ELEMENTS[section.element].from_parameters(section, scales)

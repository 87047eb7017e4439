# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The engine of a membrane wing: a case asks for one, or for `choice` by its expected camber."""

import math

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import RunFailed
from dewing_sim.fluid.base import INFLOWS, Demand
from dewing_sim.fluid.choice import AUTO, choose
from dewing_sim.fluid.plate import starting_circulation
from dewing_sim.parameters import Case
from dewing_sim.scales import Scales

PASSES = 3                  # camber makes lift makes camber


def settled(case: Case, membrane, scales: Scales, disturbed: bool) -> Case:
    """Return ``case`` with the engine that its own stands for."""
    engine, flow, numerics = case.numerics.engine, case.flow, case.numerics
    camber = expected_camber(case, membrane) if engine == AUTO else 0.0
    chosen = choose(engine, Demand(numerics.grid, camber, scales.reynolds, flow.angle_of_attack,
                                   numerics.time_step / scales.time,
                                   INFLOWS if disturbed else frozenset()))
    return case if chosen == engine else parameters.replace(case, {'numerics.engine': chosen})


def expected_camber(case: Case, membrane) -> float:
    """Return the camber (chords) at the largest voltage under the lift of thin aerofoils.

    It is that of the mirror image too: the camber has the sign of the lift that makes it.
    """
    camber = 0.0
    for _ in range(PASSES):
        jump = starting_circulation(case.flow.angle_of_attack, camber)      # Cl / 2
        try:
            position = membrane.equilibrium(jump, case.actuation.voltage_limit**2)
        except RunFailed:
            return math.inf
        camber = math.copysign(float(np.ptp(membrane.surface(position)[:, 1])), jump)
    return abs(camber)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A wing upside down in a stream upside down has the same loads, those across it reversed."""

import numpy as np
import pytest

from dewing_sim.fluid.conformal.engine import Conformal
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.presets import PRESETS
from dewing_sim.fluid.finite_volume.engine import FiniteVolume
from dewing_sim.fluid.finite_volume.grid import build
from dewing_sim.fluid.finite_volume.presets import Spacing
from dewing_sim.verification.fluid.rigid_flow import march, parabola

COARSE = Spacing(0.02, 0.02, 0.08, 0.015, 0.2, 0.2, 0.4, 0.2, 0.4, extent=20.0)
ENGINES = {
    'finite_volume': lambda alpha: FiniteVolume(build(COARSE), 2500.0, alpha, 0.02),
    'conformal': lambda alpha: Conformal(Grid.build(PRESETS['realtime']), 2500.0, alpha, 0.02),
}
STEPS = 10


def flown(engine: str, degrees: float, camber: float):
    """Return the loads of a plate that bends from flat to ``camber`` and some steps after."""
    fluid = ENGINES[engine](np.radians(degrees))
    rate = camber / (STEPS * fluid.dt)
    sign = np.copysign(1.0, degrees) if degrees else np.copysign(1.0, camber)
    *_, (_, flow) = march(fluid, lambda time: parabola(fluid.columns, rate * time, rate),
                          STEPS * fluid.dt, 0.2 * sign)
    return fluid.loads(flow)


@pytest.mark.parametrize('degrees, camber', [(4.0, 0.05), (4.0, -0.05), (0.0, 0.05), (8.0, 0.0)])
@pytest.mark.parametrize('engine', ENGINES)
def test_loads_of_the_mirror_image_are_the_mirror_image_of_the_loads(engine, degrees, camber):
    here, there = flown(engine, degrees, camber), flown(engine, -degrees, -camber)
    scale = np.abs(here.jump).max()
    assert there.jump == pytest.approx(-here.jump, abs=1.0e-11 * scale)
    assert there.cl == pytest.approx(-here.cl, rel=1.0e-11)
    assert there.cm == pytest.approx(-here.cm, rel=1.0e-11, abs=1.0e-12)
    assert there.cd == pytest.approx(here.cd, rel=1.0e-11)

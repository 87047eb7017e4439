# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on a plant during one step."""

from typing import NamedTuple

from dewing_sim.fluid.inflow import Inflow


class Inputs(NamedTuple):
    """The inputs of one time step, held over it (zero-order hold).

    ``wall_pressure`` is a uniform pressure jump on the membrane as a fraction of the dynamic
    pressure q, positive if it presses the camber up; it acts on the structure only and is not
    counted as lift. ``inflow`` is the stream that the wing meets at the end of the step and the
    motion of its axes, dimensionless; None: what the plant meets by itself.
    """

    v_squared: float                    # V^2 commanded, never negative
    wall_pressure: float = 0.0
    inflow: Inflow | None = None

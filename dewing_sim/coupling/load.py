# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on the nodes of a structure in a flow."""

from dataclasses import dataclass

import numpy as np

from dewing_sim.coupling.transfer import ColumnLoad, nodal_load
from dewing_sim.fluid.base import Fluid
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.structure.base import Moving


@dataclass(frozen=True, eq=False)
class Load:
    """Nodal forces of a flow and of accelerated axes, affine in the nodal velocities."""

    structure: Moving
    flow: ColumnLoad
    inflow: Inflow | None = None

    @classmethod
    def of(cls, fluid: Fluid, structure: Moving, jump: np.ndarray, velocity: np.ndarray,
           inputs: Inputs) -> 'Load':
        """Return the load of a pressure jump (columns,) that acts at the wall ``velocity``.

        q is rho U^2 / 2, half the unit of pressure.
        """
        return cls(structure, ColumnLoad(fluid.columns, jump, velocity, fluid.impedance,
                                         0.5 * inputs.wall_pressure), inputs.inflow)

    def __call__(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return the nodal forces (nodes, 2) at these velocities."""
        force = self.structure.spread(nodal_load(
            self.flow, self.structure.surface(position), self.structure.surface(velocity)))
        if self.has_frame_acceleration:
            force -= self.structure.mass[:, None] * self.inflow.frame_acceleration(
                position, velocity)
        return force

    @property
    def has_frame_acceleration(self) -> bool:
        """Whether the axes are accelerated."""
        return self.inflow is not None and self.inflow.is_accelerated

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a flow on a map, and what a step has found short of the wall's final velocity."""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from dewing_sim.fluid.conformal.geometry.mapping import Map
from dewing_sim.fluid.conformal.geometry.wall import WallGeometry


@dataclass(frozen=True)
class FlowState:
    """Everything the next step depends on; arrays over the strip are (n, rows).

    What `reports` names only tells of the last step.
    """

    reports: ClassVar[tuple[str, ...]] = ('slip',)

    w: np.ndarray                   # vorticity in U / c
    q: np.ndarray                   # h^2 w
    psi: np.ndarray                 # psi' at the cell corners
    w_before: np.ndarray            # one step earlier
    q_before: np.ndarray
    psi_before: np.ndarray
    shape: np.ndarray               # the map, see `mapping.Map`
    edges: np.ndarray
    shape_before: np.ndarray
    edges_before: np.ndarray
    pressure: np.ndarray            # (n,) on the membrane, in rho U^2
    height: np.ndarray              # wall heights at the column faces
    velocity: np.ndarray            # wall velocities of the columns
    velocity_before: np.ndarray
    circulation: float              # of the wing and the wake within the grid, in U c
    incidence: float                # of the chord to the undisturbed stream, rad
    slip: float                     # largest that the last step shed, in U

    @property
    def past(self) -> tuple:
        """What `step.advance` takes of it: a `step.Past`."""
        return (self.w, self.w_before, self.q, self.q_before, self.psi, self.psi_before,
                self.circulation)

    @property
    def map(self) -> Map:
        """The present map."""
        return Map(self.shape, self.edges)

    @property
    def map_before(self) -> Map:
        """The map one step earlier."""
        return Map(self.shape_before, self.edges_before)


class Predicted(NamedTuple):
    """What `correct` needs of a step."""

    before: FlowState
    around: WallGeometry
    w: np.ndarray
    q: np.ndarray
    psi: np.ndarray
    pressure: np.ndarray
    circulation: float
    incidence: float
    slip: float

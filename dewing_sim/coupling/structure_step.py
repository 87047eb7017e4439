# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One time step of a structure as the flow sees it: walls that answer pressure jumps.

This is the general form, for every structure and load, around `structure.dynamics.step`. What is
compiled as a whole, `membrane_step`, does the same and leaves the rest to it.
"""

from typing import Protocol

import numpy as np

from dewing_sim.coupling import transfer
from dewing_sim.coupling.jump_history import extrapolated
from dewing_sim.coupling.membrane_iteration import iteration_of
from dewing_sim.coupling.transfer import Load
from dewing_sim.errors import RunFailed
from dewing_sim.fluid.base import Fluid, Prediction, Wall
from dewing_sim.inputs.base import Inputs
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator, Step

# Last correction of the membrane in chords, for a guess and in an iteration; the next is smaller.
FORESEEN, ACCURACY = 1.0e-5, 1.0e-8


class WallStep(Protocol):
    """A step of what bounds the flow, from a present motion on, under given inputs."""

    coasting: np.ndarray        # column velocities (columns,) of a step without acceleration

    def foresee(self, history: np.ndarray) -> Wall:
        """Return the wall under the jump that past ones (0 to 3, columns) foretell.

        It is only a guess, so it may fail; without a past, the wall goes on as it moves.
        """

    def answer(self, prediction: Prediction) -> Wall:
        """Return the wall under the load of a flow; raise what `structure.dynamics` raises."""

    def end(self) -> Motion:
        """Return the motion that ends at the last wall; raise `Slack` if it has no tension."""


class StructureStep:
    """The `WallStep` of any structure."""

    def __init__(self, fluid: Fluid, structure: Moving, operator: Operator, motion: Motion,
                 inputs: Inputs):
        """Prepare the step that follows ``motion``."""
        self._fluid, self._structure, self._motion, self._inputs = fluid, structure, motion, inputs
        present = structure.during(motion, operator.dt, inputs.v_squared)
        self._step = Step(present, motion, inputs.v_squared, operator,
                          iteration_of(present, motion, inputs.v_squared, operator))
        self.coasting = transfer.coasting_velocity(fluid.columns, *map(structure.surface, (
            motion.position, motion.velocity, motion.position_before, motion.velocity_before)))
        self._position = motion.predict(operator.dt)

    def foresee(self, history: np.ndarray) -> Wall:
        """Return the wall under the jump that past ones foretell."""
        if len(history):
            try:
                self._reach(extrapolated(history), self.coasting, FORESEEN)
            except RunFailed:
                pass            # the iterations will tell whether the step can be made
        return self._wall()

    def answer(self, prediction: Prediction) -> Wall:
        """Return the wall under the load of a flow."""
        self._reach(prediction.jump, prediction.wall.velocity, ACCURACY)
        return self._wall()

    def end(self) -> Motion:
        """Return the motion that ends at the last wall."""
        return self._step.end(self._position)

    def start_at(self, position: np.ndarray) -> None:
        """Go on from what another form of the step has reached."""
        self._position = position

    def _reach(self, jump: np.ndarray, velocity: np.ndarray, accuracy: float) -> None:
        load = Load.of(self._fluid, self._structure, jump, velocity, self._inputs)
        self._position = self._step.reach(load, self._position, accuracy)

    def _wall(self) -> Wall:
        return transfer.wall_of(self._fluid, self._structure, self._position,
                                self._motion.rate(self._position, self._step.dt))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where flow and membrane meet: the implicit coupling iteration.

Each iteration moves the flow's grid to the last known shape, predicts the flow up to its pressure
jump, an affine function of the wall velocity, and solves the membrane under that load: the added
mass is inside the structural solution, so that the iteration converges at any mass ratio.
"""

from dataclasses import dataclass

import numpy as np

from dewing_sim.coupling import transfer
from dewing_sim.coupling.membrane_iteration import iteration_of
from dewing_sim.coupling.transfer import Load
from dewing_sim.errors import NotConverged, RunFailed
from dewing_sim.fluid.base import Fluid, Prediction, Wall
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine.kernels import checked_kernel
from dewing_sim.state import State
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.motion import Motion
from dewing_sim.structure.dynamics.step import Operator, Step

FLAT = 1.0e-5       # chords; shapes flatter than this are compared with it
EXTRAPOLATION = tuple(map(np.array, (       # from one, two or three past values
    (1.0,), (2.0, -1.0), (3.0, -3.0, 1.0))))
# Last correction of the membrane in chords, for a guess and in an iteration; the next is smaller.
FORESEEN, ACCURACY = 1.0e-5, 1.0e-8


@dataclass(frozen=True, eq=False)
class Coupling:
    """Flow and structure advanced together, by the time step of ``operator``.

    Iterations end when the shape changes by less than ``tolerance`` of its largest deflection.
    """

    fluid: Fluid
    structure: Moving
    operator: Operator
    tolerance: float
    iterations: int

    def advance(self, now: State, inputs: Inputs) -> State:
        """Return the state one step later under ``inputs``.

        The first shape is that of the membrane under the pressure jump extrapolated from the
        jump history, without any by its own motion. Raises `NotConverged` after ``iterations``.
        """
        fluid, motion, step = self.fluid, now.motion, self._step(now.motion, inputs.v_squared)
        coasting = self._coasting_velocity(motion)
        position = self._foreseen(step, now, coasting, inputs)
        wall = self._wall(motion, position)
        for iteration in range(1, self.iterations + 1):
            prediction = fluid.predict(now.flow, wall, inputs.inflow)
            position = step.reach(self._load(prediction, inputs), position, ACCURACY)
            before, wall = wall, self._wall(motion, position)
            residual = shape_change(wall.height, before.height)
            if residual <= self.tolerance:
                still = prediction.jump + fluid.impedance @ (before.velocity - coasting)
                return State(
                    now.step + 1, inputs.v_squared, fluid.correct(prediction, wall.velocity),
                    step.end(position), iteration, residual,
                    np.array([still, *now.jump_history[:len(EXTRAPOLATION) - 1]]))
        raise NotConverged(
            f'coupling: the shape still changes by {residual:.3g} of its deflection after '
            f'{self.iterations} iterations (tolerance {self.tolerance:.3g}); '
            'reduce the time step or raise coupling_iterations')

    def _step(self, motion: Motion, v_squared: float) -> Step:
        """Return the equations of the membrane's step, compiled as far as they can be."""
        present = self.structure.during(motion, self.operator.dt, v_squared)
        return Step(present, motion, v_squared, self.operator,
                    iteration_of(present, motion, v_squared, self.operator))

    def _foreseen(self, step: Step, now: State, coasting: np.ndarray, inputs: Inputs,
                  ) -> np.ndarray:
        """Return the position under the extrapolated jump; only a guess, so it may fail."""
        position, history = now.motion.predict(self.operator.dt), now.jump_history
        if len(history):
            jump = EXTRAPOLATION[len(history) - 1] @ history
            load = Load.of(self.fluid, self.structure, jump, coasting, inputs)
            try:
                return step.reach(load, position, FORESEEN)
            except RunFailed:
                pass            # the iterations will tell whether the step can be made
        return position

    def _load(self, prediction: Prediction, inputs: Inputs) -> Load:
        return Load.of(self.fluid, self.structure, prediction.jump, prediction.wall.velocity,
                       inputs)

    def _wall(self, motion: Motion, position: np.ndarray) -> Wall:
        """Return the wall that the flow sees if the membrane reaches ``position``."""
        return transfer.wall_of(self.fluid, self.structure, position,
                                motion.rate(position, self.operator.dt))

    def _coasting_velocity(self, motion: Motion) -> np.ndarray:
        """Return the column velocities (columns,) of a step without acceleration."""
        return transfer.coasting_velocity(self.fluid.columns, *map(self.structure.surface, (
            motion.position, motion.velocity, motion.position_before, motion.velocity_before)))


@checked_kernel
def shape_change(after, before):
    """Return the largest change of height relative to the largest deflection."""
    change, deflection = 0.0, FLAT
    for i in range(after.size):
        change = max(change, abs(after[i] - before[i]))
        deflection = max(deflection, abs(after[i]))
    return change / deflection

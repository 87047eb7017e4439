# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where flow and membrane meet: the implicit coupling iteration.

Each iteration moves the flow's grid to the last known shape, predicts the flow up to its pressure
jump, an affine function of the wall velocity, and solves the membrane under that load: the added
mass is inside the structural solution, so that the iteration converges at any mass ratio.
"""

from dataclasses import dataclass
from functools import cached_property

from dewing_sim.coupling.jump_history import remembered
from dewing_sim.coupling.membrane_step import step_of, tables_of
from dewing_sim.errors import NotConverged
from dewing_sim.fluid.base import Fluid
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine.kernels import checked_kernel
from dewing_sim.machine.resident import Resident
from dewing_sim.state import State
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.step import Operator

FLAT = 1.0e-5       # chords; shapes flatter than this are compared with it


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
        fluid, step = self.fluid, step_of(self.fluid, self.structure, self.operator, self.tables,
                                          now.motion, inputs)
        wall = step.foresee(now.jump_history)
        for iteration in range(1, self.iterations + 1):
            prediction = fluid.predict(now.flow, wall, inputs.inflow)
            before, wall = wall, step.answer(prediction)
            residual = shape_change(wall.height, before.height)
            if residual <= self.tolerance:
                return State(
                    now.step + 1, inputs.v_squared, fluid.correct(prediction, wall.velocity),
                    step.end(), iteration, residual,
                    remembered(now.jump_history, prediction.jump, before.velocity,
                               step.coasting, fluid.impedance))
        raise NotConverged(
            f'coupling: the shape still changes by {residual:.3g} of its deflection after '
            f'{self.iterations} iterations (tolerance {self.tolerance:.3g}); '
            'reduce the time step or raise coupling_iterations')

    @cached_property
    def tables(self) -> Resident | None:
        """What the compiled step of a membrane needs, None if there is none."""
        return tables_of(self.fluid, self.structure, self.operator)


@checked_kernel
def shape_change(after, before):
    """Return the largest change of height relative to the largest deflection."""
    change, deflection = 0.0, FLAT
    for i in range(after.size):
        change = max(change, abs(after[i] - before[i]))
        deflection = max(deflection, abs(after[i]))
    return change / deflection

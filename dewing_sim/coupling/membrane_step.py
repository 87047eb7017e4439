# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The step of an elastic membrane at rest in its axes, each wall in one compiled function.

It takes the same corrections as `structure.dynamics.step` about the tangent of the operator, bit
by bit. Where that tangent no longer serves, where the tension leaves its curve and where numbers
end, it hands over to the general step, which goes on from the last wall.
"""

import math
from typing import NamedTuple

import numpy as np

from dewing_sim.coupling.jump_history import extrapolated
from dewing_sim.coupling.membrane_iteration import TAUT, corrected, curve_of
from dewing_sim.coupling.structure_step import ACCURACY, FORESEEN, StructureStep, WallStep
from dewing_sim.coupling.transfer import ColumnLoad, coasting_velocity, wall
from dewing_sim.fluid.base import Fluid, Prediction, Wall
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine.kernels import kernel
from dewing_sim.machine.resident import Resident, hold
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.band import Parts
from dewing_sim.structure.dynamics.motion import Motion, combined
from dewing_sim.structure.dynamics.step import ITERATIONS, SHRINKAGE, Operator
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.tension_curve import TensionCurve, along


class Tables(NamedTuple):
    """What stays the same from step to step."""

    columns: np.ndarray
    impedance: np.ndarray
    mass: np.ndarray
    stretch_per_length: np.ndarray
    chord: float
    dt: float
    damping: float
    inverse: Parts


def tables_of(fluid: Fluid, structure: Moving, operator: Operator) -> Resident | None:
    """Return what the compiled step needs, None if there is none for this structure."""
    if not isinstance(structure, Membrane) or structure.viscosity is not None:
        return None
    return hold(Tables(fluid.columns, fluid.impedance, structure.mass,
                       structure.stretch_per_length, structure.chord, operator.dt,
                       operator.damping, operator.inverse.parts))


def step_of(fluid: Fluid, structure: Moving, operator: Operator, tables: Resident | None,
            motion: Motion, inputs: Inputs) -> WallStep:
    """Return the compiled step where ``tables``, inflow and tension allow, else the general."""
    inflow, general = inputs.inflow, (fluid, structure, operator, motion, inputs)
    if tables is None or inflow is not None and inflow.is_accelerated:
        return StructureStep(*general)
    curve = curve_of(structure, inputs.v_squared)
    return StructureStep(*general) if curve is None else MembraneStep(general, tables, curve)


class MembraneStep:
    """The `WallStep` of an elastic membrane."""

    def __init__(self, general: tuple, tables: Resident, curve: TensionCurve):
        """Take the arguments of the general step, for it may have to go on."""
        *_, motion, inputs = general
        self._arguments, self._motion, self._usual = general, motion, curve.differences[0]
        self._uniform = 0.5 * inputs.wall_pressure      # q is half the unit of pressure
        self._held = tables, *motion.history, curve.middle, curve.half, curve.differences
        self._reached, self._lowest, self._velocity = None, -math.inf, None
        self.coasting: np.ndarray | None = None         # known once a wall is foreseen
        self._general: StructureStep | None = None

    def foresee(self, history: np.ndarray) -> Wall:
        """Return the wall under the jump that past ones foretell."""
        if len(history):
            found, self.coasting = self._taken(*_foreseen(
                *self._held, history, self._uniform, FORESEEN))
            if found is not None:
                return found
        general = self._handed_over()
        self.coasting = general.coasting
        return general.foresee(history)

    def answer(self, prediction: Prediction) -> Wall:
        """Return the wall under the load of a flow."""
        if self._general is None:
            found, _ = self._taken(*_reach(
                *self._held, prediction.jump, prediction.wall.velocity, self._uniform, ACCURACY,
                self._reached))
            if found is not None:
                return found
        return self._handed_over().answer(prediction)

    def end(self) -> Motion:
        """Return the motion that ends at the last wall."""
        if self._general is not None:
            return self._general.end()
        if not self._lowest > TAUT * self._usual:
            self._arguments[1].require_taut(self._reached, self._arguments[4].v_squared)
        motion = self._motion
        return Motion(self._reached, self._velocity, motion.position, motion.velocity,
                      motion.memory)

    def _taken(self, is_found: bool, position: np.ndarray, lowest: float, rate: np.ndarray,
               seen: tuple[np.ndarray, np.ndarray], reference: np.ndarray,
               ) -> tuple[Wall | None, np.ndarray]:
        """Return the wall that a kernel has found, None where the compiled step ends."""
        if not is_found:
            return None, reference
        self._reached, self._lowest, self._velocity = position, lowest, rate
        return Wall(*seen), reference

    def _handed_over(self) -> StructureStep:
        """Return the general step, at the place that this one has reached."""
        if self._general is None:
            self._general = StructureStep(*self._arguments)
            if self._reached is not None:
                self._general.start_at(self._reached)
        return self._general


@kernel
def _reach(tables, now, before, velocity_now, velocity_before, middle, half, differences, jump,
           reference, uniform, accuracy, start):
    """Return whether Newton's method ends, position, lowest tension, velocity, wall, reference.

    The lowest tension is that before the last correction, as in `Step.end`.
    """
    t = tables.value
    history, scheme = (now, before, velocity_now, velocity_before), (t.dt, t.damping)
    load = ColumnLoad(t.columns, jump, reference, t.impedance, uniform)
    position, previous, accuracy = start, np.inf, accuracy * t.chord
    lowest, is_found = -np.inf, False
    for _ in range(ITERATIONS):
        tension, lowest, is_covered = along(position, t.stretch_per_length, middle, half,
                                            differences)
        if not is_covered:
            break
        moved, size = corrected(position, tension, history, t.mass, scheme, load, t.inverse)
        if not (size < np.inf and size <= max(previous / SHRINKAGE, accuracy)):
            break
        position, previous, is_found = moved, size, size <= accuracy
        if is_found:
            break
    rate = combined(position, now, before, 3.0, -4.0, 1.0, 0.5 / t.dt)
    return is_found, position, lowest, rate, wall(t.columns, position, rate), reference


@kernel
def _foreseen(tables, now, before, velocity_now, velocity_before, middle, half, differences,
              history, uniform, accuracy):
    """Return what `_reach` does, for the jump that a history foretells at a coasting wall."""
    t = tables.value
    coasting = coasting_velocity(t.columns, now, velocity_now, before, velocity_before)
    start = combined(now, velocity_now, velocity_before, 1.0, 1.5 * t.dt, -0.5 * t.dt, 1.0)
    return _reach(tables, now, before, velocity_now, velocity_before, middle, half, differences,
                  extrapolated(history), coasting, uniform, accuracy, start)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where flow and membrane meet: the implicit coupling iteration."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dewing_sim.coupling import transfer
from dewing_sim.coupling.membrane_step import step_of
from dewing_sim.coupling.transfer import Load
from dewing_sim.errors import NotConverged, RunFailed
from dewing_sim.fluid.base import Fluid, Wall
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.machine.kernels import checked_kernel
from dewing_sim.structure.dynamics.band import LowRank
from dewing_sim.structure.dynamics.step import Motion, Operator, Structure

FLAT = 1.0e-5       # chords; shapes flatter than this are compared with it
EXTRAPOLATION = tuple(map(np.array, (       # from one, two or three past values
    (1.0,), (2.0, -1.0), (3.0, -3.0, 1.0))))
# Last correction of the membrane in chords, for a guess and in a pass; the next is far smaller.
FORESEEN, ACCURACY = 1.0e-5, 1.0e-8


@dataclass(frozen=True)
class Coupled:
    """One coupled step: flow, motion, coupling passes and the last relative change of shape.

    ``still_jumps`` (1 to 3, columns) are the pressure jumps that a wall without acceleration
    would have felt in the last steps, newest first.
    """

    flow: Any
    motion: Motion
    iterations: int
    residual: float
    still_jumps: np.ndarray


def solve(fluid: Fluid, structure: Structure, operator: Operator, flow: Any, motion: Motion,
          still_jumps: np.ndarray, dt: float, v_squared: float, wall_pressure: float,
          tolerance: float, passes: int, damping: float = 0.0,
          inflow: Inflow | None = None) -> Coupled:
    """Advance flow and membrane together by ``dt``.

    Each pass moves the grid to the last known shape, predicts the flow up to its pressure jump,
    an affine function of the wall velocity, and solves the membrane under that load: the added
    mass is inside the structural solution.  Passes end when the shape changes by less than
    ``tolerance`` of its largest deflection.  The first shape is that of the membrane under the
    pressure jump extrapolated from the ``still_jumps`` of the last steps (k, columns), without
    any by its own motion.  ``wall_pressure`` is a uniform pressure jump added to the load.
    ``inflow`` is the flow that the wing meets, by default the undisturbed stream; where its axes
    are accelerated, so is the membrane.  Raises `NotConverged` after ``passes``.
    """
    coasting = _coasting(fluid, structure, motion)
    step = step_of(structure, motion, dt, v_squared, operator, damping)

    def moved_under(jump, velocity, guess, accuracy):
        load = Load(fluid, structure, jump, velocity, wall_pressure, inflow)
        return step.reach(load, guess, accuracy)

    position = motion.predict(dt)
    if len(still_jumps):
        jump = EXTRAPOLATION[len(still_jumps) - 1] @ still_jumps
        try:
            position = moved_under(jump, coasting, position, FORESEEN)
        except RunFailed:
            pass                # only a guess: the passes will tell whether the step can be made
    wall = wall_of(fluid, structure, position, motion.rate(position, dt))
    for iteration in range(1, passes + 1):
        prediction = fluid.predict(flow, wall, inflow)
        position = moved_under(prediction.jump, wall.velocity, position, ACCURACY)
        before, wall = wall, wall_of(fluid, structure, position, motion.rate(position, dt))
        residual = shape_change(wall.height, before.height)
        if residual <= tolerance:
            still = prediction.jump + fluid.impedance @ (before.velocity - coasting)
            return Coupled(fluid.correct(prediction, wall.velocity), step.end(position),
                           iteration, residual,
                           np.array([still, *still_jumps[:len(EXTRAPOLATION) - 1]]))
    raise NotConverged(f'coupling: the shape still changes by {residual:.3g} of its deflection '
                       f'after {passes} passes (tolerance {tolerance:.3g}); '
                       'reduce the time step or raise coupling_iterations')


def _coasting(fluid: Fluid, structure: Structure, motion: Motion) -> np.ndarray:
    """Return the column velocities (columns,) of a step without acceleration."""
    return transfer.coasting_velocity(fluid.columns, *map(structure.surface, (
        motion.position, motion.velocity, motion.position_before, motion.velocity_before)))


@checked_kernel
def shape_change(after, before):
    """Return the largest change of height relative to the largest deflection."""
    change, deflection = 0.0, FLAT
    for i in range(after.size):
        change = max(change, abs(after[i] - before[i]))
        deflection = max(deflection, abs(after[i]))
    return change / deflection


def wall_of(fluid: Fluid, structure: Structure, position: np.ndarray, velocity: np.ndarray,
            ) -> Wall:
    """Return the wall that the flow sees of nodal positions and velocities (nodes, 2)."""
    return Wall(*transfer.wall(fluid.columns, structure.surface(position),
                               structure.surface(velocity)))


def nodal_impedance(fluid: Fluid, structure: Structure) -> LowRank:
    """Return -d force / d velocity (m, m) on the free degrees of freedom at rest.

    Its rank is the number of flow columns.
    """
    position = structure.rest_position
    line = structure.surface(position)
    unit = np.eye(line.size).reshape(-1, *line.shape)
    columns = np.array([transfer.wall(fluid.columns, line, motion)[1] for motion in unit])
    basis = np.stack([structure.spread(column.reshape(line.shape)).ravel()[structure.free]
                      for column in columns.T], axis=1)
    weight = np.diff(fluid.columns)[:, None] * fluid.impedance
    return LowRank(np.ascontiguousarray(basis), weight)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A rigid flat or parabolic-camber plate in the stream: the flow solver without the membrane.

Everything is dimensionless: chords, free-stream speeds, air density; time t* in c/U.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Fluid, Loads, Wall
from dewing_sim.fluid.choice import Demand, choose
from dewing_sim.machine import compilation

ADAPTATION_TIME = 10.0              # t* over which the far field learns the circulation
ADAPTATION_RATE = 0.2               # per c/U


@dataclass(frozen=True)
class PlateState:
    """Time t* and the flow."""

    time: float
    flow: Any


class Plate:
    """A rigid plate; ``alpha`` in rad, ``camber`` in chords, ``dt`` in c/U."""

    def __init__(self, alpha: float, camber: float = 0.0, reynolds: float = 2500.0,
                 grid: str = 'standard', dt: float = 0.004, engine: str = 'finite_volume'):
        """Prepare the flow solver on a grid preset."""
        compilation.prepare()
        self.dt = dt
        self.engine = choose(engine, Demand(grid, camber, reynolds, alpha, dt))
        self.fluid: Fluid = engines.make(self.engine, grid, reynolds, alpha, dt)
        x = self.fluid.columns
        self.wall = Wall(4.0 * camber * x * (1.0 - x), np.zeros(len(x) - 1))
        self.circulation = starting_circulation(alpha, camber)

    def rest(self) -> PlateState:
        """Return the start: potential flow with the expected circulation."""
        return PlateState(0.0, self.fluid.rest(self.wall, self.circulation))

    def step(self, state: PlateState) -> PlateState:
        """Return the state one ``dt`` later."""
        prediction = self.fluid.predict(state.flow, self.wall)
        after = PlateState(state.time + self.dt,
                           self.fluid.correct(prediction, self.wall.velocity))
        if after.time < ADAPTATION_TIME:
            after = replace(after, flow=adapt_circulation(self.fluid, after.flow, self.dt))
        return after

    def observe(self, state: PlateState) -> Loads:
        """Return lift, drag and moment coefficients and the pressure jump of the columns."""
        return self.fluid.loads(state.flow)


def starting_circulation(alpha: float, camber: float) -> float:
    """Return nine tenths of thin-aerofoil theory, Gamma = pi (sin alpha + 2 f), in U c."""
    return 0.9 * np.pi * (np.sin(alpha) + 2.0 * camber)


def adapt_circulation(fluid: Fluid, flow: Any, dt: float) -> Any:
    """Move the far-field circulation a little towards the present Cl / 2 (Kutta-Joukowski)."""
    error = 0.5 * fluid.loads(flow).cl - flow.circulation
    return fluid.with_circulation(flow, flow.circulation + ADAPTATION_RATE * dt * error)

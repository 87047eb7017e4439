# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Flow past a wall whose motion is given, on any engine."""

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Fluid, Wall
from dewing_sim.fluid.finite_volume.engine import FiniteVolume
from dewing_sim.fluid.finite_volume.grid import build
from dewing_sim.fluid.finite_volume.presets import PRESETS, Spacing
from dewing_sim.fluid.plate import ADAPTATION_TIME, adapt_circulation, starting_circulation


def step_cost(engine: str, grid: str) -> float:
    """Return the expected milliseconds of a step, many if the engine has no such grid."""
    preset = engines.find(engine).grids.get(grid)
    return preset.milliseconds if preset else 4.0


def march(fluid: Fluid, wall_at: Callable[[float], Wall], duration: float, circulation: float,
          adapt: bool = True) -> Iterator[tuple[float, Any]]:
    """Yield (t*, flow) after each step; ``adapt`` lets the far field learn the circulation."""
    flow = fluid.rest(wall_at(0.0), circulation)
    for step in range(1, round(duration / fluid.dt) + 1):
        wall = wall_at(step * fluid.dt)
        flow = fluid.correct(fluid.predict(flow, wall), wall.velocity)
        if adapt and step * fluid.dt < ADAPTATION_TIME:
            flow = adapt_circulation(fluid, flow, fluid.dt)
        yield step * fluid.dt, flow


def parabola(columns: np.ndarray, camber: float, rate: float) -> Wall:
    """Return the wall y = 4 f x (1 - x) with its exact column-averaged velocity, f' = ``rate``."""
    antiderivative = 4.0 * (columns**2 / 2.0 - columns**3 / 3.0)
    mean = np.diff(antiderivative) / np.diff(columns)
    return Wall(4.0 * camber * columns * (1.0 - columns), rate * mean)


@dataclass(frozen=True)
class PlateResult:
    """A run in time: coefficients (steps,) and, averaged over its second half, dcp (columns,)."""

    time: np.ndarray
    cl: np.ndarray
    cd: np.ndarray
    columns: np.ndarray
    dcp: np.ndarray
    suction: tuple[np.ndarray, np.ndarray] | None

    @property
    def late(self) -> slice:
        """The second half of the run."""
        return slice(len(self.time) // 2, None)

    @property
    def dt(self) -> float:
        """Time step in c/U."""
        return float(self.time[1] - self.time[0])

    @property
    def centre_of_pressure(self) -> float:
        """x/c of the resultant of the pressure."""
        centres = 0.5 * (self.columns[1:] + self.columns[:-1])
        force = self.dcp * np.diff(self.columns)
        return float(np.sum(force * centres) / np.sum(force))

    @property
    def reattachment(self) -> float | None:
        """x/c where reversed flow behind the leading edge ends, None where it is not known."""
        if self.suction is None:
            return None
        x, u = self.suction
        ends = np.flatnonzero((u[1:-2] < 0.0) & (u[2:-1] >= 0.0)) + 1
        if not len(ends):
            return 0.0
        k = ends[-1]
        return float(x[k] - u[k] * (x[k + 1] - x[k]) / (u[k + 1] - u[k]))


@dataclass(frozen=True)
class PlateRun:
    """A rigid plate in a steady stream; angles in deg, times in c/U.

    ``rotation`` turns the plate on the moving grid in place of the stream. ``lift`` is the Cl
    that the start expects, by default nine tenths of thin-aerofoil theory, and 0 for an impulsive
    start, in which the far field does not learn. ``coarsening`` multiplies all cell sizes and
    ``extent`` moves the far field; both are the finite-volume engine's.
    """

    engine: str
    grid: str
    alpha: float
    duration: float
    reynolds: float = 2500.0
    dt: float = 0.004
    camber: float = 0.0
    rotation: float = 0.0
    lift: float | None = None
    coarsening: float = 1.0
    extent: float = 50.0

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return step_cost(self.engine, self.grid) * self.duration / self.dt / self.coarsening**2

    def fluid(self) -> Fluid:
        """Return the flow solver."""
        alpha = np.radians(self.alpha)
        if self.coarsening == 1.0 and self.extent == 50.0:
            return engines.make(self.engine, self.grid, self.reynolds, alpha, self.dt)
        spacing = replace(coarser(PRESETS[self.grid].spacing, self.coarsening), extent=self.extent)
        return FiniteVolume(build(spacing), self.reynolds, alpha, self.dt)

    def wall(self, columns: np.ndarray) -> Wall:
        """Return the resting wall."""
        wall = parabola(columns, self.camber, 0.0)
        return replace(wall, height=wall.height - np.tan(np.radians(self.rotation)) * columns)

    def __call__(self) -> PlateResult:
        """March the flow."""
        fluid = self.fluid()
        wall = self.wall(fluid.columns)
        circulation = starting_circulation(np.radians(self.alpha + self.rotation), self.camber)
        if self.lift is not None:
            circulation = 0.5 * self.lift
        rows, jumps = [], []
        for time, flow in march(fluid, lambda _: wall, self.duration, circulation,
                                self.lift != 0.0):
            loads = fluid.loads(flow)
            rows.append((time, loads.cl, loads.cd))
            if time > 0.5 * self.duration:
                jumps.append(loads.jump)
        return PlateResult(*np.array(rows).T, fluid.columns, 2.0 * np.mean(jumps, axis=0),
                           fluid.suction(flow))


def coarser(spacing: Spacing, factor: float) -> Spacing:
    """Return ``spacing`` with every cell ``factor`` times as large."""
    kept = {'near', 'extent'}
    return replace(spacing, **{name: factor * size for name, size in vars(spacing).items()
                               if name not in kept})

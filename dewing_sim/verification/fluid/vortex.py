# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A decaying Taylor vortex on a heaving grid: an exact solution for the finite-volume engine."""

from dataclasses import dataclass, replace

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume import mapping, projection
from dewing_sim.fluid.finite_volume.engine import FiniteVolume, FlowState
from dewing_sim.fluid.finite_volume.grid import Grid
from dewing_sim.fluid.finite_volume.potential import Potential
from dewing_sim.verification.study import Check, Study

VISCOSITY = 0.05
STRENGTH = 0.2
CELLS = (32, 64, 128)


def free_engine(cells: int, dt: float, stream: tuple[float, float], reynolds: float,
                extent: float) -> FiniteVolume:
    """Return an engine without a plate, on a uniform grid whose middle column may heave."""
    x = np.linspace(-extent, extent, cells + 1)
    engine = FiniteVolume(Grid(x, x, cells // 2, cells // 2), reynolds, 0.0, dt)
    shape_x, shape_y = (cells + 1, cells), (cells, cells + 1)
    engine.potential = Potential(np.full(shape_x, stream[0]), np.full(shape_y, stream[1]),
                                 np.zeros(shape_x), np.zeros(shape_y))
    return engine


def heaving(time: float) -> Wall:
    """Return a wall of a single point that heaves by 0.2 sin t."""
    rate = 0.2 * np.cos(time)
    return Wall(np.array([0.2 * np.sin(time)]), np.empty(0), (rate, rate))


def with_velocities(engine: FiniteVolume, wall: Wall, u: np.ndarray, v: np.ndarray) -> FlowState:
    """Return a state of the given velocities without pressure."""
    g, metrics = mapping.decay(engine.grid), mapping.metrics(engine.grid, wall)
    fx, fy = projection.fluxes(engine.grid, g, metrics, u, v)
    w = fy - np.outer(metrics.velocity, g.f)
    p = np.zeros((len(engine.grid.dx), len(engine.grid.dy)))
    return FlowState.resting(u, v, fx, w, p, wall, 0.0)


def taylor_vortex(x, y, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return (u, v) of a decaying vortex without circulation (Taylor 1918).

    Vorticity strength (1 - r^2 / 4 s) exp(-r^2 / 4 s) / s^2, s = nu (t + 4).
    """
    s = VISCOSITY * (time + 4.0)
    swirl = 0.5 * STRENGTH / s**2 * np.exp(-(x**2 + y**2) / (4.0 * s))
    return -swirl * y, swirl * x


def vortex_pressure(x, y, time: float, far: float) -> np.ndarray:
    """Return the pressure of `taylor_vortex` for the pressure ``far`` from it."""
    s = VISCOSITY * (time + 4.0)
    return far - STRENGTH**2 / (4.0 * s**3) * np.exp(-(x**2 + y**2) / (2.0 * s))


@dataclass(frozen=True)
class VortexRun:
    """One time unit of the vortex on ``cells`` x ``cells``; returns the largest error of u, v."""

    cells: int
    engine: str = 'finite_volume'

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return 3.0e-5 * self.cells**3

    @property
    def dt(self) -> float:
        """Time step: refined with the grid."""
        return 1.6 / self.cells

    def __call__(self) -> float:
        """March from the exact solution and compare with it, relative to its largest speed."""
        engine = free_engine(self.cells, self.dt, (0.0, 0.0), 1.0 / VISCOSITY, extent=6.0)
        before = with_velocities(engine, heaving(-self.dt), *_exact(engine.grid, -self.dt))
        x, y = engine.grid.xc, _place(engine.grid.xc, engine.grid.yc, 0.0)
        state = replace(
            with_velocities(engine, heaving(0.0), *_exact(engine.grid, 0.0)),
            u_before=before.u, v_before=before.v, fx_before=before.fx, w_before=before.w,
            p=vortex_pressure(x[:, None], y, 0.0, far=0.5))
        for step in range(1, round(1.0 / self.dt) + 1):
            wall = heaving(step * self.dt)
            state = engine.correct(engine.predict(state, wall), wall.velocity)
        u, v = _exact(engine.grid, 1.0)
        return float(max(np.abs(state.u - u).max(), np.abs(state.v - v).max()) / np.abs(u).max())


def _place(x: np.ndarray, eta: np.ndarray, time: float) -> np.ndarray:
    """Return y of the moving grid (len(x), len(eta))."""
    return eta + np.outer(np.exp(-x**2), heaving(time).height[0] * np.exp(-eta**2))


def _exact(grid: Grid, time: float) -> tuple[np.ndarray, np.ndarray]:
    return (taylor_vortex(grid.x[:, None], _place(grid.x, grid.yc, time), time)[0],
            taylor_vortex(grid.xc[:, None], _place(grid.xc, grid.y, time), time)[1])


def runs(engine: str, quick: bool) -> dict[str, VortexRun]:
    """Return three grids for the engine that has a grid to deform."""
    if engine != 'finite_volume':
        return {}
    return {str(cells): VortexRun(cells) for cells in CELLS}


def checks(engine: str, results: dict[str, float]) -> list[Check]:
    """Judge the observed order and the error on the finest grid."""
    if not results:
        return []
    errors = [results[str(cells)] for cells in CELLS]
    order = -np.polyfit(np.log(CELLS), np.log(errors), 1)[0]
    return [
        Check('Taylor vortex on a heaving grid: observed order', engine, order, 2.0,
              'exact solution (Taylor 1918)', 0.2, 1.0),
        Check('Taylor vortex on a heaving grid: largest error, 128 cells', engine, errors[-1],
              0.0, 'exact solution (Taylor 1918)', 0.01, 1.0),
    ]


STUDY = Study(
    'vortex', 'Decaying vortex on a moving grid',
    'A Taylor vortex is marched over one time unit while the grid heaves by 0.2; cells and time '
    'step are halved together.',
    runs, checks)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The finite-volume engine: one time step of the flow, short of the wall's final velocity.

A step is momentum (BDF2, delta form, ADI) and projection (direct).  `predict` carries both up to
the pressure jump, which is affine in the wall velocity; `correct` finishes the projection once the
membrane has answered.  So the membrane is solved inside the pressure equation and the coupling is
stable at any mass ratio.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.fluid.base import Fluid, Loads, Monitor, Prediction, Wall
from dewing_sim.fluid.field import FlowField
from dewing_sim.fluid.finite_volume import mapping, projection, step
from dewing_sim.fluid.finite_volume.field import flow_field
from dewing_sim.fluid.finite_volume.grid import Grid, build
from dewing_sim.fluid.finite_volume.poisson import Poisson
from dewing_sim.fluid.finite_volume.potential import Potential
from dewing_sim.fluid.finite_volume.presets import NAME, PRESETS
from dewing_sim.fluid.finite_volume.step import FlowState
from dewing_sim.fluid.inflow import Inflow

FASTEST = 50.0                      # |u| in free-stream speeds beyond which a run has diverged


@dataclass(frozen=True)
class _Fields:
    """An unfinished step: predicted fluxes and the modal pressure increment."""

    state: FlowState
    metrics: mapping.Metrics
    fx: np.ndarray
    fy: np.ndarray
    even_hat: np.ndarray
    odd_hat: np.ndarray
    increment: np.ndarray           # jump of phi, above minus below, for the predicted wall


class FiniteVolume(Fluid):
    """Incompressible Navier-Stokes flow on a membrane-following grid, see `base.Fluid`.

    It does not slip: the momentum equation has the wall velocity built in.
    """

    name, grids, state, free_edges = NAME, PRESETS, FlowState, True

    def __init__(self, grid: Grid, reynolds: float, alpha: float, dt: float):
        """Prepare a grid for one Reynolds number, angle of attack (rad) and dt (c/U)."""
        self.grid = grid
        self.nu = 1.0 / reynolds
        self.alpha = alpha
        self.dt = dt
        self.theta = 2.0 * dt / 3.0
        self.columns = grid.columns
        self.poisson = Poisson.of(grid)
        self.impedance = self.poisson.added_mass / self.theta
        self.potential = Potential.of(grid, alpha)
        self.solver = step.Solver.of(grid, self.nu, self.theta)
        self._g = self.solver.g

    @classmethod
    def preset(cls, name: str, reynolds: float, alpha: float, dt: float) -> 'FiniteVolume':
        """Return the engine on a named grid (`PRESETS`)."""
        return cls(build(PRESETS[name].spacing), reynolds, alpha, dt)

    @property
    def cells(self) -> int:
        """Number of pressure cells."""
        return self.grid.cells

    def rest(self, wall: Wall, circulation: float) -> FlowState:
        """Return the potential flow with the given bound circulation (U c), about to feel no slip.

        The fluxes of the flat plate serve a cambered wall: they do not cross its grid line.
        """
        metrics = mapping.metrics(self.grid, wall)
        fx, fy = self.potential.fluxes(circulation)
        u, v = projection.velocities(self.grid, self._g, metrics, fx, fy)
        w = fy - np.outer(metrics.velocity, self._g.f)
        p = np.zeros((len(self.grid.dx), len(self.grid.dy)))
        return FlowState.resting(u, v, fx, w, p, wall, circulation)

    def with_circulation(self, state: FlowState, circulation: float) -> FlowState:
        """Return ``state`` with the far-field values of another total circulation (U c)."""
        u, v, fx, w = (field.copy() for field in (state.u, state.v, state.fx, state.w))
        far_x, far_y = self.potential.fluxes(circulation)
        for field in (u, fx):
            field[0] = far_x[0]
            field[1:, [0, -1]] = far_x[1:, [0, -1]]
        for field in (v, w):
            field[0] = far_y[0]
            field[1:, [0, -1]] = far_y[1:, [0, -1]]
        return replace(state, u=u, v=v, fx=fx, w=w, circulation=circulation)

    def predict(self, state: FlowState, wall: Wall, inflow: Inflow | None = None) -> Prediction:
        """Advance momentum and the forward half of the projection with the wall in place.

        Raises `BadInput` for any ``inflow``: the far field is that of a steady stream.
        """
        if inflow is not None:
            raise BadInput('the finite-volume engine knows no gusts, heave or pitch: '
                           'numerics.engine: conformal does')
        metrics = mapping.metrics(self.grid, wall)
        u, v = self._momentum(state, metrics, wall)
        fx, fy = projection.fluxes(self.grid, self._g, metrics, u, v)
        outflow = projection.divergence(fx, fy, self.grid.dx, self.grid.dy)
        even_hat, odd_hat, increment = self.poisson.forward(outflow / self.theta)
        jump = self._jump(state.p) - increment
        if not np.isfinite(jump).all():
            raise Diverged('the flow became non-finite: lower the time step or refine the grid')
        return Prediction(wall, jump,
                          _Fields(state, metrics, fx, fy, even_hat, odd_hat, increment))

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> FlowState:
        """Finish the projection with the wall velocity (n,) of the columns."""
        fields: _Fields = prediction.fields
        grid, state = self.grid, fields.state
        change = velocity - prediction.wall.velocity
        fx, fy = fields.fx, fields.fy.copy()
        fy[grid.plate, grid.middle] = velocity
        phi = self.poisson.backward(
            fields.even_hat, fields.odd_hat, fields.increment + self.impedance @ change,
            grid.dx[grid.plate] * change / self.theta)
        fx = fx.copy()
        projection.correct(fx, fy, phi, grid.lattice, self.theta)
        u, v = projection.velocities(grid, self._g, fields.metrics, fx, fy)
        motion = mapping.grid_velocity(grid, replace(prediction.wall, velocity=velocity))
        self._guard(u)
        return FlowState(
            u=u, v=v, fx=fx, w=fy - np.outer(motion, self._g.f), p=state.p + phi,
            u_before=state.u, v_before=state.v, fx_before=state.fx, w_before=state.w,
            height=prediction.wall.height, velocity=velocity, circulation=state.circulation)

    def loads(self, state: FlowState) -> Loads:
        """Integrate pressure and wall shear over both sides of the wing."""
        grid = self.grid
        jump = self._jump(state.p)
        dx, middle = grid.dx[grid.plate], grid.middle
        height = mapping.metrics(grid, Wall(state.height, state.velocity)).height_f
        below, above = (state.u[:, row] / (1.0 + height * self._g.dc[row])
                        for row in (middle - 1, middle))
        shear = self.nu * (below + above) / (0.5 * grid.dy[middle])
        normal = np.sum(jump * dx)
        axial = (np.sum(shear * self.solver.blocked * grid.dxf)
                 - np.sum(jump * np.diff(state.height)))
        moment = -np.sum(jump * dx * (grid.xc[grid.plate] - 0.25))
        cos, sin = np.cos(self.alpha), np.sin(self.alpha)
        return Loads(jump, cl=2.0 * float(normal * cos - axial * sin),
                     cd=2.0 * float(normal * sin + axial * cos), cm=2.0 * float(moment))

    def field(self, state: FlowState) -> FlowField:
        """Return vorticity and stream function on the cell corners."""
        return flow_field(self.grid, state, self.alpha)

    def suction(self, state: FlowState) -> tuple[np.ndarray, np.ndarray]:
        """Return x and the speed along the upper side, next to it."""
        grid = self.grid
        return self.columns, state.u[grid.leading:grid.trailing + 1, grid.middle]

    def parts(self, state: FlowState, wall: Wall) -> dict[str, Callable[[], Any]]:
        """Return what `predict` and `correct` spend most of their time on."""
        metrics = mapping.metrics(self.grid, wall)
        still = np.zeros(len(self.columns) - 1)
        solution = self.poisson.forward(state.p)
        return {
            'momentum': lambda: self._momentum(state, metrics, wall),
            'pressure_forward': lambda: self.poisson.forward(state.p),
            'pressure_backward': lambda: self.poisson.backward(*solution, still),
        }

    def monitor(self, state: FlowState) -> Monitor:
        """Return the CFL numbers of the cells, from the mean fluxes through their faces."""
        grid = self.grid
        m = mapping.metrics(grid, Wall(state.height, state.velocity))
        rate = (0.5 * np.abs(state.fx[1:] + state.fx[:-1]) / grid.dx[:, None]
                + 0.5 * np.abs(state.w[:, 1:] + state.w[:, :-1]) / grid.dy)
        outside = np.minimum(np.abs(grid.xc), np.abs(grid.xc - 1.0))
        return Monitor.of(self.dt * rate / (1.0 + np.outer(m.height_c, self._g.dc)),
                          np.hypot(outside[:, None], grid.yc), self.slip(state))

    def _momentum(self, state: FlowState, m: mapping.Metrics, wall: Wall,
                  ) -> tuple[np.ndarray, np.ndarray]:
        """Return the velocities that satisfy momentum with the old pressure."""
        return step.velocities(state, m, wall.velocity, self.solver,
                               self.potential.outlet_pressure(state.circulation))

    def _jump(self, p: np.ndarray) -> np.ndarray:
        """Return the pressure jump, below minus above, of the columns on the plate."""
        plate, middle = self.grid.plate, self.grid.middle
        return p[plate, middle - 1] - p[plate, middle]

    def _guard(self, u: np.ndarray) -> None:
        fastest = np.abs(u).max()
        if not fastest < FASTEST:
            raise Diverged(f'the flow reached {fastest:.3g} free-stream speeds: '
                           'lower the time step or refine the grid')

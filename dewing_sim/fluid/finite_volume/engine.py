# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The finite-volume engine: one time step of the flow, short of the wall's final velocity.

A step is momentum (BDF2, delta form, ADI) and projection (direct).  `predict` carries both up to
the pressure jump, which is affine in the wall velocity; `correct` finishes the projection once the
membrane has answered.  So the membrane is solved inside the pressure equation and the coupling is
stable at any mass ratio.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.fluid.base import Fluid, Loads, Monitor, Prediction, Wall
from dewing_sim.fluid.field import FlowField
from dewing_sim.fluid.finite_volume import mapping, poisson, projection, step
from dewing_sim.fluid.finite_volume.field import flow_field
from dewing_sim.fluid.finite_volume.grid import Grid, build
from dewing_sim.fluid.finite_volume.loads import integrate
from dewing_sim.fluid.finite_volume.potential import Potential
from dewing_sim.fluid.finite_volume.presets import NAME, PRESETS
from dewing_sim.fluid.finite_volume.solver import Solver
from dewing_sim.fluid.finite_volume.step import FlowState
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.machine.resident import hold


class _Fields(NamedTuple):
    """An unfinished step: predicted fluxes and the modal pressure increment."""

    fx: np.ndarray
    fy: np.ndarray
    even_hat: np.ndarray
    odd_hat: np.ndarray
    increment: np.ndarray           # jump of phi, above minus below, for the predicted wall


class _Unfinished(NamedTuple):
    """What `correct` needs of a step."""

    state: FlowState
    fields: _Fields


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
        self.solver = Solver.of(grid, self.nu, self.theta)
        self._resident = hold(self.solver)
        self.impedance = self.solver.impedance
        self.potential = Potential.of(grid, alpha)
        self._g = self.solver.g
        self._arms = grid.xc[grid.plate] - 0.25

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
        *fields, jump, deflection, is_finite = step.predict(
            self._resident, *state.past, wall.height, wall.velocity, state.velocity,
            *wall.edge_velocity, self.potential.outlet_pressure(state.circulation))
        mapping.require_room(deflection)
        if not is_finite:
            raise Diverged('the flow became non-finite: lower the time step or refine the grid')
        return Prediction(wall, jump, _Unfinished(state, _Fields(*fields)))

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> FlowState:
        """Finish the projection with the wall velocity (n,) of the columns."""
        (state, fields), wall = prediction.fields, prediction.wall
        *after, is_sound = step.correct(
            self._resident, *fields, state.p, wall.height, wall.velocity, velocity,
            *wall.edge_velocity)
        if not is_sound:
            raise Diverged(f'the flow reached {np.abs(after[0]).max():.3g} free-stream speeds: '
                           'lower the time step or refine the grid')
        return state.followed_by(*after, wall.height, velocity)

    def loads(self, state: FlowState) -> Loads:
        """Integrate pressure and wall shear over both sides of the wing."""
        jump, axial, normal, moment = integrate(
            self._resident, state.u, state.p, state.height, self._arms)
        cos, sin = math.cos(self.alpha), math.sin(self.alpha)
        return Loads(jump, cl=2.0 * (normal * cos - axial * sin),
                     cd=2.0 * (normal * sin + axial * cos), cm=2.0 * moment)

    def field(self, state: FlowState) -> FlowField:
        """Return vorticity and stream function on the cell corners."""
        return flow_field(self.grid, state, self.alpha)

    def suction(self, state: FlowState) -> tuple[np.ndarray, np.ndarray]:
        """Return x and the speed along the upper side, next to it."""
        grid = self.grid
        return self.columns, state.u[grid.leading:grid.trailing + 1, grid.middle]

    def parts(self, state: FlowState, wall: Wall) -> dict[str, Callable[[], Any]]:
        """Return what `predict` and `correct` spend most of their time on."""
        solver, grid = self.solver, self.grid
        m = mapping.metrics(grid, wall)
        still = np.zeros(len(self.columns) - 1)
        outlet = self.potential.outlet_pressure(state.circulation)
        fx, fy = projection.fluxes(grid, self._g, m, state.u, state.v)
        solution = poisson.forward(fx, fy, grid.dx, grid.dy, self.theta, solver.poisson)
        past, held = hold(step.Past(*state.past)), hold(m)
        return {
            'momentum': lambda: step.velocities(self._resident, past, held, still, outlet),
            'pressure_forward': lambda: poisson.forward(fx, fy, grid.dx, grid.dy, self.theta,
                                                        solver.poisson),
            'pressure_backward': lambda: poisson.backward(*solution, still, solver.poisson),
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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The momentum half of a step: velocities that the pressure has not yet made free of divergence.

Fluxes are extrapolated to the new time; coefficients, right-hand side and two implicit sweeps
follow for each velocity component.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.finite_volume import adi, mapping, momentum, transport
from dewing_sim.fluid.finite_volume.grid import Grid, Lattice

UPWIND_SHARE = 0.5                  # in the far field only
UPWIND_START, UPWIND_FULL = 1.0, 4.0    # chords from the plate


@dataclass(frozen=True)
class FlowState:
    """Everything the next step depends on; faces as in `Grid`, speeds in U."""

    u: np.ndarray                   # (nx + 1, ny)
    v: np.ndarray                   # (nx, ny + 1)
    fx: np.ndarray                  # Fx, flux through xi-faces
    w: np.ndarray                   # Fy - g Y_t, flux through the moving eta-faces
    p: np.ndarray                   # (nx, ny) pressure in rho U^2
    u_before: np.ndarray            # one step earlier
    v_before: np.ndarray
    fx_before: np.ndarray
    w_before: np.ndarray
    height: np.ndarray              # wall heights at the column faces
    velocity: np.ndarray            # wall velocities of the columns
    circulation: float              # of wing and wake together, in U c


class Upwind(NamedTuple):
    """Share of upwinding by the places of faces and centres: zero near the membrane."""

    x: np.ndarray
    y: np.ndarray
    xc: np.ndarray
    yc: np.ndarray


class Solver(NamedTuple):
    """All that stays the same from step to step."""

    nu: float
    theta: float                    # 2 dt / 3
    lattice: Lattice
    g: mapping.Decay
    upwind: Upwind
    blocked: np.ndarray             # (nx + 1,) share of the control volume of u on the plate

    @classmethod
    def of(cls, grid: Grid, nu: float, theta: float) -> 'Solver':
        """Return the solver for one grid, viscosity and time step."""
        upwind = Upwind(_upwind(np.maximum(-grid.x, grid.x - 1.0)), _upwind(np.abs(grid.y)),
                        _upwind(np.maximum(-grid.xc, grid.xc - 1.0)), _upwind(np.abs(grid.yc)))
        return cls(nu, theta, grid.lattice, mapping.decay(grid), upwind, _blocked(grid))


class Stencil(NamedTuple):
    """Coefficients of the four neighbours of a velocity, see `transport`."""

    west: np.ndarray
    east: np.ndarray
    south: np.ndarray
    north: np.ndarray


def velocities(state: FlowState, m: mapping.Metrics, wall_velocity: np.ndarray, solver: Solver,
               p_outlet: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return u and v that satisfy momentum with the old pressure."""
    fx = 2.0 * state.fx - state.fx_before
    w = 2.0 * state.w - state.w_before
    return (_solve_u(state, m, fx, w, solver, p_outlet),
            _solve_v(state, m, fx, w, solver, wall_velocity))


def _solve_u(state, m, fx, w, solver, p_outlet) -> np.ndarray:
    stencil = Stencil(*np.empty((4, *state.u.shape)))
    change = np.zeros_like(state.u)             # the far field is given
    faces = len(change)
    drag = np.zeros((2, faces))
    transport.u_coefficients(fx, w, m, solver, stencil, drag)
    momentum.u_explicit(state.u, state.u_before, state.p, p_outlet, stencil, drag, solver, change)
    momentum.u_slope_terms(state.u, state.u_before, state.p, m, solver, change)
    adi.sweep_x(change, stencil.west, stencil.east, np.empty_like(change), faces)
    adi.sweep_y(change, stencil.south, stencil.north, drag, faces)
    return state.u + change


def _solve_v(state, m, fx, w, solver, wall_velocity) -> np.ndarray:
    stencil = Stencil(*np.empty((4, *state.v.shape)))
    change = np.zeros_like(state.v)
    columns, middle = len(change), len(solver.lattice.dy) // 2
    transport.v_coefficients(fx, w, m, solver, stencil)
    momentum.v_explicit(state.v, state.v_before, state.p, m, stencil, solver, change)
    momentum.v_slope_terms(state.v, state.v_before, m, solver, change)
    change[solver.lattice.leading:solver.lattice.trailing, middle] = (
        wall_velocity - state.velocity)
    adi.sweep_x(change, stencil.west, stencil.east, np.empty_like(change), columns)
    adi.sweep_y(change, stencil.south, stencil.north, np.zeros((2, columns)), columns)
    return state.v + change


def _upwind(distance: np.ndarray) -> np.ndarray:
    """Return the share of upwinding at a distance (c) from the plate: zero near the membrane."""
    ramp = (distance - UPWIND_START) / (UPWIND_FULL - UPWIND_START)
    return UPWIND_SHARE * np.clip(ramp, 0.0, 1.0)


def _blocked(grid: Grid) -> np.ndarray:
    """Return the share (nx + 1,) of the control volume of u that lies on the plate."""
    on_plate = np.zeros(len(grid.dx))
    on_plate[grid.plate] = grid.dx[grid.plate]
    padded = np.concatenate(([0.0], on_plate, [0.0]))
    return 0.5 * (padded[1:] + padded[:-1]) / grid.dxf

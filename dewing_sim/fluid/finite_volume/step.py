# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The momentum half of a step: velocities that the pressure has not yet made free of divergence.

Fluxes are extrapolated to the new time; coefficients, right-hand side and two implicit sweeps
follow for each velocity component.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume import adi, mapping, momentum, transport
from dewing_sim.fluid.finite_volume.grid import Grid, Lattice
from dewing_sim.machine.kernels import kernel, stage

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

    @classmethod
    def resting(cls, u: np.ndarray, v: np.ndarray, fx: np.ndarray, w: np.ndarray, p: np.ndarray,
                wall: Wall, circulation: float) -> 'FlowState':
        """Return a flow that has been the same one step earlier."""
        return cls(u=u, v=v, fx=fx, w=w, p=p, u_before=u, v_before=v, fx_before=fx, w_before=w,
                   height=wall.height, velocity=wall.velocity, circulation=circulation)


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


class Fields(NamedTuple):
    """What a step starts from; the fluxes are extrapolated to its end."""

    u: np.ndarray
    u_before: np.ndarray
    v: np.ndarray
    v_before: np.ndarray
    p: np.ndarray
    fx: np.ndarray
    w: np.ndarray


def velocities(state: FlowState, m: mapping.Metrics, wall_velocity: np.ndarray, solver: Solver,
               p_outlet: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return u and v that satisfy momentum with the old pressure."""
    fields = Fields(state.u, state.u_before, state.v, state.v_before, state.p,
                    2.0 * state.fx - state.fx_before, 2.0 * state.w - state.w_before)
    return _velocities(fields, m, wall_velocity - state.velocity, solver, p_outlet)


@kernel
def _velocities(fields, m, wall_change, solver, p_outlet):
    """Compute both in one function: to hand over the arrays takes a while, and is done once."""
    u, v = np.zeros_like(fields.u), np.zeros_like(fields.v)     # the far field is given
    drag = np.zeros((2, len(u)))
    stencil = _stencil(u)
    transport.u_coefficients(fields.fx, fields.w, m, solver, stencil, drag)
    momentum.u_explicit(fields.u, fields.u_before, fields.p, p_outlet, stencil, drag, solver, u)
    momentum.u_slope_terms(fields.u, fields.u_before, fields.p, m, solver, u)
    adi.sweep_x(u, stencil.west, stencil.east, np.empty_like(u), len(u))
    adi.sweep_y(u, stencil.south, stencil.north, drag, len(u))
    stencil = _stencil(v)
    transport.v_coefficients(fields.fx, fields.w, m, solver, stencil)
    momentum.v_explicit(fields.v, fields.v_before, fields.p, m, stencil, solver, v)
    momentum.v_slope_terms(fields.v, fields.v_before, m, solver, v)
    leading, middle = solver.lattice.leading, len(solver.lattice.dy) // 2
    for i in range(wall_change.size):
        v[leading + i, middle] = wall_change[i]
    adi.sweep_x(v, stencil.west, stencil.east, np.empty_like(v), len(v))
    adi.sweep_y(v, stencil.south, stencil.north, np.zeros((2, len(v))), len(v))
    return fields.u + u, fields.v + v


@stage
def _stencil(like):
    rows, columns = like.shape
    four = np.empty((4, rows, columns))
    return Stencil(four[0], four[1], four[2], four[3])


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

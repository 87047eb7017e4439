# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One step of the flow, compiled as one function that works in fields made once.

A fresh array costs more than the arithmetic that fills it: what ends with the step is kept in
`Fields`, overwritten by the next; only what the state keeps is new.
"""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.conformal import adi, noslip, poisson, pressure, transport
from dewing_sim.fluid.conformal.fourier import modes
from dewing_sim.fluid.conformal.fourier.stockham import Buffers
from dewing_sim.fluid.conformal.geometry.exterior import Exterior, measure
from dewing_sim.fluid.conformal.geometry.frame import Stream
from dewing_sim.fluid.conformal.geometry.wall import WallMotion
from dewing_sim.fluid.conformal.grid import Grid, Strip
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.conformal.pressure import WallPressure
from dewing_sim.machine.kernels import kernel, scratch, stage


class Fields(NamedTuple):
    """What a step needs for itself; (n, rows) unless said."""

    h2: np.ndarray
    grid_v: np.ndarray
    grid_u: np.ndarray
    v: np.ndarray                   # flux through the outer face of each cell
    u: np.ndarray                   # flux through the face to the next line
    r: np.ndarray                   # residual, then the correction of vorticity
    inertia: np.ndarray             # H of the sweeps
    q_hat: np.ndarray               # (rows, 2 modes) of h^2 w
    psi_hat: np.ndarray             # (rows, 2 modes) of psi'
    buffers: Buffers

    @classmethod
    def of(cls, n: int, rows: int) -> 'Fields':
        """Return fields for ``n`` lines."""
        return cls(*scratch(7, n, rows), *scratch(2, rows, n + 2), Buffers.of(n * rows))


class Solver(NamedTuple):
    """All that stays the same from step to step."""

    nu: float
    dt: float
    grid: Strip
    exterior: Exterior
    poisson: Poisson
    wall_pressure: WallPressure
    fields: Fields

    @classmethod
    def of(cls, grid: Grid, nu: float, dt: float) -> 'Solver':
        """Return the solver for one grid, viscosity and time step."""
        return cls(nu, dt, grid.strip, Exterior.of(grid), Poisson.of(grid),
                   WallPressure.of(grid, nu), Fields.of(len(grid.xi), len(grid.eta)))


class Past(NamedTuple):
    """The last two instants, and the circulation of wing and wake."""

    w: np.ndarray
    w_before: np.ndarray
    q: np.ndarray
    q_before: np.ndarray
    psi: np.ndarray
    psi_before: np.ndarray
    circulation: float


@kernel
def advance(solver, edges, w, w_before, q, q_before, psi, psi_before, circulation, shape, ends,
            shape_rate, scale_rate, corner, node, turning, u, v, acceleration, speed):
    """Return vorticity, h^2 w, psi', wall pressure, circulation and slip after a step.

    ``solver`` holds the `Solver`, ``edges`` the `noslip.Edges` at the end of the step. Then come
    the fields of a `Past`, of the `mapping.Map` at the end of the step and its rates, of a
    `frame.Stream` and of a `WallMotion`. The slip is the largest that was shed.
    """
    solver, edges = solver.value, edges.value
    past = Past(w, w_before, q, q_before, psi, psi_before, circulation)
    stream, motion = Stream(corner, node, turning), WallMotion(u, v, acceleration, speed)
    f, plan, scale = solver.fields, solver.exterior.plan, ends[0]
    measure(shape, scale, shape_rate, scale_rate, solver.exterior, f.buffers, f.h2, f.grid_v,
            f.grid_u)
    w, outflow = _transport(past, stream, edges.share, scale, solver)
    circulation = past.circulation + solver.dt * outflow
    required = modes.line_modes(-motion.u - 2.0 * scale * stream.node, f.buffers, plan)
    q, psi, slip = _close(w, motion.v, required, circulation, edges.influence, solver)
    transport.fluxes(psi, stream.corner, scale, solver.grid, 0, len(psi), f.v, f.u)
    p = pressure.wall_head(solver.wall_pressure, w, f.v, f.u, motion, f.buffers, plan)
    for i in range(p.size):
        p[i] -= 0.5 * motion.speed[i]**2    # of the total head P
    return w, q, psi, p, circulation, slip


@stage
def _transport(past, stream, share, scale, solver):
    """Return the vorticity (n, rows) before no slip, and what left through the outer boundary."""
    nu, dt, grid, f = solver.nu, solver.dt, solver.grid, solver.fields
    n, rows = past.w.shape
    psi, w = f.buffers.re[:n * rows].reshape((n, rows)), np.empty((n, rows))
    psi_now, psi_before, sin_corner = past.psi, past.psi_before, stream.corner
    transport.extrapolate(past.w, past.w_before, share, w)
    for i in range(n):
        for j in range(rows):
            psi[i, j] = 2.0 * psi_now[i, j] - psi_before[i, j]
    if stream.turning.size:
        psi -= stream.turning
    outflow = 0.0
    # The first line needs the fluxes of the last; then a few lines pass through all that follows.
    transport.fluxes(psi, sin_corner, scale, grid, n - 1, n, f.v, f.u)
    transport.subtract_grid_flux(f.grid_v, f.grid_u, n - 1, n, f.v, f.u)
    for first in range(0, n, adi.LANES):
        stop = min(first + adi.LANES, n)
        transport.fluxes(psi, sin_corner, scale, grid, first, stop, f.v, f.u)
        transport.subtract_grid_flux(f.grid_v, f.grid_u, first, stop, f.v, f.u)
        outflow += transport.residual(w, f.h2, past.q, past.q_before, f.v, f.u, grid, nu, dt,
                                      first, stop, f.r)
        adi.split_inertia(f.h2, f.v, f.u, grid, nu, dt, first, stop, f.inertia)
        adi.sweep_eta(f.r, f.inertia, f.v, grid, nu, first, stop)
    adi.sweep_xi(f.r, f.inertia, f.u, grid, nu, f.grid_v, f.grid_u)
    for i in range(n):
        for j in range(rows):
            w[i, j] += f.r[i, j]
    return w, outflow


@stage
def _close(w, v_wall, required, circulation, influence, solver):
    """Shed into ``w`` what no slip demands; return h^2 w, psi' at the corners and the slip.

    ``required`` (modes,) is d psi' / d eta at the membrane. Slip beyond all bounds is not shed.
    """
    f, plan = solver.fields, solver.exterior.plan
    n, rows = w.shape
    q, psi = np.empty((n, rows)), np.empty((n, rows))
    for i in range(n):
        for j in range(rows):
            q[i, j] = f.h2[i, j] * w[i, j]
    outer = n * circulation / (2.0 * np.pi)
    modes.to_modes(q, rows, f.buffers, plan, f.q_hat)
    psi_wall = modes.line_modes(v_wall, f.buffers, plan) * solver.poisson.integral
    largest = 0.0
    for exactly in (False, True):           # the second takes what the first leaves on no arc
        slip = modes.line_values(
            poisson.wall_slope(solver.poisson, f.q_hat, psi_wall, outer) - required, f.buffers,
            plan)
        fastest = _largest(slip)
        largest = max(largest, fastest) if fastest == fastest else fastest
        if not noslip.NEGLIGIBLE_SLIP < fastest < noslip.LARGEST_SLIP:
            break
        reach = noslip.remove(influence, slip, f.h2, w, q, exactly)
        modes.to_modes(q, reach, f.buffers, plan, f.q_hat)
    poisson.solve(solver.poisson, f.q_hat, psi_wall, outer, f.psi_hat)
    poisson.to_corners(solver.poisson, f.psi_hat, required, outer, f.q_hat)
    modes.to_field(f.q_hat, f.buffers, plan, psi)
    return q, psi, largest


@stage
def _largest(values):
    """Return the largest magnitude; what is no number stays one."""
    largest = 0.0
    for value in values:
        largest = abs(value) if not abs(value) <= largest else largest
    return largest

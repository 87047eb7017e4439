# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Vorticity and stream function of a state, for pictures; evaluated on demand."""

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.field import FlowField, Patch
from dewing_sim.fluid.finite_volume import mapping
from dewing_sim.fluid.finite_volume.grid import Grid
from dewing_sim.fluid.finite_volume.step import FlowState


def flow_field(grid: Grid, state: FlowState, alpha: float) -> FlowField:
    """Evaluate on the cell corners; upper and lower half are patches of their own."""
    m = mapping.metrics(grid, Wall(state.height, state.velocity))
    g = mapping.decay(grid)
    x = np.broadcast_to(grid.x[:, None], (len(grid.x), len(grid.y)))
    y = grid.y + np.outer(m.height_f, g.f)
    middle, halves = grid.middle, []
    for side in (slice(0, middle + 1), slice(middle, None)):
        halves.append(Patch(x[:, side], y[:, side], _corner_vorticity(grid, state, m, g, side)))
    stream = np.zeros(x.shape)
    stream[:, 1:] = np.cumsum(state.fx * grid.dy, axis=1)
    stream -= stream[grid.leading, middle]
    flux = state.w[:, 0] + m.velocity * g.f[0]           # the lower boundary is no streamline
    start = np.concatenate(([0.0], np.cumsum(-flux * grid.dx)))
    return FlowField(halves, [Patch(x, y, stream + (start - start[grid.leading])[:, None])],
                     alpha)


def _corner_vorticity(grid: Grid, state: FlowState, m: mapping.Metrics, g: mapping.Decay,
                      side: slice) -> np.ndarray:
    """Return v_x - u_y at the corners of one half; on the plate u_y is one-sided."""
    jacobian = 1.0 + np.outer(m.height_f, g.df)
    slope = np.outer(m.slope_f, g.f) / jacobian
    u_eta, v_xi = np.zeros((2, len(grid.x), len(grid.y)))
    u_eta[:, 1:-1] = np.diff(state.u, axis=1) / grid.dyf[1:-1]
    v_xi[1:-1] = np.diff(state.v, axis=0) / grid.dxf[1:-1, None]
    plate, middle = slice(grid.leading, grid.trailing + 1), grid.middle
    row, sign = (middle, 1.0) if side.start == middle else (middle - 1, -1.0)
    u_eta[plate, middle] = 2.0 * sign * state.u[plate, row] / grid.dy[row]
    v_eta = np.zeros_like(v_xi)
    v_eta[1:-1, 1:-1] = _across(0.5 * (state.v[1:] + state.v[:-1]), grid.y)
    return (v_xi - slope * v_eta - u_eta / jacobian)[:, side]


def _across(v: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return dv/deta at the inner faces of rows, by central differences."""
    return (v[:, 2:] - v[:, :-2]) / (y[2:] - y[:-2])

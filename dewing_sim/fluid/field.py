# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Vorticity and stream function of a saved flow, for pictures; either engine.

Coordinates are in chords in the wing frame, vorticity in U/c (counter-clockwise positive), the
stream function in U c. Each field is a list of patches, between which it may jump: both sides of
the membrane have vorticity of their own.
"""

from dataclasses import dataclass
from functools import singledispatch
from typing import Any

import numpy as np

from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal.engine import Conformal
from dewing_sim.fluid.finite_volume import mapping
from dewing_sim.fluid.finite_volume.engine import FiniteVolume


@dataclass(frozen=True)
class Patch:
    """Values at the points of a structured mesh; three arrays of one shape."""

    x: np.ndarray
    y: np.ndarray
    value: np.ndarray


@dataclass(frozen=True)
class FlowField:
    """Patches of vorticity and of the stream function."""

    vorticity: list[Patch]
    stream: list[Patch]


@singledispatch
def flow_field(fluid: Any, flow: Any) -> FlowField:
    """Return the fields of the state ``flow`` of an engine."""
    raise TypeError(f'no picture of the flow of {type(fluid).__name__}')


@flow_field.register
def _(fluid: FiniteVolume, flow: Any) -> FlowField:
    """Evaluate on the cell corners; upper and lower half are patches of their own."""
    grid, m = fluid.grid, mapping.metrics(fluid.grid, Wall(flow.height, flow.velocity))
    g = mapping.decay(grid)
    x = np.broadcast_to(grid.x[:, None], (len(grid.x), len(grid.y)))
    y = grid.y + np.outer(m.height_f, g.f)
    middle, halves = grid.middle, []
    for side in (slice(0, middle + 1), slice(middle, None)):
        halves.append(Patch(x[:, side], y[:, side], _corner_vorticity(fluid, flow, m, g, side)))
    stream = np.zeros(x.shape)
    stream[:, 1:] = np.cumsum(flow.fx * grid.dy, axis=1)
    stream -= stream[grid.leading, middle]
    flux = flow.w[:, 0] + m.velocity * g.f[0]           # the lower boundary is no streamline
    start = np.concatenate(([0.0], np.cumsum(-flux * grid.dx)))
    return FlowField(halves, [Patch(x, y, stream + (start - start[grid.leading])[:, None])])


def _corner_vorticity(fluid: FiniteVolume, flow: Any, m: mapping.Metrics, g: mapping.Decay,
                      side: slice) -> np.ndarray:
    """Return v_x - u_y at the corners of one half; on the plate u_y is one-sided."""
    grid = fluid.grid
    jacobian = 1.0 + np.outer(m.height_f, g.df)
    slope = np.outer(m.slope_f, g.f) / jacobian
    u_eta, v_xi = np.zeros((2, len(grid.x), len(grid.y)))
    u_eta[:, 1:-1] = np.diff(flow.u, axis=1) / grid.dyf[1:-1]
    v_xi[1:-1] = np.diff(flow.v, axis=0) / grid.dxf[1:-1, None]
    plate, middle = slice(grid.leading, grid.trailing + 1), grid.middle
    row, sign = (middle, 1.0) if side.start == middle else (middle - 1, -1.0)
    u_eta[plate, middle] = 2.0 * sign * flow.u[plate, row] / grid.dy[row]
    v_eta = np.zeros_like(v_xi)
    v_eta[1:-1, 1:-1] = _across(0.5 * (flow.v[1:] + flow.v[:-1]), grid.y)
    return (v_xi - slope * v_eta - u_eta / jacobian)[:, side]


def _across(v: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return dv/deta at the inner faces of rows, by central differences."""
    return (v[:, 2:] - v[:, :-2]) / (y[2:] - y[:-2])


@flow_field.register
def _(fluid: Conformal, flow: Any) -> FlowField:
    """Evaluate vorticity on the nodes and the stream function on the cell corners."""
    grid, m = fluid.grid, flow.map
    nodes, corners = grid.xi, grid.xi + 0.5 * grid.step
    stream = flow.psi + 2.0 * m.scale * np.outer(
        np.sin(corners - fluid.alpha), np.sinh(grid.face))
    return FlowField([_patch(m.places(grid.eta, nodes), flow.w)],
                     [_patch(m.places(grid.face, corners), stream)])


def _patch(place: np.ndarray, value: np.ndarray) -> Patch:
    """Return a patch that closes around the wing."""
    place, value = (np.concatenate((field, field[:1])) for field in (place, value))
    return Patch(place.real, place.imag, value)

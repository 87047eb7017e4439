# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What is computed of a state on demand: CFL numbers and pictures.

The CFL number tells how many cells the air crosses in a step on the moving map,

    dt (|V - G_V| / d_eta + |U - G_U| / d_xi) / h^2,

with the fluxes of the air and of the grid as in `transport`.  Here they are evaluated at the nodes
of a state, and the motion of the grid is its last step.
"""

import numpy as np

from dewing_sim.fluid.conformal.geometry.exterior import Exterior
from dewing_sim.fluid.conformal.geometry.mapping import Map
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.field import FlowField, Patch


def courant(exterior: Exterior, grid: Grid, psi: np.ndarray, incidence: float, now: Map,
            before: Map, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Return CFL number and distance (c) to the nearest edge of the nodes (n, rows - 1).

    ``psi`` is psi' at the corners, ``incidence`` (rad) that of the undisturbed stream.  The nodes
    on the membrane are left out: nothing is carried there.
    """
    place, (slope, motion) = now.places(grid.eta[1:], grid.xi), _rates(exterior, now, before, dt)
    v, u = _fluxes(grid, psi, incidence, now.scale)
    grid_flux = motion * np.conj(slope)
    rate = (np.abs(v - grid_flux.real) / grid.width[1:] + np.abs(u - grid_flux.imag) / grid.step)
    return (dt * rate / (slope.real**2 + slope.imag**2),
            np.minimum(np.abs(place), np.abs(place - 1.0)))


def _rates(exterior: Exterior, now: Map, before: Map, dt: float,
           ) -> tuple[np.ndarray, np.ndarray]:
    """Return z_zeta and z_t of the map, each (n, rows - 1)."""
    k = np.arange(len(now.shape))
    around, decay = np.exp(-1j * np.outer(exterior.xi, k)), exterior.decay[:, 1:]
    cos, sin = exterior.cos[:, None], exterior.sin[:, None]
    cosh = exterior.cosh[1:] * cos + 1j * exterior.sinh[1:] * sin
    sinh = exterior.sinh[1:] * cos + 1j * exterior.cosh[1:] * sin
    slope, motion = (around @ (modes[:, None] * decay) for modes in (
        -k * now.shape, (now.shape - before.shape) / dt))
    return (slope + 2.0 * now.scale * sinh,
            motion + 2.0 * (now.scale - before.scale) / dt * cosh)


def _fluxes(grid: Grid, psi: np.ndarray, incidence: float, scale: float,
            ) -> tuple[np.ndarray, np.ndarray]:
    """Return V and U (n, rows - 1) of the air, each the mean of its two faces."""
    stream = _stream(grid, psi, incidence, scale)
    v = (stream - np.roll(stream, 1, axis=0)) / grid.step
    u = -np.diff(stream, axis=1) / grid.width[1:]
    return 0.5 * (v[:, 1:] + v[:, :-1]), 0.5 * (u + np.roll(u, 1, axis=0))


def _stream(grid: Grid, psi: np.ndarray, incidence: float, scale: float) -> np.ndarray:
    """Return the stream function (n, rows) at the cell corners."""
    corner = np.sin(grid.xi + 0.5 * grid.step - incidence)
    return psi + 2.0 * scale * np.outer(corner, np.sinh(grid.face))


def flow_field(grid: Grid, vorticity: np.ndarray, psi: np.ndarray, m: Map, incidence: float,
               ) -> FlowField:
    """Return vorticity on the nodes and the stream function on the cell corners.

    The stream is the undisturbed one: a state knows the pitch of its axes, but no gust.
    """
    return FlowField([_patch(m.places(grid.eta, grid.xi), vorticity)],
                     [_patch(m.places(grid.face, grid.xi + 0.5 * grid.step),
                             _stream(grid, psi, incidence, m.scale))], incidence)


def _patch(place: np.ndarray, value: np.ndarray) -> Patch:
    """Return a patch that closes around the wing."""
    place, value = (np.concatenate((part, part[:1])) for part in (place, value))
    return Patch(place.real, place.imag, value)

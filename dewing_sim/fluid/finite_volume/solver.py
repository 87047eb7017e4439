# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What stays the same from step to step, and the fields that a step works in."""

from typing import NamedTuple

import numpy as np

from dewing_sim.fluid.finite_volume import adi, mapping, slopes, transport
from dewing_sim.fluid.finite_volume.grid import Grid, Lattice
from dewing_sim.fluid.finite_volume.poisson import Poisson
from dewing_sim.machine.kernels import scratch

UPWIND_SHARE = 0.5                  # in the far field only
UPWIND_START, UPWIND_FULL = 1.0, 4.0    # chords from the plate


class Upwind(NamedTuple):
    """Share of upwinding by the places of faces and centres: zero near the membrane."""

    x: np.ndarray
    y: np.ndarray
    xc: np.ndarray
    yc: np.ndarray


class Rates(NamedTuple):
    """Reciprocals of distances, so that no line divides by them."""

    per_dy: np.ndarray              # (ny,)
    per_dyf: np.ndarray             # (ny + 1,)
    per_two_dy: np.ndarray          # (ny + 1,) between the rows of v on both sides of one
    per_two_dyf: np.ndarray         # (ny,) and of u
    nu_per_dy: np.ndarray
    nu_per_dyf: np.ndarray
    theta_per_dy: np.ndarray
    theta_per_dyf: np.ndarray

    @classmethod
    def of(cls, grid: Grid, nu: float, theta: float) -> 'Rates':
        """Return the reciprocals for one grid, viscosity and theta."""
        per_dy, per_dyf = 1.0 / grid.dy, 1.0 / grid.dyf
        two_dy = np.concatenate(([np.inf], grid.dy[:-1] + grid.dy[1:], [np.inf]))
        return cls(per_dy, per_dyf, 1.0 / two_dy, 1.0 / (grid.dyf[:-1] + grid.dyf[1:]),
                   nu * per_dy, nu * per_dyf, theta * per_dy, theta * per_dyf)


class Fields(NamedTuple):
    """What a step needs for itself, made once.

    Those of the sweeps have lines enough for `adi.LANES` at a time, wherever a block begins.
    """

    u: np.ndarray                   # (nx + 1, ny) predicted
    v: np.ndarray                   # (nx, ny + 1) predicted
    south: np.ndarray               # (lines, ny + 1) coefficients of the neighbours in eta
    north: np.ndarray
    ratio: np.ndarray               # of the sweep in xi
    r: np.ndarray                   # right-hand side of the sweeps
    drag: np.ndarray                # (2, lines) of the plate, on its lower and upper side
    phi: np.ndarray                 # (2, ny) two lines of the pressure increment
    lines: transport.Lines
    sloped: slopes.Sloped

    @classmethod
    def of(cls, nx: int, ny: int) -> 'Fields':
        """Return fields for a grid of cells."""
        lines = nx + adi.LANES
        return cls(*scratch(1, nx + 1, ny), *scratch(1, nx, ny + 1), *scratch(4, lines, ny + 1),
                   np.zeros((2, lines)), np.zeros((2, ny)), transport.Lines.of(ny),
                   slopes.Sloped.of(nx, ny))


class Solver(NamedTuple):
    """All that stays the same from step to step."""

    nu: float
    theta: float                    # 2 dt / 3
    lattice: Lattice
    g: mapping.Decay
    upwind: Upwind
    blocked: np.ndarray             # (nx + 1,) share of the control volume of u on the plate
    rates: Rates
    following: mapping.Following
    poisson: Poisson
    impedance: np.ndarray           # added mass over theta
    order: np.ndarray               # 0 to nx, see `machine.kernels`
    fields: Fields

    @classmethod
    def of(cls, grid: Grid, nu: float, theta: float) -> 'Solver':
        """Return the solver for one grid, viscosity and time step."""
        upwind = Upwind(_upwind(np.maximum(-grid.x, grid.x - 1.0)), _upwind(np.abs(grid.y)),
                        _upwind(np.maximum(-grid.xc, grid.xc - 1.0)), _upwind(np.abs(grid.yc)))
        nx, ny, poisson = len(grid.dx), len(grid.dy), Poisson.of(grid)
        return cls(nu, theta, grid.lattice, mapping.decay(grid), upwind, blocked=_blocked(grid),
                   rates=Rates.of(grid, nu, theta), following=mapping.Following.of(grid),
                   poisson=poisson, impedance=poisson.added_mass / theta,
                   order=np.arange(nx + 1), fields=Fields.of(nx, ny))


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

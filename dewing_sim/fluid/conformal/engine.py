# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal engine: vorticity and stream function around a moving membrane.

A step extrapolates vorticity and stream function, corrects the vorticity by two implicit sweeps
(BDF2, delta form), sheds from the membrane what no slip demands, and solves for the stream
function.  The wall pressure is an affine function of the wall acceleration with the analytic added
mass, so the membrane is solved together with it.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.fluid.base import Loads, Prediction, Wall
from dewing_sim.fluid.conformal import adi, transport
from dewing_sim.fluid.conformal.edges import EdgeTable
from dewing_sim.fluid.conformal.frame import Frame
from dewing_sim.fluid.conformal.geometry import Geometry, Surroundings
from dewing_sim.fluid.conformal.grid import PRESETS, Grid
from dewing_sim.fluid.conformal.mapping import Map
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.conformal.pressure import WallPressure, force, lamb_vector
from dewing_sim.fluid.onset import Onset

NEGLIGIBLE_SLIP = 1.0e-6
LARGEST_SLIP = 1.5      # shed in one step: 0.8 at an impulsive start, 0.15 later in a sound run
PINNED = 1.0e-9         # chords


@dataclass(frozen=True)
class FlowState:
    """Everything the next step depends on; arrays over the strip are (rows, n)."""

    w: np.ndarray                   # vorticity in U / c
    q: np.ndarray                   # h^2 w
    psi: np.ndarray                 # psi' at the cell corners
    w_before: np.ndarray            # one step earlier
    q_before: np.ndarray
    psi_before: np.ndarray
    shape: np.ndarray               # the map, see `mapping.Map`
    edges: np.ndarray
    shape_before: np.ndarray
    edges_before: np.ndarray
    pressure: np.ndarray            # (n,) on the membrane, in rho U^2
    height: np.ndarray              # wall heights at the column faces
    velocity: np.ndarray            # wall velocities of the columns
    velocity_before: np.ndarray
    circulation: float              # of the wing and the wake within the grid, in U c
    incidence: float                # of the chord to the undisturbed stream, rad

    @property
    def map(self) -> Map:
        """The present map."""
        return Map(self.shape, self.edges)

    @property
    def map_before(self) -> Map:
        """The map one step earlier."""
        return Map(self.shape_before, self.edges_before)


class Conformal:
    """Incompressible Navier-Stokes flow on a conformal map, see `base.Fluid`."""

    def __init__(self, grid: Grid, reynolds: float, alpha: float, dt: float):
        """Prepare a grid for one Reynolds number, angle of attack (rad) and dt (c/U)."""
        self.grid = grid
        self.nu = 1.0 / reynolds
        self.alpha = alpha
        self.dt = dt
        self.columns = grid.columns
        self.geometry = Geometry(grid, dt)
        self.poisson = Poisson.of(grid)
        self.line = self.poisson.line
        self.edges = EdgeTable(self.poisson, self.nu, dt)
        self.wall_pressure = WallPressure.of(grid, self.nu)
        self.resistance = self._flat_resistance()
        self._sinh_face = np.sinh(grid.face)
        self._steady = Frame.of(Onset.steady(alpha), grid, self.geometry.mapping)

    @classmethod
    def preset(cls, name: str, reynolds: float, alpha: float, dt: float) -> 'Conformal':
        """Return the engine on a named grid (`grid.PRESETS`)."""
        return cls(Grid.build(PRESETS[name]), reynolds, alpha, dt)

    def rest(self, wall: Wall, circulation: float) -> FlowState:
        """Return the potential flow with the given bound circulation (U c), about to feel no slip.

        Raises `BadInput` for a wall that is not pinned at its edges.
        """
        _require_pinned(wall)
        m = self.geometry.mapping.follow(wall.height, self.geometry.mapping.flat())
        zero = np.zeros((len(self.grid.eta), len(self.grid.xi)))
        psi = zero + (circulation / (2.0 * np.pi) * self.grid.face)[:, None]
        return FlowState(zero, zero, psi, zero, zero, psi, m.shape, m.edges, m.shape, m.edges,
                         zero[0], wall.height, wall.velocity, wall.velocity, circulation,
                         self.alpha)

    def with_circulation(self, state: FlowState, circulation: float) -> FlowState:
        """Return ``state`` with another circulation, by a starting vortex at infinity."""
        return replace(state, circulation=circulation)

    def predict(self, state: FlowState, wall: Wall, onset: Onset | None = None) -> Prediction:
        """Advance vorticity and stream function with the wall at its new place and velocity."""
        _require_pinned(wall)
        frame = self._frame(onset)
        around = self.geometry.follow(wall, state.height, state.map, state.map_before)
        w, outflow = self._transport(state, around, frame)
        circulation = state.circulation + self.dt * outflow
        wall_fluxes = frame.wall_fluxes(around, wall.velocity)
        w, q, psi = self._close(w, around, frame, wall_fluxes, circulation)
        pressure = self._pressure(state, wall, around, frame, w, psi, wall_fluxes)
        after = FlowState(w, q, psi, state.w, state.q, state.psi,
                          around.map.shape, around.map.edges, state.shape, state.edges,
                          pressure, wall.height, wall.velocity, state.velocity, circulation,
                          frame.onset.incidence)
        return Prediction(wall, around.jump(pressure), (after, around))

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> FlowState:
        """Complete the step: the wall velocity that the coupling found acts by the added mass."""
        after, around = prediction.fields
        change = velocity - prediction.wall.velocity
        if not change.any():
            return after
        acceleration = 1.5 / self.dt * around.wall_fluxes(change)[1]
        pressure = after.pressure + self.wall_pressure.added_mass(acceleration)
        return replace(after, pressure=pressure, velocity=velocity)

    def loads(self, state: FlowState) -> Loads:
        """Integrate pressure and wall shear around the wing."""
        grid, m = self.grid, state.map
        place, slope = self.geometry.mapping.wall(m)
        traction = force(state.pressure, state.w[0], slope, self.nu)
        total = np.sum(traction) * grid.step * np.exp(-1j * state.incidence)
        moment = np.sum(np.conj(place - 0.25) * traction).imag * grid.step
        return Loads(self.geometry.jump(m, state.pressure), cl=2.0 * float(total.imag),
                     cd=2.0 * float(total.real), cm=-2.0 * float(moment))

    def _frame(self, onset: Onset | None) -> Frame:
        return Frame.of(onset, self.grid, self.geometry.mapping) if onset else self._steady

    def _transport(self, s: FlowState, around: Surroundings, frame: Frame,
                   ) -> tuple[np.ndarray, float]:
        """Return the vorticity before no slip and the outflow of vorticity from the grid."""
        grid = self.grid
        inertia = 1.5 / self.dt * around.h2
        w = transport.extrapolate(s.w, s.w_before, self.edges.near(around.map).share)
        psi = 2.0 * s.psi - s.psi_before
        if frame.turn:
            psi -= frame.grid_stream(around.map)
        v, u = self._fluxes(psi, around, frame)
        if around.grid_flux is not None:
            transport.subtract_grid_flux(around.grid_flux, v, u)
        r = transport.inertia(inertia, w, s.q, s.q_before, self.dt)
        outflow = transport.subtract_convection(w, v, u, grid.step, grid.width, r)
        transport.add_diffusion(w, grid.gap, grid.width, grid.step, self.nu, r)
        split = adi.split_inertia(inertia, v, u, grid.width, grid.gap, grid.step, self.nu)
        adi.sweep_eta(r, split, v, grid.width, grid.gap, self.nu)
        adi.sweep_xi(r, split, u, grid.step, self.nu)
        w += r
        return w, outflow

    def _close(self, w, around: Surroundings, frame: Frame, wall_fluxes, circulation: float):
        """Shed what no slip demands into ``w``; return vorticity, h^2 w and psi' at corners."""
        q = around.h2 * w
        q_hat = fft.rfft(q, axis=1)
        u_wall, v_wall = wall_fluxes
        psi_wall = self.poisson.wall_value(v_wall)
        required = -self.line.modes(u_wall + 2.0 * around.map.scale * frame.node)
        influence = self.edges.near(around.map).influence
        for exactly in (False, True):       # the second takes what the first leaves on no arc
            slip = self.line.values(
                self.poisson.wall_slope(q_hat, psi_wall, circulation) - required)
            if _fastest(slip) <= NEGLIGIBLE_SLIP:
                break
            reach = influence.remove(slip, around.h2, w, q, exactly)
            q_hat[:reach] = fft.rfft(q[:reach], axis=1)
        psi_hat = self.poisson.solve(q_hat, psi_wall, circulation)
        return w, q, fft.irfft(self.poisson.corners(psi_hat, required, circulation), axis=1)

    def _pressure(self, s: FlowState, wall: Wall, around: Surroundings, frame: Frame, w, psi,
                  wall_fluxes) -> np.ndarray:
        """Return the wall pressure (n,), less that which accelerates the stream or the frame."""
        v, u = self._fluxes(psi, around, frame)
        u_wall, v_wall = wall_fluxes
        acceleration = (3.0 * wall.velocity - 4.0 * s.velocity + s.velocity_before
                        ) / (2.0 * self.dt)
        flux = (around.wall_fluxes(acceleration)[1]
                + frame.acceleration(around, wall.velocity))
        head = self.wall_pressure(w, lamb_vector(w, v, u, v_wall, u_wall), flux)
        return head - 0.5 * frame.wall_speed(around, wall.velocity)**2

    def _fluxes(self, psi: np.ndarray, around: Surroundings, frame: Frame,
                ) -> tuple[np.ndarray, np.ndarray]:
        return transport.fluxes(psi, 2.0 * around.map.scale * self._sinh_face, frame.corner,
                                self.grid.step, self.grid.width)

    def _flat_resistance(self) -> np.ndarray:
        """Return 3 / (2 dt) times the added mass of the flat plate between its columns."""
        flat = self.geometry.at_rest(self.geometry.mapping.flat())
        jumps = [flat.jump(self.wall_pressure.added_mass(flat.wall_fluxes(column)[1]))
                 for column in np.eye(len(self.columns) - 1)]
        return -1.5 / self.dt * np.array(jumps).T


def _fastest(slip: np.ndarray) -> float:
    """Return the largest slip; raise `Diverged` if it is beyond all bounds."""
    fastest = float(np.abs(slip).max())
    if not fastest < LARGEST_SLIP:
        raise Diverged(f'the flow slips along the membrane at {fastest:.3g} free-stream speeds: '
                       'lower the time step or take a coarser grid')
    return fastest


def _require_pinned(wall: Wall) -> None:
    ends = (wall.height[0], wall.height[-1], *wall.edge_velocity)
    if max(map(abs, ends)) > PINNED:
        raise BadInput('the conformal engine needs a membrane whose edges stay at y = 0')

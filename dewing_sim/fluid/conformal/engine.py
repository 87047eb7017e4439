# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal engine: vorticity and stream function around a moving membrane.

A step extrapolates vorticity and stream function, corrects the vorticity by two implicit sweeps
(BDF2, delta form), sheds from the membrane what no slip demands, and solves for the stream
function.  The wall pressure is an affine function of the wall acceleration with the analytic added
mass, so the membrane is solved together with it.
"""

import cmath
import math
from dataclasses import replace

import numpy as np

from dewing_sim.errors import BadInput, DewingError, Diverged
from dewing_sim.fluid.base import INFLOWS, Demand, Fluid, Loads, Monitor, Prediction, Wall
from dewing_sim.fluid.conformal import diagnostics, noslip, step
from dewing_sim.fluid.conformal.geometry.frame import Frame
from dewing_sim.fluid.conformal.geometry.wall import Geometry
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.noslip import EdgeTable
from dewing_sim.fluid.conformal.presets import NAME, PRESETS
from dewing_sim.fluid.conformal.pressure import added_mass, completed, force
from dewing_sim.fluid.conformal.state import FlowState, Predicted
from dewing_sim.fluid.field import FlowField
from dewing_sim.fluid.inflow import Inflow
from dewing_sim.machine.resident import hold

PINNED = 1.0e-7         # chords: springs that hold an edge give way by q c over the bulk modulus
VERIFIED = {            # up to the time step, which its grid limits
    'camber': (0.0, 0.15),                  # chords
    'Reynolds number': (100.0, 10000.0),
    'angle of attack in deg': (0.0, 12.0),
}


class Conformal(Fluid):
    """Incompressible Navier-Stokes flow on a conformal map, see `base.Fluid`."""

    name, grids, state, inflows = NAME, PRESETS, FlowState, INFLOWS

    def __init__(self, grid: Grid, reynolds: float, alpha: float, dt: float,
                 largest_dt: float = math.inf):
        """Prepare a grid for one Reynolds number, angle of attack (rad) and dt (c/U).

        A failure names ``largest_dt``, the largest step known to be sound, if ``dt`` exceeds it.
        """
        self.grid = grid
        self.largest_dt = largest_dt
        self.nu = 1.0 / reynolds
        self.alpha = alpha
        self.dt = dt
        self.columns = grid.columns
        self.solver = step.Solver.of(grid, self.nu, dt)
        self._resident = hold(self.solver)
        self.geometry = Geometry(self.solver.exterior, dt)
        self.edges = EdgeTable(grid, self.solver.poisson, self.nu, dt)
        self.impedance = self._flat_impedance()
        self._steady = Frame.of(Inflow.steady(alpha), grid)

    @classmethod
    def preset(cls, name: str, reynolds: float, alpha: float, dt: float) -> 'Conformal':
        """Return the engine on a named grid (`PRESETS`)."""
        return cls(Grid.build(PRESETS[name]), reynolds, alpha, dt, PRESETS[name].largest_step)

    @classmethod
    def obstacle(cls, demand: Demand) -> str | None:
        """Return which value of ``demand`` is outside what has been verified, None if none is."""
        values = (abs(demand.camber), demand.reynolds, abs(math.degrees(demand.alpha)), demand.dt)
        ranges = VERIFIED | {'time step in c/U': (0.0, PRESETS[demand.grid].largest_step)}
        for value, (name, (low, high)) in zip(values, ranges.items(), strict=True):
            if not low <= value <= high:
                return f'a {name} of {value:.4g} is outside {low:g} to {high:g}'
        return None

    @property
    def cells(self) -> int:
        """Number of nodes, each in a cell."""
        return self.grid.cells

    def rest(self, wall: Wall, circulation: float) -> FlowState:
        """Return the potential flow with the given bound circulation (U c), about to feel no slip.

        Raises `BadInput` for a wall that is not pinned at its edges.
        """
        _require_pinned(wall)
        m = self.geometry.mapping.follow(wall.height, self.geometry.mapping.flat())
        zero = np.zeros((len(self.grid.xi), len(self.grid.eta)))
        psi = zero + circulation / (2.0 * np.pi) * self.grid.face
        return FlowState(
            w=zero, q=zero, psi=psi, w_before=zero, q_before=zero, psi_before=psi,
            shape=m.shape, edges=m.edges, shape_before=m.shape, edges_before=m.edges,
            pressure=zero[:, 0].copy(), height=wall.height, velocity=wall.velocity,
            velocity_before=wall.velocity, circulation=circulation, incidence=self.alpha, slip=0.0)

    def with_circulation(self, state: FlowState, circulation: float) -> FlowState:
        """Return ``state`` with another circulation, by a starting vortex at infinity."""
        return replace(state, circulation=circulation)

    def predict(self, state: FlowState, wall: Wall, inflow: Inflow | None = None) -> Prediction:
        """Advance vorticity and stream function with the wall at its new place and velocity.

        Raises `Diverged` if an edge of the wall leaves the chord.
        """
        _require_pinned(wall, Diverged)
        frame = Frame.of(inflow, self.grid) if inflow else self._steady
        around = self.geometry.follow(wall, state.height, state.map, state.map_before)
        edges = self.edges.near(around.map)
        motion = frame.wall_motion(around, wall.velocity, state.velocity, state.velocity_before,
                                   self.dt)
        w, q, psi, pressure, circulation, slip = step.advance(
            self._resident, edges, *state.past, *around.map, around.shape_rate, around.scale_rate,
            *frame.stream(around.map), *motion)
        self._require_hold(slip, state)
        fields = Predicted(before=state, around=around, w=w, q=q, psi=psi, pressure=pressure,
                           circulation=circulation, incidence=frame.inflow.incidence, slip=slip)
        return Prediction(wall, around.jump(pressure), fields)

    def correct(self, prediction: Prediction, velocity: np.ndarray) -> FlowState:
        """Complete the step: the wall velocity that the coupling found acts by the added mass."""
        p, wall = prediction.fields, prediction.wall
        line, now = p.around.line, p.before
        pressure = completed(
            p.pressure, velocity, wall.velocity, self.solver.wall_pressure.added_mass, self.dt,
            line.angles, line.slope)
        return FlowState(
            w=p.w, q=p.q, psi=p.psi, w_before=now.w, q_before=now.q, psi_before=now.psi,
            shape=p.around.map.shape, edges=p.around.map.edges, shape_before=now.shape,
            edges_before=now.edges, pressure=pressure, height=wall.height, velocity=velocity,
            velocity_before=now.velocity, circulation=p.circulation, incidence=p.incidence,
            slip=p.slip)

    def loads(self, state: FlowState) -> Loads:
        """Integrate pressure and wall shear around the wing."""
        around = self.geometry.at_rest(state.map)
        total, moment = force(state.pressure, state.w, around.line.place, around.line.slope,
                              self.nu, self.grid.step)
        total *= cmath.exp(-1j * state.incidence)
        return Loads(around.jump(state.pressure), cl=2.0 * total.imag, cd=2.0 * total.real,
                     cm=-2.0 * moment)

    def slip(self, state: FlowState) -> float:
        """Return the largest slip shed in the last step, in U: 0 at rest."""
        return state.slip

    def monitor(self, state: FlowState) -> Monitor:
        """Return CFL numbers and slip of a state, in the stream without gust, heave and pitch.

        Next to an edge the cells shrink with h while the air stays fast: some tens are sound
        there, as the sweeps are implicit.  The slip grows before a flow becomes unstable.
        """
        numbers, distance = diagnostics.courant(
            self.solver.exterior, self.grid, state.psi, state.incidence, state.map,
            state.map_before, self.dt)
        return Monitor.of(numbers, distance, state.slip)

    def caution(self, state: FlowState) -> str:
        """Return a warning of a flow that slips half as fast as what stops a run."""
        if state.slip <= noslip.HIGH_SLIP:
            return ''
        return (f'the flow slips along the membrane at {state.slip:.3g} free-stream speeds, half '
                f'of what stops a run is {noslip.HIGH_SLIP:g}: lower the time step')

    def field(self, state: FlowState) -> FlowField:
        """Return vorticity on the nodes and the stream function on the cell corners."""
        return diagnostics.flow_field(self.grid, state.w, state.psi, state.map, state.incidence)

    def suction(self, state: FlowState) -> tuple[np.ndarray, np.ndarray]:
        """Return x and the clockwise wall vorticity of the upper side, from the leading edge."""
        upper = slice(len(self.grid.xi) // 2 - 1, None, -1)
        place = self.geometry.mapping.wall(state.map).place
        return place.real[upper], -state.w[upper, 0]

    def _require_hold(self, slip: float, before: FlowState) -> None:
        """Raise `Diverged` if the flow slips faster than any sound run (or is no number)."""
        if slip < noslip.LARGEST_SLIP:
            return
        limit = (f', now {self.dt:.3g} c/U where this grid bears {self.largest_dt:.3g},'
                 if self.dt > self.largest_dt else '')
        raise Diverged(f'the flow slips along the membrane at {slip:.3g} free-stream speeds, '
                       f'at a CFL number of {self.monitor(before).edge_courant:.3g} next to the '
                       f'edges: lower the time step{limit} or take a coarser grid')

    def _flat_impedance(self) -> np.ndarray:
        """Return 3 / (2 dt) times the added mass of the flat plate between its columns."""
        flat = self.geometry.at_rest(self.geometry.mapping.flat())
        jumps = []
        for column in np.eye(len(self.columns) - 1):
            jumps.append(flat.jump(added_mass(
                self.solver.wall_pressure.added_mass, column, self.dt, flat.line.angles,
                flat.line.slope)))
        return -np.array(jumps).T


def _require_pinned(wall: Wall, kind: type[DewingError] = BadInput) -> None:
    """Raise an error of ``kind`` unless the edges are at rest on the chord."""
    height, (leading, trailing) = wall.height, wall.edge_velocity
    most = max(abs(height[0]), abs(height[-1]), abs(leading), abs(trailing))
    if most > PINNED:
        raise kind('the conformal engine needs a membrane whose edges stay at y = 0; here one '
                   f'leaves it by {most:.2g} chords')

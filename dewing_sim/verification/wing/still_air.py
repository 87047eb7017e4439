# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plucked membrane in nearly still air: its frequencies prove the coupling and added mass."""

from dataclasses import dataclass

import numpy as np

from dewing_sim import parameters
from dewing_sim.fluid.base import Wall
from dewing_sim.inputs.base import Inputs
from dewing_sim.state import State
from dewing_sim.structure.dynamics.step import Motion
from dewing_sim.verification.closed_forms import frequencies_in_air
from dewing_sim.verification.fluid.rigid_flow import step_cost
from dewing_sim.verification.signals import ringing
from dewing_sim.verification.study import Check, Study
from dewing_sim.wing import Wing

SLOW = 0.03                         # m/s, a stream too slow to matter
AMPLITUDE = 1.0e-4                  # chords
MODES = 3
EXACT = 'Galerkin, strip in potential flow'


@dataclass(frozen=True)
class Ringing:
    """Frequencies and their closed forms in Hz, damping ratios, mass ratio m / (rho c)."""

    mass_ratio: float
    frequency: np.ndarray
    exact: np.ndarray
    damping: np.ndarray
    time: np.ndarray
    modes: np.ndarray               # (steps, MODES) amplitudes in chords


@dataclass(frozen=True)
class PluckRun:
    """The `paper` membrane released from a mix of three sine modes."""

    engine: str
    grid: str
    density: float                  # kg/m^3 of the elastomer
    duration: float                 # s
    dt: float = 2.5e-5              # s

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return 2.0 * step_cost(self.engine, self.grid) * self.duration / self.dt

    def __call__(self) -> Ringing:
        """Release, march, and fit the free oscillation."""
        wing = Wing(parameters.load('paper', changes={
            'flow.speed': SLOW, 'flow.angle_of_attack_deg': 0.0,
            'membrane.density': self.density, 'numerics.engine': self.engine,
            'numerics.grid': self.grid, 'numerics.time_step': self.dt}))
        x = wing.membrane.rest_position[:, 0]
        shapes = np.sin(np.pi * np.outer(x, np.arange(1, MODES + 1)))
        state, rows = _released(wing, shapes), []
        for _ in range(round(self.duration / self.dt)):
            state = wing.step(state, Inputs(0.0))
            rows.append(2.0 * state.motion.position[:, 1] @ shapes / (len(x) - 1))
        return self._fit(wing, np.array(rows))

    def _fit(self, wing: Wing, modes: np.ndarray) -> Ringing:
        membrane, scales = wing.membrane, wing.scales
        mass_ratio = float(membrane.mass.sum())
        tension = float(membrane.tension(membrane.rest_position, 0.0)[0])
        exact = frequencies_in_air(tension, mass_ratio, MODES) / scales.time
        every = max(1, round(0.04 / (exact[-1] * self.dt)))     # 25 samples a period
        values = ringing(modes[::every], every * self.dt)[:MODES]
        return Ringing(mass_ratio, values.imag / (2.0 * np.pi), exact,
                       -values.real / np.abs(values), self.dt * np.arange(1, len(modes) + 1),
                       modes)


def _released(wing: Wing, shapes: np.ndarray) -> State:
    position = wing.membrane.rest_position.copy()
    position[:, 1] = AMPLITUDE * shapes @ (1.0 / np.arange(1, shapes.shape[1] + 1)**2)
    height = np.interp(wing.fluid.columns, position[:, 0], position[:, 1])
    wall = Wall(height, np.zeros(len(height) - 1))
    return State(0, 0.0, wing.fluid.rest(wall, 0.0), Motion.at_rest(position))


def runs(engine: str, quick: bool) -> dict[str, PluckRun]:
    """Return the paper's membrane and lighter ones."""
    if quick:
        return {'960': PluckRun(engine, 'fast', 960.0, 0.04, 5.0e-5),
                '33': PluckRun(engine, 'fast', 33.0, 0.03, 5.0e-5)}
    return {f'{density:g}': PluckRun(engine, 'standard', density, 0.06)
            for density in (960.0, 240.0, 33.0)}


def checks(engine: str, results: dict[str, Ringing]) -> list[Check]:
    """Judge three frequencies at every mass ratio."""
    return [Check(f'pluck in still air, mass ratio {result.mass_ratio:.2g}: f{n + 1} in Hz',
                  engine, result.frequency[n], float(result.exact[n]), EXACT, 0.02)
            for result in results.values() for n in range(MODES)]


STUDY = Study(
    'still_air', 'Frequencies in still air, down to a mass ratio of 0.03',
    'The `paper` membrane is released in a stream of 0.03 m/s. Its first three frequencies follow '
    'from tension, mass and added mass. A loosely coupled scheme fails where the membrane is '
    "lighter than the air it moves. The rest of the difference is the air's viscosity.",
    runs, checks)

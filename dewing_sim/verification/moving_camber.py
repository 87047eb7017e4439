# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A parabolic camber that is forced to oscillate."""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.verification.rigid_flow import SPEED, march, parabola
from dewing_sim.verification.study import Check, Study

REFERENCE = 0.4577 - 0.0791j
SOURCE = 'conformal-map vorticity code (study, not published)'


@dataclass(frozen=True)
class ForcedCamberRun:
    """Camber f + a sin(2 pi St t) at 4 degrees; returns t*, Cl and the complex response.

    The response is Cl = Re-part sin + Im-part cos, fitted over the last half of the periods.
    """

    engine: str
    grid: str
    periods: int
    steps: int = 170                # in a period
    mean: float = 0.01
    amplitude: float = 0.005
    strouhal: float = 1.44

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return SPEED[self.grid] * self.periods * self.steps

    def __call__(self) -> tuple[np.ndarray, np.ndarray, complex]:
        """March whole periods."""
        omega = 2.0 * np.pi * self.strouhal
        dt = 1.0 / (self.strouhal * self.steps)
        alpha = np.radians(4.0)
        fluid = engines.make(self.engine, self.grid, 2500.0, alpha, dt)

        def wall(time: float):
            return parabola(fluid.columns, self.mean + self.amplitude * np.sin(omega * time),
                            self.amplitude * omega * np.cos(omega * time))

        history = [(time, fluid.loads(flow).cl) for time, flow in march(
            fluid, wall, self.periods / self.strouhal, 0.5 * 0.42)]
        time, cl = np.array(history).T
        late = slice(self.periods // 2 * self.steps, None)
        return time, cl, response(time[late], cl[late], omega)


def response(time: np.ndarray, signal: np.ndarray, omega: float) -> complex:
    """Return the parts of ``signal`` in phase with sin and cos, its drift apart."""
    basis = np.column_stack([np.ones_like(time), time, np.sin(omega * time),
                             np.cos(omega * time)])
    (_, _, sine, cosine), *_ = np.linalg.lstsq(basis, signal, rcond=None)
    return complex(sine, cosine)


def runs(engine: str, quick: bool) -> dict[str, ForcedCamberRun]:
    """Return the forced oscillation on one grid, or on two."""
    if quick:
        return {'standard': ForcedCamberRun(engine, 'standard', 16)}
    return {'standard': ForcedCamberRun(engine, 'standard', 30),
            'fine': ForcedCamberRun(engine, 'fine', 16, steps=300)}


def checks(engine: str, results: dict[str, tuple[np.ndarray, np.ndarray, complex]],
           ) -> list[Check]:
    """Judge both parts of the response against the amplitude of the reference."""
    size = abs(REFERENCE)
    found = []
    for grid, (_, _, value) in results.items():
        gate = 0.02 if grid == 'standard' else None
        found += [
            Check(f'forced camber, {grid} grid: Cl in phase, over amplitude', engine, value.real,
                  REFERENCE.real, SOURCE, gate, size),
            Check(f'forced camber, {grid} grid: Cl in quadrature, over amplitude', engine,
                  value.imag, REFERENCE.imag, SOURCE, gate, size),
            Check(f'forced camber, {grid} grid: distance in the complex plane, over amplitude',
                  engine, abs(value - REFERENCE), 0.0, SOURCE, None, size),
        ]
    return found


STUDY = Study(
    'moving_camber', 'Forced camber',
    'A parabolic plate at 4 degrees whose camber is 1 % + 0.5 % sin(2 pi St t) at St = 1.44, '
    'close to the first mode of the `paper` membrane. Both parts of the complex response are '
    'judged by the amplitude of the reference; the third row states their distance in full.',
    runs, checks)

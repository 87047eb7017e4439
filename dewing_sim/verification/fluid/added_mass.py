# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The added mass that the coupling uses, against potential flow past a strip."""

from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.verification.closed_forms import strip_added_mass
from dewing_sim.verification.study import Check, Study

GRIDS = ('fast', 'standard', 'fine')
MODES = 3
EXACT = 'potential flow past a strip'


@dataclass(frozen=True)
class AddedMassRun:
    """The added-mass matrix of an engine; returns column faces and symmetric form (n, n)."""

    engine: str
    grid: str

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return 300.0

    def __call__(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the faces x (n + 1,) and dx_i dF_i/da_j in rho c^2."""
        fluid = engines.make(self.engine, self.grid, 2500.0, 0.0, 0.004)
        mass = fluid.impedance * (2.0 * fluid.dt / 3.0)
        return fluid.columns, np.diff(fluid.columns)[:, None] * mass


def runs(engine: str, quick: bool) -> dict[str, AddedMassRun]:
    """Return every grid preset."""
    return {grid: AddedMassRun(engine, grid) for grid in GRIDS}


def sine(columns: np.ndarray, n: int) -> np.ndarray:
    """Return the column averages of sin(n pi x)."""
    return -np.diff(np.cos(n * np.pi * columns)) / (n * np.pi * np.diff(columns))


def checks(engine: str, results: dict[str, tuple[np.ndarray, np.ndarray]]) -> list[Check]:
    """Judge heave, sine modes and symmetry."""
    found = [Check(f'added mass of heave, {grid} grid', engine, results[grid][1].sum(),
                   np.pi / 4.0, EXACT, 0.01 if grid != 'fast' else 0.02) for grid in GRIDS]
    columns, mass = results['standard']
    exact = 2.0 * np.diag(strip_added_mass(MODES))
    found += [Check(f'added mass of sine mode {n}', engine,
                    2.0 * sine(columns, n) @ mass @ sine(columns, n), exact[n - 1], EXACT, 0.005)
              for n in range(1, MODES + 1)]
    least = np.linalg.eigvalsh(0.5 * (mass + mass.T)).min()
    return found + [
        Check('added mass: asymmetry over largest entry', engine,
              np.abs(mass - mass.T).max() / np.abs(mass).max(), 0.0, 'reciprocity', 1.0e-9, 1.0),
        Check('added mass: share of negative eigenvalues', engine,
              max(0.0, -least) / np.abs(mass).max(), 0.0, 'kinetic energy is positive',
              1.0e-9, 1.0),
    ]


STUDY = Study(
    'added_mass', 'Added mass',
    'The pressure jump per wall acceleration, as it enters the coupled step. Heave displaces '
    'pi/4 rho c^2; sine modes are per unit modal mass.',
    runs, checks)

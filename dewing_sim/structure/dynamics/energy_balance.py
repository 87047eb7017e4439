# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where the energy of a moving structure comes from and where it goes, per unit span."""

from typing import NamedTuple, Protocol

import numpy as np

from dewing_sim.structure.base import Structure


class State(Protocol):
    """A motion at one time, nodal arrays (nodes, 2)."""

    position: np.ndarray
    velocity: np.ndarray


class Balance(NamedTuple):
    """Changes of stored energy, work done on the structure and loss, over steps; they add up.

    ``elastic + electric + kinetic + dissipation = source + load``.
    """

    elastic: float = 0.0
    electric: float = 0.0           # C V^2 / 2
    kinetic: float = 0.0
    source: float = 0.0             # work of the voltage source, sum of V dQ
    load: float = 0.0               # work of the aerodynamic or other external forces
    dissipation: float = 0.0        # lost to (or, if negative, made by) the time scheme

    def plus(self, other: 'Balance') -> 'Balance':
        """Return the sums."""
        return Balance(*(a + b for a, b in zip(self, other)))

    @property
    def error(self) -> float:
        """What is missing, relative to the largest entry; zero if nothing moved."""
        missing = (self.elastic + self.electric + self.kinetic + self.dissipation
                   - self.source - self.load)
        largest = max(abs(part) for part in self)
        return abs(missing) / largest if largest else 0.0


def balance(structure: Structure, before: State, after: State, v_squared_before: float,
            v_squared: float, acceleration: np.ndarray, internal: np.ndarray, load: np.ndarray,
            ) -> Balance:
    """Return the balance of one step that solved M acceleration + internal = load.

    The voltage jumps at the start of the step and is held. ``acceleration``, ``internal`` and
    ``load`` (nodes, 2) are those that the scheme put into its momentum equation; the difference
    between their work along the step and the changes of energy is the scheme's dissipation.
    """
    step = after.position - before.position
    start = structure.energies(before.position, v_squared_before)
    charged = structure.energies(before.position, v_squared)
    end = structure.energies(after.position, v_squared)
    kinetic = _kinetic(structure, after) - _kinetic(structure, before)
    # At constant voltage the source gives V dQ = d(C V^2), half of which is stored.
    source = sum(charged) - sum(start) + 2.0 * (end[1] - charged[1])
    potential = (end[0] - end[1]) - (charged[0] - charged[1])
    work = float(np.sum(step * (internal + structure.mass[:, None] * acceleration)))
    return Balance(end[0] - start[0], end[1] - start[1], kinetic, source,
                   float(np.sum(step * load)), work - potential - kinetic)


def _kinetic(structure: Structure, state: State) -> float:
    return 0.5 * float(np.sum(structure.mass[:, None] * state.velocity ** 2))

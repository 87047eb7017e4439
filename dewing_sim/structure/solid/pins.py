# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How a strip of solid elements is held at its edges.

`LOWER` pins the lower side of the edges, as in the paper. `MIDDLE` holds them at mid-height, like
a membrane: stiff springs hold the mean of both sides and leave the edge free to turn.
"""

import numpy as np

LOWER, MIDDLE = 'lower', 'middle'
_ENDS = ((0, 1), (-2, -1))      # bottom and top nodes of the edges


def equations(elements: int, support: str) -> np.ndarray:
    """Return the number of each coordinate among the free ones, -1 at pins: (n+1, 2, 2)."""
    fixed = np.zeros((elements + 1, 2, 2), dtype=bool)
    if support == LOWER:
        fixed[[0, -1], 0] = True
    return np.where(fixed, -1, np.cumsum(~fixed).reshape(fixed.shape) - 1)


def mid_plane_weights(elements: int, support: str) -> np.ndarray:
    """Return the weights of bottom and top in the mid-plane with the pins at its ends."""
    share = np.full((elements + 1, 2), 0.5)
    if support == LOWER:
        share[[0, -1]] = 1.0, 0.0
    return share


class Springs:
    """Springs from the middle of each edge to the pins; at rest they carry the tension.

    ``stiffness`` is a force per unit span and length; with the bulk modulus the edges give way
    by a ten-thousandth of the thickness.
    """

    def __init__(self, rest_position: np.ndarray, tension: float, stiffness: float):
        """Anchor the springs so that ``rest_position`` (2(n+1), 2) is in equilibrium."""
        self.stiffness = stiffness
        stretched = np.array([[tension / stiffness, 0.0], [-tension / stiffness, 0.0]])
        self.anchor = _middles(rest_position) - stretched

    def add_force(self, force: np.ndarray, position: np.ndarray) -> None:
        """Add the gradient of the springs' energy to nodal forces (2(n+1), 2)."""
        half = 0.5 * self.stiffness * (_middles(position) - self.anchor)
        for nodes, share in zip(_ENDS, half):
            force[list(nodes)] += share

    def add_stiffness(self, band: np.ndarray) -> None:
        """Add its Hessian to a band (2 w + 1, m) in which every coordinate is free."""
        middle, m = len(band) // 2, band.shape[1]
        for start in (0, m - 4):
            band[middle, start:start + 4] += 0.25 * self.stiffness
            band[middle - 2, start + 2:start + 4] += 0.25 * self.stiffness
            band[middle + 2, start:start + 2] += 0.25 * self.stiffness

    def energy(self, position: np.ndarray) -> float:
        """Return the energy of the springs per unit span."""
        change = _middles(position) - self.anchor
        return 0.5 * self.stiffness * float(np.sum(change ** 2))


def _middles(position: np.ndarray) -> np.ndarray:
    """Return the middles of both edges, (2, 2)."""
    return np.array([0.5 * (position[a] + position[b]) for a, b in _ENDS])

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Kinetic energies of a perturbation, by which a mode is called one of the membrane or of the air.

Per unit span in rho U^2 c^2: 1/2 sum m |v|^2 over the nodes of the membrane, and for the air
1/2 integral |grad psi|^2 dA over the grid, from the perturbation of the stream function on its
mesh. The mesh is that of the base, so the share of air that a moving wall displaces is left out.
"""

import numpy as np

from dewing_sim.fluid.field import Patch
from dewing_sim.state import State
from dewing_sim.wing import Wing


def membrane(wing: Wing, velocity: np.ndarray) -> tuple[float, float]:
    """Return the energies of motion along the chord and across it of ``velocity`` (nodes, 2)."""
    along, across = 0.5 * wing.membrane.mass @ np.abs(velocity)**2
    return float(along), float(across)


def air(wing: Wing, ahead: State, behind: State) -> float:
    """Return the energy of half the difference of two states; 0 without a picture."""
    fields = [wing.fluid.field(state.flow) for state in (ahead, behind)]
    if fields[0] is None:
        return 0.0
    return sum(_energy(one, 0.5 * (one.value - other.value))
               for one, other in zip(fields[0].stream, fields[1].stream, strict=True))


def _energy(mesh: Patch, psi: np.ndarray) -> float:
    """Return 1/2 sum |grad psi|^2 J over the cells of a structured mesh."""
    x_a, x_b, y_a, y_b, p_a, p_b = (
        part for values in (mesh.x, mesh.y, psi) for part in _differences(values))
    jacobian = x_a * y_b - x_b * y_a
    square = (y_b * p_a - y_a * p_b)**2 + (x_a * p_b - x_b * p_a)**2
    cells = np.abs(jacobian) > 0.0
    return float(0.5 * np.sum(square[cells] / np.abs(jacobian[cells])))


def _differences(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the differences along both directions of a mesh at its cell centres."""
    first, second = np.diff(values, axis=0), np.diff(values, axis=1)
    return 0.5 * (first[:, 1:] + first[:, :-1]), 0.5 * (second[1:] + second[:-1])

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the air does to the wing: the pressure jump and its integrals with the wall shear."""

import numpy as np

from dewing_sim.machine.kernels import kernel


@kernel
def jump_of(p, lattice):
    """Return the pressure jump, below minus above, of the columns on the plate."""
    middle = len(lattice.dy) // 2
    jump = np.empty(lattice.trailing - lattice.leading)
    for k in range(jump.size):
        i = lattice.leading + k
        jump[k] = p[i, middle - 1] - p[i, middle]
    return jump


@kernel
def integrate(solver, u, p, height, arms):
    """Return the jump and the force along and across the chord, and the moment about c/4.

    ``solver`` holds the `Solver`, ``arms`` (columns,) are the distances of the columns behind
    c/4. Forces are in rho U^2 c, the moment, nose up, in rho U^2 c^2.
    """
    solver = solver.value
    lattice, dgc, jump = solver.lattice, solver.g.dc, jump_of(p, solver.lattice)
    middle, axial, normal, moment = len(lattice.dy) // 2, 0.0, 0.0, 0.0
    for k in range(jump.size):
        force = jump[k] * lattice.dx[lattice.leading + k]
        normal += force
        moment -= force * arms[k]
        axial -= jump[k] * (height[k + 1] - height[k])
    for k in range(height.size):
        i = lattice.leading + k
        below = u[i, middle - 1] / (1.0 + height[k] * dgc[middle - 1])
        above = u[i, middle] / (1.0 + height[k] * dgc[middle])
        axial += (solver.nu * (below + above) / (0.5 * lattice.dy[middle])
                  * solver.blocked[i] * lattice.dxf[i])
    return jump, axial, normal, moment

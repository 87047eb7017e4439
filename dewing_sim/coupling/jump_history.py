# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The past pressure jumps of a wall that does not accelerate, and what they foretell.

Sums are written out, so that no BLAS changes a bit of the next step, nor takes time to wake up.
"""

import numpy as np

from dewing_sim.machine.kernels import checked_kernel

REMEMBERED = 3


@checked_kernel
def extrapolated(history):
    """Return the next jump (columns,) after the past ones (1 to 3, columns), newest first."""
    jump = np.empty(history.shape[1])
    for i in range(jump.size):
        if history.shape[0] == 1:
            jump[i] = history[0, i]
        elif history.shape[0] == 2:
            jump[i] = 2.0 * history[0, i] - history[1, i]
        else:
            jump[i] = 3.0 * history[0, i] - 3.0 * history[1, i] + history[2, i]
    return jump


@checked_kernel
def remembered(history, jump, velocity, coasting, impedance):
    """Return the history with the ``jump`` at a wall velocity, less the added mass, before it.

    What the wall would have felt had it coasted is jump + impedance (velocity - coasting), all
    (columns,).
    """
    kept = min(history.shape[0], REMEMBERED - 1)
    found = np.empty((kept + 1, jump.size))
    for i in range(jump.size):
        found[0, i] = jump[i]
        for k in range(kept):
            found[k + 1, i] = history[k, i]
    for j in range(jump.size):
        change = velocity[j] - coasting[j]
        for i in range(jump.size):
            found[0, i] += impedance[i, j] * change
    return found

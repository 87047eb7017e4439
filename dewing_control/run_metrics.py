# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A run in a few numbers, the same wherever a wing is simulated."""

from dewing_sim.history import History


def averages(late: History, reference_deflection: float) -> dict[str, float]:
    """Return time averages of the part of a run that is averaged, in SI units.

    ``y_star`` is the largest camber over ``reference_deflection`` (m), y_ref = q c^2 / (8 T0);
    ``cl_rms`` is the standard deviation of Cl.
    """
    camber_max = float(late.camber_max.mean())
    return {
        'cl_mean': float(late.cl.mean()), 'cl_rms': float(late.cl.std()),
        'cd_mean': float(late.cd.mean()), 'cm_mean': float(late.cm.mean()),
        'y_star': camber_max / reference_deflection, 'camber_max': camber_max,
        'camber_max_x_c': float(late.camber_max_position.mean()),
        'camber_mean': float(late.camber_mean.mean()), 'tension': float(late.tension.mean()),
        'coupling_iterations_mean': float(late.coupling_iterations.mean()),
    }

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A run in a few numbers, the same wherever a wing is simulated."""

from typing import Any

from dewing_sim.fluid.base import Fluid
from dewing_sim.records.history import History

INSTANTS = 10           # at most, whose CFL numbers are evaluated


class Watch:
    """How near its limits the flow came: the slip of every step, CFL numbers at some instants.

    The latter are evaluated after the run, so that they take nothing of its time.
    """

    def __init__(self, fluid: Fluid, steps: int):
        """Watch a run of ``steps`` steps at most."""
        self._fluid, self._every = fluid, -(-steps // INSTANTS)
        self._made, self._slip, self._kept = 0, 0.0, []

    def add(self, flow: Any) -> None:
        """Note the flow after a step."""
        self._slip = max(self._slip, self._fluid.slip(flow))
        if self._made % self._every == 0:
            self._kept.append(flow)
        self._made += 1

    def metrics(self) -> dict[str, float]:
        """Return the largest slip (U) and CFL numbers, see `dewing_sim.fluid.base.Monitor`."""
        monitors = [self._fluid.monitor(flow) for flow in self._kept]
        return {'slip_max': self._slip,
                'courant_max': max(monitor.courant for monitor in monitors),
                'edge_courant_max': max(monitor.edge_courant for monitor in monitors)}


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

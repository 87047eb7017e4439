# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A run in a few numbers, the same wherever a wing is simulated."""

from typing import Any

from dewing_sim.fluid.base import Fluid
from dewing_sim.records.history import History

INSTANTS = 10           # at most, whose CFL numbers are evaluated
PLAIN = {'camber_mean': 'camber_mean', 'camber_max': 'camber_max', 'tension': 'tension',
         'camber_max_position': 'camber_max_x_c'}       # names of means without that word


def mean_name(output: str) -> str:
    """Return what the time average of an output is called in results."""
    return PLAIN.get(output, f'{output}_mean')


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

    They are those of every output that answers V^2, by `mean_name`. ``y_star`` is the largest
    camber over ``reference_deflection`` (m), y_ref = q c^2 / (8 T0); ``cl_rms`` is the standard
    deviation of Cl.
    """
    means = {mean_name(name): float(column.mean()) for name, column in late.columns.items()
             if name not in ('time', 'v_squared', 'clipped')}
    return {**means, 'cl_rms': float(late.cl.std()),
            'y_star': means['camber_max'] / reference_deflection}

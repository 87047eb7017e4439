# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on a wing beside its voltage: the disturbances of its case and those of a user."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dewing_sim.fluid.inflow import Inflow
from dewing_sim.inputs.base import Inputs
from dewing_sim.inputs.disturbance import wall_pressure
from dewing_sim.inputs.inflow_schedule import InflowSchedule, Outside
from dewing_sim.parameters import Case, Disturbance
from dewing_sim.scales import Scales

Pressure = Callable[[float], float]                 # time in s -> fraction of q
Motion = Callable[[float], tuple[float, float]]     # time in s -> two components, SI


@dataclass(frozen=True)
class Sources:
    """Functions of time that add to the inputs of every step."""

    disturbance: Disturbance
    inflow_schedule: InflowSchedule
    time_scale: float                   # c/U in s
    pressure: Pressure | None = None    # of a user

    @classmethod
    def of(cls, case: Case, scales: Scales, pressure: Pressure | None = None,
           gust: Motion | None = None, motion: Motion | None = None) -> 'Sources':
        """Return the sources of ``case`` with the functions of a user added, see `wing.Wing`."""
        schedule = InflowSchedule.of(case, scales).joined_by(
            gust, motion, scales, case.numerics.time_step)
        return cls(case.disturbance, schedule, scales.time, pressure)

    def at(self, time: float, inputs: Inputs) -> Inputs:
        """Return all that acts during the step that ends at ``time`` (s).

        Wall pressures add up. An inflow in ``inputs`` takes the place of the schedule's.
        """
        pressure = inputs.wall_pressure + wall_pressure(self.disturbance, time)
        if self.pressure is not None:
            pressure += self.pressure(time)
        inflow, schedule = inputs.inflow, self.inflow_schedule
        if inflow is None and not schedule.is_steady:
            inflow = schedule.at(time / self.time_scale)
        return Inputs(inputs.v_squared, pressure, inflow)

    def meets(self, time: float, gust: np.ndarray, motion: np.ndarray, scales: Scales) -> Inflow:
        """Return the inflow of ``time`` (s) with what comes from outside, in SI, added."""
        units = scales.time**np.arange(3)[:, None]
        outside = Outside(gust * units[:2] / scales.speed,
                          motion * units / np.array([scales.length, 1.0]))
        return self.inflow_schedule.at(time / self.time_scale, outside)

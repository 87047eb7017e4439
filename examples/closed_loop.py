# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A closed loop in ten lines: the shipped PID holds the camber against a 10 Hz disturbance."""

from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sim.records.history import record

case = parameters.load('paper', changes={
    'numerics.engine': 'conformal', 'numerics.grid': 'realtime',    # coarse and fast
    'disturbance.pressure': 0.015, 'disturbance.frequency': 10.0})
built = build_wing(case)                                            # trimmed
passive = built.identity.camber_mean                                # m
pid = controller(parameters.load('controller', ControllerSettings), built.identity)
loop = closed_loop(built.plant, built.rest, pid, steps=2000)        # 0.2 s
run = record(outputs for state, outputs in loop)

late = run.since(0.1)
print(f'camber {100 * (late.camber_mean.mean() / passive - 1):+.2f} % of the passive one '
      f'at {late.voltage.min():.0f} to {late.voltage.max():.0f} V')

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A disturbance of your own: any function of time presses on the membrane or blows at the wing."""

import math

from dewing_sim import parameters
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import rollout
from dewing_sim.records.history import record
from dewing_sim.wing import Wing

CASE = parameters.load('paper', changes={
    'numerics.engine': 'conformal', 'numerics.grid': 'realtime', 'numerics.time_step': 2.0e-4})
BEGIN = 0.02            # s


def knock(time):
    """Return a pressure jump in q: half a sine of 20 ms that presses the camber down by 5 %."""
    share = (time - BEGIN) / 0.02
    return -0.05 * math.sin(math.pi * share) if 0.0 < share < 1.0 else 0.0


def gust(time):
    """Return the speeds along the stream and upwards, m/s: 1 - cos of 60 ms up to 0.01 m/s."""
    share = (time - BEGIN) / 0.06
    return 0.0, 0.005 * (1.0 - math.cos(2.0 * math.pi * share)) if 0.0 < share < 1.0 else 0.0


calm = Wing(CASE)
rest = calm.rest()
passive = calm.observe(rest)
wings = {'knock': Wing(CASE, wall_pressure=knock), 'gust': Wing(CASE, gust=gust)}
runs = {}
for name, wing in wings.items():
    runs[name] = record(outputs for state, outputs in rollout(
        wing, rest, lambda _: Inputs(v_squared=0.0), 750))
    camber, lift = runs[name].camber_mean / passive.camber_mean, runs[name].cl / passive.cl
    print(f'{name}: camber {camber.min():.3f} to {camber.max():.3f}, '
          f'lift {lift.min():.3f} to {lift.max():.3f} of those at rest')

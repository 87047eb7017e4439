# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Two wings compared: what the same share of V_L^2 does to a taut and to a slack membrane."""

import numpy as np

from dewing_sim import parameters
from dewing_sim.wing import Wing

SHARES = (0.0, 0.1, 0.2, 0.3)       # V^2 over V_L^2, its value at the loss of tension
COARSE = {'numerics.engine': 'conformal', 'numerics.grid': 'realtime'}
STEPS = {'paper': 5.0e-4, 'soft': 5.0e-5}       # s: 0.02 c/U, the longest that the grid bears

camber, lift = {}, {}
for name, step in STEPS.items():
    coarse = COARSE | {'numerics.time_step': step}
    slack = Wing(parameters.load(name, changes=coarse)).v_squared_slack
    wings = [Wing(parameters.load(name, changes=coarse | {
        'actuation.voltage': float(np.sqrt(share * slack))})) for share in SHARES]
    rest = [wing.observe(wing.rest()) for wing in wings]
    camber[name] = np.array([outputs.camber_mean / wings[0].scales.length for outputs in rest])
    lift[name] = np.array([outputs.cl for outputs in rest])

print('V^2/V_L^2   camber, of that without voltage         Cl')
for k, share in enumerate(SHARES):
    print(f'{share:9.1f}', *(f'{name} {camber[name][k] / camber[name][0]:.3f}' for name in camber),
          f'string {1.0 / (1.0 - share):.3f}', *(f'{lift[name][k]:.3f}' for name in lift))

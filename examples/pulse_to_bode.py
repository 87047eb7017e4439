# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From a pulse of V^2 to a linear model to its Bode plot, by python-control."""

import control
import numpy as np

from dewing_sim import parameters
from dewing_sim.build import build_wing
from dewing_sysid.identify import identify_plant
from dewing_sysid.settings import Settings

case = parameters.load('paper', changes={
    'numerics.engine': 'conformal', 'numerics.grid': 'realtime', 'numerics.time_step': 4.0e-4})
settings = parameters.load('sysid', Settings, {'realisation.at_once': 'state'})
built = build_wing(case)
found = identify_plant(built.plant, built.rest, built.identity, settings)   # pulse, then checks
wing = found.model.to_control()                     # a control.StateSpace, discrete in time

frequency = np.geomspace(5.0, 400.0, 400)           # Hz
camber = control.frequency_response(wing, 2.0 * np.pi * frequency)[0, 0]
peak = frequency[np.argmax(camber.magnitude)]
gain = float(control.dcgain(wing)[0, 0])            # m/V^2
print(f'{wing.nstates} states from {wing.input_labels} to {wing.output_labels}')
print(f'camber rises by {gain:.3e} m/V^2 at rest and resonates at {peak:.1f} Hz')

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The rest state: a quasi-steady start, then a dynamic restart, as in the paper; kept on disk.

The flow starts with the expected circulation.  Until `QUASI_STEADY` convective times the membrane
is overdamped, so that it follows the developing load without ringing, and the far field learns the
circulation; from there to ``trim_time`` the motion is the true one.
"""

import hashlib
from dataclasses import replace
from typing import Protocol

import numpy as np
import yaml

from dewing_sim.coupling.iteration import Coupling
from dewing_sim.fluid.base import Fluid, Wall
from dewing_sim.fluid.plate import ADAPTATION_TIME, adapt_circulation, starting_circulation
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine import caches
from dewing_sim.machine import fingerprint as machine
from dewing_sim.parameters import Case, outside_modules, to_mapping
from dewing_sim.rest import checkpoint
from dewing_sim.scales import Scales
from dewing_sim.state import State
from dewing_sim.structure.base import Moving
from dewing_sim.structure.dynamics.motion import Motion

QUASI_STEADY = 10.0                 # c/U
PROGRESS_STEPS = 50                 # between calls of `progress`


class Wing(Protocol):
    """What trimming knows of a wing."""

    dt: float
    case: Case
    scales: Scales
    fluid: Fluid
    membrane: Moving

    def coupling(self, damping: float = 0.0) -> Coupling:
        """Return flow and membrane with a mass-proportional damping (U/c)."""

    def couple(self, state: State, inputs: Inputs, coupling: Coupling) -> State:
        """Advance flow and membrane by one step."""


def rest(wing: Wing, progress=None) -> State:
    """Return the rest state of ``wing`` from the cache, or march to it and keep it."""
    name = f'rest-{fingerprint(wing)}.npz'
    state = caches.recall(name, checkpoint.load)
    if state is None:
        state = march(wing, progress)
        caches.keep(name, lambda draft: checkpoint.save(draft, state, wing.case))
    return state


def march(wing: Wing, progress=None) -> State:
    """Compute the rest state; ``progress(done, total)`` counts steps."""
    dt = wing.dt / wing.scales.time
    inputs = Inputs(wing.case.actuation.voltage**2)
    total = round(wing.case.numerics.trim_time / dt)
    overdamped, free = wing.coupling(2.0 * first_frequency(wing)), wing.coupling()
    state = start(wing)
    for step in range(total):
        coupling = overdamped if step * dt < QUASI_STEADY else free
        state = replace(wing.couple(state, inputs, coupling), step=0)
        if step * dt < ADAPTATION_TIME:
            state = replace(state, flow=adapt_circulation(wing.fluid, state.flow, dt))
        if progress and (step + 1) % PROGRESS_STEPS == 0:
            progress(step + 1, total)
    return state


def start(wing: Wing) -> State:
    """Return potential flow past the flat membrane."""
    flow_section = wing.case.flow
    wall = Wall.flat(wing.fluid.columns)
    circulation = starting_circulation(flow_section.angle_of_attack, 0.0)
    return State(0, wing.case.actuation.voltage**2, wing.fluid.rest(wall, circulation),
                 Motion.at_rest(wing.membrane.rest_position))


def first_frequency(wing: Wing) -> float:
    """Return the first angular frequency in vacuo, pi sqrt(T/m) / c, in U/c."""
    membrane = wing.membrane
    tension = membrane.rest_tension(wing.case.actuation.voltage**2)
    return np.pi * float(np.sqrt(tension / membrane.mass.sum()))


def fingerprint(wing: Wing) -> str:
    """Return a hash of all that the rest state depends on: the case and the solver's sources."""
    case = to_mapping(wing.case)
    del case['disturbance'], case['gust'], case['rigid_motion']
    del case['actuation']['voltage_limit'], case['actuation']['slack_margin']
    digest = hashlib.sha256(yaml.safe_dump(case).encode())
    sources = machine.fingerprint(type(wing).__module__, *outside_modules(wing.case))
    digest.update(sources.encode())
    return digest.hexdigest()[:24]

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The model of a wing that control is designed on: identified once, then kept on disk."""

import hashlib
from typing import Callable

from dewing_sim import parameters
from dewing_sim.build import Built
from dewing_sim.linear.model import Model
from dewing_sim.machine import caches
from dewing_sim.machine import fingerprint as machine
from dewing_sim.machine.jobs import Workers
from dewing_sim.rest.trim import fingerprint

# Control needs the slow response of the wake as much as the modes: a window of 1.2 c/U, as in the
# paper, leaves the damping of the first mode a third too low.
CHANGES = {'experiment.record': 9.6, 'realisation.window': 9.6, 'realisation.order': 12,
           'realisation.unstable_poles': 'reflect'}
OUTPUTS = ('camber_mean',)


def identify(built: Built, progress: Callable[[float], None] = lambda fraction: None) -> Model:
    """Return the model of mean camber of a wing at rest, from the cache or by experiment."""
    name = f'model-{_key(built)}.npz'
    model = caches.recall(name, Model.load)
    if model is None:
        from dewing_sysid.identify import identify_plant
        model = identify_plant(built.plant, built.rest, built.identity, _settings(), OUTPUTS,
                               workers=Workers(2), progress=progress).model
        caches.keep(name, model.save)
    return model


def _settings():
    from dewing_sysid.settings import Settings
    return parameters.load('sysid', Settings, CHANGES)


def _key(built: Built) -> str:
    """Return a hash of the wing, its solver's and its identification's sources and settings."""
    digest = hashlib.sha256(fingerprint(built.plant).encode())
    digest.update(parameters.to_yaml(_settings()).encode())
    digest.update(machine.fingerprint('dewing_sysid.identify').encode())
    return digest.hexdigest()[:24]

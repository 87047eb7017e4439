# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The passive camber of a wing, which targets of controllers are relative to.

A steady wing has that of its rest state. To a wing that sheds, the rest state is one instant of a
cycle: its passive camber is the mean over the next `AVERAGE` convective times. A wing whose trim
ends within its quasi-steady part has no cycles yet.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from dewing_sim.files import read_npz
from dewing_sim.inputs.base import Inputs
from dewing_sim.machine import caches
from dewing_sim.rest.trim import QUASI_STEADY, fingerprint
from dewing_sim.state import State
from dewing_sim.wing import Wing

LOOK, AVERAGE = 1.0, 10.0           # c/U; a shedding cycle takes about 1.7
STEADY = 0.02                       # largest swing of a steady camber, relative
LEAST = 1.0e-3                      # of y_ref: a swing is compared with no smaller camber
SAMPLE = 5                          # steps


def camber(wing: Wing, rest: State, progress=None) -> tuple[float, float]:
    """Return chord average and maximum of the passive camber in m, cached on disk.

    ``progress(done, total)`` is called if a shedding wing has to be marched on.
    """
    name = f'passive-{fingerprint(wing)}.npz'
    found = caches.recall(name, _read)
    if found is None:
        found = measure(wing, rest, progress)
        caches.keep(name, lambda draft: _save(draft, found))
    return found


def measure(wing: Wing, rest: State, progress=None) -> tuple[float, float]:
    """Compute what `camber` returns."""
    begin = _sample(wing, rest)
    if wing.case.numerics.trim_time <= QUASI_STEADY:
        return begin
    glance, state = _march(wing, rest, LOOK)
    size = np.maximum(np.abs(begin), LEAST * wing.reference_deflection)
    swing = np.ptp([begin, *glance], axis=0) / size
    if swing.max() < STEADY:
        return begin
    later, _ = _march(wing, state, AVERAGE - LOOK, progress)
    mean, largest = np.mean(glance + later, axis=0)
    return float(mean), float(largest)


def _march(wing: Wing, state: State, duration: float, progress=None):
    """Return samples of the camber over ``duration`` (c/U) without disturbance, and the end."""
    free, inputs = wing.coupling(), Inputs(state.v_squared)
    total = round(duration * wing.scales.time / wing.dt)
    samples = []
    for step in range(1, total + 1):
        state = replace(wing.couple(state, inputs, free), step=0)
        if step % SAMPLE == 0 or step == total:
            samples.append(_sample(wing, state))
            if progress:
                progress(step, total)
    return samples, state


def _sample(wing: Wing, state: State) -> tuple[float, float]:
    outputs = wing.observe(state)
    return float(outputs.camber_mean), float(outputs.camber_max)


def _save(path: Path, found: tuple[float, float]) -> None:
    np.savez(path, camber=found)            # an npz tells a half-written file by its checksums


def _read(path: Path) -> tuple[float, float]:
    with read_npz(path, 'a passive camber') as arrays:
        mean, largest = arrays['camber'].tolist()
    return mean, largest

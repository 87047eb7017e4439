# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""One closed loop on one wing, recorded and reduced to the figures of a comparison."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from dewing_control.law.supervisor import Controller
from dewing_control.trial.energy import Energy
from dewing_sim.errors import RunFailed
from dewing_sim.identity import require_reference
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import Measurement, Plant
from dewing_sim.quantities import Absent


@dataclass(frozen=True, eq=False)
class Trial:
    """Arrays (n,) of a run; sample k is the end of step k.

    What the plant does not have, lift, drag or capacitance, is None.
    """

    dt: float
    camber: np.ndarray              # a/a_ref, a_ref the passive one
    v_squared: np.ndarray           # V^2
    cl: np.ndarray | None
    cd: np.ndarray | None
    capacitance: np.ndarray | None  # F/m
    seconds: np.ndarray             # the controller took for each step
    failure: str = ''               # why the run stopped early, if it did

    @property
    def time(self) -> np.ndarray:
        """Time in s."""
        return self.dt * np.arange(1, self.camber.size + 1)


def run(plant: Plant, rest: Any, controller: Controller | None, steps: int, noise: float = 0.0,
        seed: int = 1, passive: float | None = None) -> Trial:
    """Return a run from ``rest`` under ``controller``, or at the V^2 of rest without one.

    ``passive`` is the camber (m) that all are relative to, by default that at rest; ``noise``, in
    it, is the standard deviation of a white noise on the measured cambers. A failing plant or
    law ends the run, which keeps what was computed. Raises `Absent` for a plant without mean
    camber, `BadInput` for a passive one of zero.
    """
    generator = np.random.default_rng(seed)
    state, outputs, rows, failure = rest, plant.observe(rest), [], ''
    if outputs.camber_mean is None:
        raise Absent('a trial is judged by the mean camber: the plant does not have it')
    v_squared, memory = outputs.v_squared, None
    passive = require_reference(
        'camber_mean', outputs.camber_mean if passive is None else passive, None)
    if controller is not None:
        memory = controller.start(v_squared)
    for _ in range(steps):
        begun = time.perf_counter()
        try:
            if controller is not None:
                memory, v_squared = controller.step(
                    memory, _noisy(Measurement.of(outputs), noise * passive, generator))
            seconds = time.perf_counter() - begun
            state = plant.step(state, Inputs(v_squared))
        except RunFailed as error:
            failure = str(error)
            break
        outputs = plant.observe(state)
        rows.append((outputs.camber_mean / passive, outputs.v_squared, outputs.cl,
                     outputs.cd, outputs.capacitance, seconds))
    if not rows:
        raise RunFailed(f'the first step failed: {failure}', rest)
    return Trial(plant.dt, *(None if column[0] is None else np.array(column)
                             for column in zip(*rows)), failure)


def _noisy(measurement: Measurement, noise: float, generator) -> Measurement:
    if not noise:
        return measurement
    error = noise * generator.standard_normal()
    return measurement._replace(**{
        name: getattr(measurement, name) + error for name in ('camber_mean', 'camber_max')
        if name in measurement._fields})


def figures(trial: Trial, target: float, limit: float, skip: float) -> dict[str, Any]:
    """Return the figures of ``trial`` after ``skip`` s (of a failed run: of its second half).

    Cambers are in the passive one; amplitude is half the range, ``limit`` the largest V^2. Energy
    is that of the whole run, powers are means after ``skip``; both are per metre of span. There
    are no figures of what the plant does not have.
    """
    begin = round(skip / trial.dt)
    if begin >= trial.camber.size - 1:
        begin = trial.camber.size // 2
    late = slice(begin, None)
    camber, v_squared = trial.camber[late], trial.v_squared[late]
    return {
        'camber_mean': float(camber.mean()), 'camber_amplitude': float(0.5 * np.ptp(camber)),
        'error_mean': float(camber.mean() - target),
        'error_rms': float(np.sqrt(np.mean((camber - target)**2))),
        'v_max': float(np.sqrt(trial.v_squared.max())),
        'v_rms': float(np.sqrt(v_squared.mean())),
        'saturation_share': float(np.mean((v_squared <= 0.0) | (v_squared >= limit))),
        **_energies(trial, late), **_loads(trial, late),
        'compute_ms': 1.0e3 * float(np.median(trial.seconds)),
        'compute_worst_ms': 1.0e3 * float(trial.seconds.max()),
        'failure': trial.failure}


def _energies(trial: Trial, late: slice) -> dict[str, float]:
    if trial.capacitance is None:
        return {}
    whole = Energy.of(np.concatenate([trial.v_squared[:1], trial.v_squared]),
                      np.concatenate([trial.capacitance[:1], trial.capacitance]))
    v_squared = trial.v_squared[late]
    settled = Energy.of(v_squared, trial.capacitance[late])
    duration = trial.dt * max(v_squared.size - 1, 1)
    return {
        'energy_j': whole.net, 'energy_without_recovery_j': whole.gross,
        'power_w': settled.net / duration, 'power_without_recovery_w': settled.gross / duration,
        'work_w': settled.work / duration}


def _loads(trial: Trial, late: slice) -> dict[str, float]:
    lift = {} if trial.cl is None else {'cl_mean': float(trial.cl[late].mean()),
                                        'cl_rms': float(trial.cl[late].std())}
    return lift if trial.cd is None else {**lift, 'cd_mean': float(trial.cd[late].mean())}

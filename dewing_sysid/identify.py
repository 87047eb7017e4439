# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""From records to a judged model: the same steps offline, in the node and from a file."""

from dataclasses import dataclass, replace
from typing import Any, Callable, Sequence

import numpy as np
import yaml

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.linear.model import Model
from dewing_sim.linear.state_space import Matrices
from dewing_sim.machine.jobs import HERE, Workers
from dewing_sim.plant import Plant
from dewing_sysid import era
from dewing_sysid.experiment import Record, run_all, unit
from dewing_sysid.plan import EXPERIMENT, FRESH, HALF, SWEEP, make, samples, time_scale
from dewing_sysid.settings import Realisation, Settings

WINDOWS = (0.3, 0.6, 1.2, 2.4, 4.8)     # c/U, about the paper's 1.2
WORST_FIT = -1.0e6                      # percent, where an unstable model overflows
Fits = dict[str, dict[str, float]]      # run: output: percent NRMSE


@dataclass(frozen=True)
class Identification:
    """A model and what is known of its quality."""

    model: Model                        # its ``fit`` maps 'window' and every run
    records: dict[str, Record]
    window: int                         # samples of pulse response in the Hankel matrix
    linearity: dict[str, float]         # |y(a) - 2 y(a/2)| / |y(a)| by output
    reflected: np.ndarray               # unstable poles that were mirrored into the circle
    by_order: dict[int, Fits]
    by_window: dict[float, Fits]        # by c/U


def identify(records: dict[str, Record], settings: Settings, identity: Identity,
             ) -> Identification:
    """Realise a model from the record `EXPERIMENT` and judge it on all of them.

    Raises `BadInput` if an output does not respond, as none does of a membrane that lies flat, if
    the record is too short for the window or the order, or if its time step is not that of the
    plant.
    """
    identity.require_response()
    measured, chosen, scale = records[EXPERIMENT], settings.realisation, time_scale(identity)
    if not np.isclose(measured.dt, identity.dt, rtol=1e-9):
        raise BadInput(f'the record has dt = {measured.dt:g} s, the plant {identity.dt:g} s')
    window = samples(chosen.window, scale, measured.dt)
    factors = factorise(measured, settings, window)
    realisation, reflected = realise(factors, chosen, chosen.order), np.empty(0)
    if chosen.unstable_poles == 'reflect':
        realisation, reflected = era.reflect_unstable(realisation)
    model = _model(realisation, factors, measured, identity)
    runs = {'window': measured.head(window), **records}
    return Identification(
        replace(model, fit=judge(model, runs)), records, window, linearity(records), reflected,
        {order: judge(_model(realise(factors, chosen, order), factors, measured, identity), runs)
         for order in range(2, min(2 * chosen.order, most_states(factors, chosen)) + 1, 2)},
        _effect_of_window(runs, settings, identity))


def _effect_of_window(runs: dict[str, Record], settings: Settings, identity: Identity,
                      ) -> dict[float, Fits]:
    measured, effect = runs[EXPERIMENT], {}
    for window in WINDOWS:
        length = samples(window, time_scale(identity), measured.dt)
        if length <= len(measured.u):
            factors = factorise(measured, settings, length)
            chosen = settings.realisation
            realisation = realise(factors, chosen, min(chosen.order, most_states(factors, chosen)))
            effect[window] = judge(_model(realisation, factors, measured, identity), runs)
    return effect


def markov(record: Record, lags: int, length: int) -> np.ndarray:
    """Return Markov parameters (outputs, 1, length) per V^2 of input: divided pulse, or OKID.

    Raises `BadInput` if the record is too short or an output does not respond.
    """
    u, y = record.u, record.y
    silent = ~np.any(y, axis=1)
    if silent.any():
        raise BadInput(f'output {record.names[int(np.argmax(silent))]} is constant: it does not '
                       'respond to V^2, leave it out or raise the amplitude')
    if u[0] != 0.0 and not u[1:].any():
        return record.head(length).y[:, None, :] / u[0]
    return era.okid(u[None], y, length, lags)


def factorise(record: Record, settings: Settings, length: int) -> era.HankelFactors:
    """Return the decomposed Hankel matrix of the first ``length`` Markov parameters.

    With ``at_once: state`` it begins one sample later, and `realise` adds the first.
    """
    h = markov(record, settings.realisation.lags, length)
    return era.factorise(h[:, :, 1:] if settings.realisation.at_once == 'state' else h,
                         states=max(era.LEADING, 2 * settings.realisation.order))


def realise(factors: era.HankelFactors, chosen: Realisation, order: int) -> Matrices:
    """Return the model of ``order`` states; raise `BadInput` if the record does not hold them."""
    most = most_states(factors, chosen)
    if order > most:
        raise BadInput(f'order = {order} cannot be realised: the record holds {most} states')
    if chosen.at_once == 'state':
        return era.delayed(factors.realise(order - 1))
    return factors.realise(order)


def most_states(factors: era.HankelFactors, chosen: Realisation) -> int:
    """Return the largest order that `realise` takes."""
    return factors.rank + (chosen.at_once == 'state')


def _model(realisation: Matrices, factors: era.HankelFactors, record: Record,
           identity: Identity) -> Model:
    return Model(
        realisation.a, realisation.b, realisation.c, np.zeros_like(realisation.d), record.dt,
        record.names, record.baseline.mean(axis=1), identity.v_squared_slack,
        v_squared_max=identity.v_squared_max, operating_v_squared=record.operating_v_squared,
        units=tuple(unit(name, identity) for name in record.names),
        singular_values=factors.singular_values,
        case_yaml=yaml.safe_dump({'/**': {'ros__parameters': identity.case}}))


def judge(model: Model, records: dict[str, Record]) -> Fits:
    """Return the percent NRMSE of every record and output, not less than `WORST_FIT`."""
    with np.errstate(over='ignore', invalid='ignore'):
        return {run: {name: float(max(fit, WORST_FIT)) if np.isfinite(fit) else WORST_FIT
                      for name, fit in zip(record.names,
                                           nrmse_fit(record.y, model.simulate(record.u)))}
                for run, record in records.items()}


def nrmse_fit(measured: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Return 100 (1 - |y - yhat| / |y - mean(y)|) percent of each row; 100 is perfect."""
    error = np.linalg.norm(measured - predicted, axis=1)
    spread = np.linalg.norm(measured - measured.mean(axis=1, keepdims=True), axis=1)
    if not spread.all():
        raise BadInput(f'output {int(np.argmin(spread))} is constant: the fit is not defined')
    return 100.0 * (1.0 - error / spread)


def linearity(records: dict[str, Record]) -> dict[str, float]:
    """Return |y(a) - 2 y(a/2)| / |y(a)| by output, empty without a run at half amplitude."""
    if HALF not in records:
        return {}
    full, half = records[EXPERIMENT], records[HALF]
    departure = np.linalg.norm(full.y - 2.0 * half.y, axis=1) / np.linalg.norm(full.y, axis=1)
    return dict(zip(full.names, map(float, departure)))


def identify_plant(plant: Plant, start: Any, identity: Identity, settings: Settings,
                   names: Sequence[str] | None = None, workers: Workers = HERE,
                   progress: Callable[[float], None] = lambda fraction: None) -> Identification:
    """Run every experiment on ``plant`` from its rest state ``start`` and identify it.

    Raises `BadInput` as `plan.make`, `experiment.run` and `identify` do.
    """
    planned = make(settings, identity, names)
    outputs = run_all(plant, start, planned.names, list(planned.inputs.values()), workers,
                      progress)
    return identify(planned.records(dict(zip(planned.inputs, outputs))), settings, identity)


def concerns(found: Identification, settings: Settings) -> list[str]:
    """Return a sentence for everything that makes the model doubtful."""
    sentences, record = [], found.records[EXPERIMENT]
    if found.model.spectral_radius >= 1.0:
        sentences.append(f'the model is unstable, its spectral radius is '
                         f'{found.model.spectral_radius:.5f}: try another order or window')
    for name, departure in found.linearity.items():
        if departure > settings.experiment.linearity_tolerance:
            sentences.append(f'{name} responds to half the amplitude with a departure of '
                             f'{100.0 * departure:.2g} %: take a smaller experiment.amplitude')
    unsteady = np.ptp(record.baseline, axis=1) > np.ptp(record.y, axis=1)
    if unsteady.any():
        names = ', '.join(name for name, moves in zip(record.names, unsteady) if moves)
        sentences.append(f'{names} moves more at rest than in response to V^2: the flow is not '
                         'steady, and a linear model holds for a short time only')
    return sentences


def report(found: Identification) -> dict[str, Any]:
    """Return what is known of a model as nested words and finite numbers, for JSON."""
    model = found.model
    frequency, damping = model.modes()
    return {
        'fit': model.fit['window'], 'fit_record': model.fit[EXPERIMENT],
        'fit_fresh': model.fit.get(FRESH, {}), 'fit_sweep': model.fit.get(SWEEP, {}),
        'poles_hz': frequency.tolist(), 'poles_damping': damping.tolist(),
        'singular_values': model.singular_values.tolist(),
        'spectral_radius': model.spectral_radius, 'order': model.order, 'dt': model.dt,
        'window_samples': found.window, 'linearity': found.linearity,
        'reflected_poles': [[pole.real, pole.imag] for pole in found.reflected],
        'by_order': found.by_order, 'by_window': found.by_window}

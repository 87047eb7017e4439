# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Controller design on the identified model: the model, gains judged on it, a tuning."""

from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np

from dewing_cli.paper.runs import experiments
from dewing_cli.paper.runs.result import Result, Tick
from dewing_control.law.pid import Pid
from dewing_control.model.design import Design
from dewing_control.model.identified import CHANGES, OUTPUTS
from dewing_control.settings import ControllerSettings, value_of
from dewing_control.tuning.bounds import Bounds
from dewing_control.tuning.judge import Judged, judge
from dewing_control.tuning.printed import pi_limit, printed_gains
from dewing_control.tuning.tuning import tune
from dewing_sim import parameters
from dewing_sim.identity import Identity
from dewing_sim.linear.model import Model

TUNING_COST = 2.0e4         # ms


@dataclass(frozen=True)
class Designed:
    """The model of mean camber from ``experiments``, and PID gains judged on it."""

    experiments: str                # name of the run
    settings: str                   # YAML of config/controller.yaml
    tuning: bool                    # whether gains are sought as well

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the runs whose results it takes."""
        return (self.experiments,)

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return TUNING_COST if self.tuning else 1.0e3

    def __call__(self, tick: Tick, inputs: Mapping[str, Result]) -> Result:
        """Return matrices, reports of every set of gains and the loops of the shipped ones."""
        model, identity = _identify(inputs[self.experiments])
        tick(0.1)
        design = Design.of(model, 'camber_mean')
        bounds = Bounds()
        strained = design.at_tension(bounds.tension)
        settings = parameters.from_yaml(self.settings, ControllerSettings)
        judged = {name: judge(parameters.replace(settings, changes), identity, design, strained)
                  for name, changes in readings(settings, identity).items()}
        if self.tuning:
            judged['tuned'] = tune(settings, identity, design, bounds,
                                   progress=lambda done, total: tick(0.1 + 0.9 * done / total))
        values = _described(model, design) | {
            'pi_limit': pi_limit(design, printed_gains(identity)['kp']),
            'printed': printed_gains(identity),
            'identity': experiments.identity(inputs[self.experiments]).to_yaml(),
            'judged': {name: _report(item) for name, item in judged.items()}}
        return Result(values, {'a': model.a, 'b': model.b[:, 0], 'c': model.c,
                               'operating_outputs': model.operating_outputs,
                               **_loops(judged['shipped'])})


def readings(settings: ControllerSettings, identity: Identity) -> dict[str, dict[str, Any]]:
    """Return the changes of the settings that make every reading of the gains a PID."""
    printed = printed_gains(identity)
    as_printed = {f'pid.{gain}': value for gain, value in printed.items()} | {
        'kind': 'pid', 'pid.tracking_time': printed['kp'] / printed['ki']}
    return {'shipped': {'kind': 'pid'}, 'as_printed': as_printed,
            'ki_over_1000': as_printed | {'pid.ki': 1.0e-3 * printed['ki'],
                                          'pid.tracking_time': 1.0},
            'kd_times_3000': as_printed | {'pid.kd': 3000.0 * printed['kd']}}


def _identify(found: Result) -> tuple[Model, Identity]:
    from dewing_sysid.identify import identify
    from dewing_sysid.settings import Settings
    identity = experiments.identity(found)
    return identify(experiments.records(found, OUTPUTS),
                    parameters.load('sysid', Settings, CHANGES), identity).model, identity


def _described(model: Model, design: Design) -> dict[str, Any]:
    poles = model.poles.astype(complex)
    rates = np.log(poles[poles.imag > 0.0]) / model.dt
    rates = rates[np.argsort(np.abs(rates))]
    return {'dt': model.dt, 'output_names': list(model.output_names),
            'operating_v_squared': model.operating_v_squared,
            'v_squared_slack': model.v_squared_slack, 'v_squared_max': model.v_squared_max,
            'static_gain': design.static_gain, 'order': model.order,
            'modes_hz': (np.abs(rates) / (2.0 * np.pi)).tolist(),
            'modes_damping': (-rates.real / np.abs(rates)).tolist()}


def _report(judged: Judged) -> dict[str, Any]:
    gains = {name.partition('.')[2]: value_of(judged.settings, name) for name in Pid.ranges}
    return judged.report() | {'gains': gains}


def _loops(judged: Judged) -> dict[str, np.ndarray]:
    arrays = {}
    for label, loop in (('rest', judged.loop), ('strained', judged.strained)):
        arrays |= {f'{label}/frequency': loop.frequency, f'{label}/plant': np.abs(loop.plant),
                   f'{label}/gain': np.abs(loop.gain),
                   f'{label}/phase': np.degrees(np.unwrap(np.angle(loop.gain))),
                   f'{label}/sensitivity': np.abs(loop.sensitivity)}
    return arrays


def model_of(result: Result) -> Model:
    """Return the identified model."""
    values = result.values
    return Model(result['a'], result['b'][:, None], result['c'],
                 np.zeros((len(result['c']), 1)), values['dt'], tuple(values['output_names']),
                 result['operating_outputs'], values['v_squared_slack'],
                 v_squared_max=values['v_squared_max'],
                 operating_v_squared=values['operating_v_squared'])


def design_of(result: Result) -> Design:
    """Return the normalised model of mean camber."""
    return Design.of(model_of(result), 'camber_mean')

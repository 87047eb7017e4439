# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A tuned law on the wing it was not designed on: the Navier-Stokes one, beside the model."""

from typing import Any

import numpy as np

from dewing_control.law.supervisor import Controller
from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings
from dewing_control.trial import trial
from dewing_control.trial.closed_loop import closed_loop, controller
from dewing_control.trial.late import late
from dewing_control.tuning.judge import FREQUENCY, LOAD
from dewing_sim.build import Built
from dewing_sim.identity import Identity
from dewing_sim.linear.model import Model
from dewing_sim.linear.reduced import Reduced

AVERAGED = 0.1              # s at the end of a run: one period of the disturbance


def on_wing(settings: ControllerSettings, built: Built, model: Design, duration: float,
            ) -> tuple[trial.Trial, dict[str, Any]]:
    """Return run and figures of the law on the wing ``built``, obeyed as late as it expects."""
    run = trial.run(built.plant, built.rest,
                    _late(settings, controller(settings, built.identity, model)),
                    round(duration / built.plant.dt),
                    passive=built.identity.passive('camber_mean'))
    figures = trial.figures(run, settings.reference.target, built.identity.v_squared_max,
                            max(duration - AVERAGED, 0.5 * duration))
    return run, figures


def _late(settings: ControllerSettings, made: Controller) -> Controller:
    return late(made, settings.command.delay_steps)


def on_model(settings: ControllerSettings, identity: Identity, model: Model, design: Design,
             duration: float) -> np.ndarray:
    """Return the camber (n,) in a_ref of the law on the model disturbed as in Fig. 5."""
    plant = Reduced(model, disturbance=-LOAD * model.operating_outputs,
                    disturbance_frequency=FREQUENCY)
    loop = closed_loop(plant, plant.rest(),
                       _late(settings, controller(settings, identity, design)),
                       round(duration / plant.dt))
    passive = model.operating_outputs[model.output_names.index(settings.reference.output)]
    return np.array([getattr(outputs, settings.reference.output) for _, outputs in loop]) / passive


def difference(wing: np.ndarray, model: np.ndarray, dt: float) -> dict[str, float]:
    """Return how far the camber of the wing is from that of the model, in a_ref."""
    samples = min(wing.size, model.size)
    late = slice(max(samples - round(AVERAGED / dt), samples // 2), samples)
    return {'rms': float(np.sqrt(np.mean((wing[:samples] - model[:samples])**2))),
            'amplitude_wing': float(0.5 * np.ptp(wing[late])),
            'amplitude_model': float(0.5 * np.ptp(model[late]))}

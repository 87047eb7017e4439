# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A plant and a controller in one process, without ROS, bit for bit the loop over DDS."""

from typing import Any, Iterator

from dewing_control.law.registry import law, of_kind
from dewing_control.law.supervisor import Controller, Supervisor
from dewing_control.model.design import Design
from dewing_control.settings import ControllerSettings, value_of
from dewing_sim.identity import Identity
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import Measurement, Outputs, Plant, rollout


def controller(settings: ControllerSettings, identity: Identity, model: Design | None = None,
               ) -> Supervisor:
    """Return the supervised controller that ``settings`` describe for a plant, as nodes run it.

    ``model`` is as in `law`.
    """
    command = settings.command
    return Supervisor(law(settings, identity, model), command.period_steps, command.hold_steps,
                      min(command.voltage_limit**2, identity.v_squared_max))


def same_memory(one: ControllerSettings, other: ControllerSettings) -> bool:
    """Return whether the controllers of both settings remember the same quantities."""
    return _form(one) == _form(other)


def _form(settings: ControllerSettings) -> tuple:
    found = of_kind(settings.kind)
    model = settings.model if found.needs_model else ''
    return (settings.kind, model, settings.reference.output, settings.command.period_steps,
            settings.command.delay_periods, *(value_of(settings, name) for name in found.memory))


def closed_loop(plant: Plant, state: Any, loop: Controller, steps: int,
                ) -> Iterator[tuple[Any, Outputs]]:
    """Yield (state, outputs) after each of ``steps`` steps of ``plant`` under ``loop``.

    The controller takes over, without a bump, at the V^2 that led to ``state``.
    """
    memory = loop.start(plant.observe(state).v_squared)

    def command(outputs: Outputs) -> Inputs:
        nonlocal memory
        memory, v_squared = loop.step(memory, Measurement.of(outputs))
        return Inputs(v_squared)

    return rollout(plant, state, command, steps)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the parameters of the simulator node describe: its settings and its case."""

from rclpy.node import Node

from dewing_sim import parameters
from dewing_sim.parameters import Case
from dewing_sim.ros import messages
from dewing_sim.settings import SimulatorSettings

LIVE = ('run.step_count',)  # may change while the node runs


def settings_of(node: Node) -> tuple[SimulatorSettings, Case]:
    """Return the settings and the case that the parameters of ``node`` describe, declared."""
    given = messages.take_overrides(node)
    own = {name for name, _field in parameters.fields(SimulatorSettings)}
    settings = parameters.load('simulator', SimulatorSettings,
                               {name: given.pop(name) for name in own & given.keys()})
    case = parameters.load(settings.case, Case, given)
    messages.declare(node, settings, read_only=True, live=LIVE)
    messages.declare(node, case, read_only=True, open_fields=messages.constants(case))
    return settings, case

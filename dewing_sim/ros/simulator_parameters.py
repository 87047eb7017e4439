# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the parameters of the simulator node describe: its settings and its case."""

from rclpy.node import Node

from dewing_sim import parameters
from dewing_sim.parameters import Case
from dewing_sim.ros import given_parameters, messages
from dewing_sim.settings import SimulatorSettings

LIVE = ('run.step_count',)  # may change while the node runs


def settings_of(node: Node) -> tuple[SimulatorSettings, Case]:
    """Return the settings and the case that the parameters of ``node`` describe, declared."""
    own, changes = given_parameters.take(node, SimulatorSettings, Case)
    settings = parameters.load('simulator', SimulatorSettings, own)
    case = parameters.load(settings.case, Case, changes)
    messages.declare(node, settings, read_only=True, live=LIVE)
    messages.declare(node, case, read_only=True, open_fields=messages.constants(case))
    return settings, case


def shipped() -> tuple[SimulatorSettings, Case]:
    """Return the parameters of the node, and of the case it takes if none is named."""
    settings = parameters.load('simulator', SimulatorSettings)
    return settings, parameters.load(settings.case)

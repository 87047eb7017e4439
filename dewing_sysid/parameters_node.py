# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the parameters of the identification node describe."""

from rclpy.node import Node

from dewing_sim import parameters
from dewing_sim.ros import given_parameters
from dewing_sim.ros import messages as common
from dewing_sysid.settings import NODE_DEFAULTS, NodeSettings, Settings


def settings_of(node: Node) -> tuple[Settings, NodeSettings]:
    """Return the settings that the parameters of ``node`` describe, declared."""
    own, changes = given_parameters.take(node, NodeSettings, Settings)
    node_settings = parameters.from_mapping(NodeSettings, NODE_DEFAULTS | own)
    settings = parameters.load('sysid', Settings, changes)
    common.declare(node, settings, read_only=True)
    common.declare(node, node_settings, read_only=True)
    return settings, node_settings

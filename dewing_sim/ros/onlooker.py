# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A node that looks on at a run: its camber, and what the simulator says of itself."""

from collections.abc import Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from std_msgs.msg import Float64

from dewing_sim.ros import harness, qos

SIMULATOR = '/dewing/simulator'     # its name in the diagnostics


class Onlooker(Node):
    """Keeps ``camber`` (m), as it is published, and the latest ``said`` by the simulator."""

    def __init__(self, parameters: Mapping[str, Any] | None = None, **options):
        super().__init__('onlooker', namespace='dewing', **harness.overrides(parameters),
                         **options)
        self.camber: list[float] = []
        self.said: dict[str, str] = {}
        self.create_subscription(Float64, 'camber', self._on_camber, qos.EVENTS)
        self.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics,
                                 qos.EVENTS)

    @property
    def time(self) -> float:
        """Simulated time in s, of the latest diagnostics."""
        return float(self.said.get('simulated_time', 0.0))

    def _on_camber(self, message: Float64):
        self.camber.append(message.data)

    def _on_diagnostics(self, message: DiagnosticArray):
        for status in message.status:
            if status.name == SIMULATOR:
                self.said = {item.key: item.value for item in status.values}

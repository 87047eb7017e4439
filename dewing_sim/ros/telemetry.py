# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator publishes for people to watch: decimated, and only if somebody listens."""

from collections.abc import Callable
from typing import Any, NamedTuple

from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.ros import messages, qos
from dewing_sim.settings import Run


class Channel(NamedTuple):
    """A publisher, the steps between its messages, and how a message is made."""

    publisher: Any
    period: int
    make: Callable[[Outputs], Any]


class Telemetry:
    """The topics beside ``measurement``."""

    def __init__(self, node, case: Case, run: Run, dt: float):
        """Advertise all topics on ``node``; rates become whole numbers of steps of ``dt``."""
        self._dt = dt

        def channel(topic: str, kind: type, rate: float, make: Callable) -> Channel:
            period = max(1, round(1.0 / (rate * dt)))
            return Channel(node.create_publisher(kind, topic, qos.every(period)), period, make)

        def scalar(name: str) -> Callable:
            return lambda outputs: messages.scalar(getattr(outputs, name))

        self._channels = [
            channel('/clock', messages.Clock, run.scalar_rate,
                    lambda outputs: messages.clock(outputs.time)),
            channel('cl', messages.Float64, run.scalar_rate, scalar('cl')),
            channel('camber', messages.Float64, run.scalar_rate, scalar('camber_mean')),
            channel('v_squared', messages.Float64, run.scalar_rate, scalar('v_squared'))]
        if run.plant == 'wing':
            chord = case.membrane.chord
            self._channels += [
                channel('loads', messages.WrenchStamped, run.scalar_rate,
                        lambda outputs: messages.loads(outputs, case.flow, chord)),
                channel('membrane', messages.PointCloud2, run.membrane_rate, messages.membrane),
                channel('membrane_marker', messages.Marker, run.membrane_rate,
                        lambda outputs: messages.membrane_marker(
                            outputs, run.marker_exaggeration))]

    def publish(self, outputs: Outputs) -> None:
        """Publish what is due at the time of ``outputs``."""
        step = round(outputs.time / self._dt)
        for publisher, period, make in self._channels:
            if step % period == 0 and publisher.get_subscription_count():
                publisher.publish(make(outputs))

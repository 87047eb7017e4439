# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator publishes for people to watch: decimated, and only if somebody listens."""

from collections.abc import Callable
from typing import Any, NamedTuple

from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema
from dewing_sim.ros import messages, qos
from dewing_sim.settings import Run


class Channel(NamedTuple):
    """A publisher, the steps between its messages, and how a message is made."""

    publisher: Any
    period: int
    make: Callable[[Outputs], Any]


class Telemetry:
    """The topics beside ``measurement``."""

    def __init__(self, node, case: Case, run: Run, dt: float, outputs: Outputs):
        """Advertise the topics of a plant that has what ``outputs`` has on ``node``.

        Rates become whole numbers of steps of ``dt``.
        """
        self._dt = dt

        def channel(topic: str, kind: type, rate: float, make: Callable) -> Channel:
            period = max(1, round(1.0 / (rate * dt)))
            return Channel(node.create_publisher(kind, topic, qos.every(period)), period, make)

        self._channels = [channel('/clock', messages.Clock, run.scalar_rate,
                                  lambda outputs: messages.clock(outputs.time))]
        self._channels += [channel(each.topic, messages.Float64, run.scalar_rate,
                                   _scalar(each.name))
                           for each in schema(type(outputs)).quantities
                           if each.topic and getattr(outputs, each.name) is not None]
        if _has(outputs, 'cl', 'cd', 'cm') and run.plant != 'reduced':
            self._channels.append(channel(
                'loads', messages.WrenchStamped, run.scalar_rate,
                lambda outputs: messages.loads(outputs, case.flow, case.membrane.chord)))
        if _has(outputs, 'x', 'y', 'pressure_jump', 'tension'):
            self._channels += [
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


def _scalar(name: str) -> Callable[[Outputs], Any]:
    return lambda outputs: messages.scalar(getattr(outputs, name))


def _has(outputs: Outputs, *names: str) -> bool:
    return all(getattr(outputs, name) is not None for name in names)

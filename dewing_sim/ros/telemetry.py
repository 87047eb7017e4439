# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator publishes for people to watch: decimated, and only if somebody listens."""

from collections.abc import Callable
from typing import Any, NamedTuple

from dewing_sim.lockstep import LockStep
from dewing_sim.parameters import Case
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema
from dewing_sim.ros import messages, names, qos
from dewing_sim.ros.clock import SimulatedClock
from dewing_sim.settings import Run


class Channel(NamedTuple):
    """A publisher, the steps between its messages, and how a message is made."""

    publisher: Any
    period: int
    make: Callable[[LockStep], Any]


class Telemetry:
    """The topics beside ``measurement``, of which `clock` lives on while the run stands still."""

    def __init__(self, node, case: Case, run: Run, dt: float, outputs: Outputs):
        """Advertise the topics of a plant that has what ``outputs`` has on ``node``.

        Rates become whole numbers of steps of ``dt``.
        """
        self._dt = dt
        self.clock = SimulatedClock(node, run, _period(run.scalar_rate, dt), outputs.time)
        wing, wind = (names.frame(node.get_namespace(), name) for name in ('wing', 'wind'))

        def channel(topic: str, kind: type, rate: float, make: Callable) -> Channel:
            period = _period(rate, dt)
            return Channel(node.create_publisher(kind, topic, qos.every(period)), period, make)

        self._channels = [channel('outputs', messages.JointState, run.scalar_rate,
                                  lambda now: messages.outputs(now.outputs))]
        self._channels += [channel(each.topic, messages.Float64, run.scalar_rate,
                                   _scalar(each.name, outputs))
                           for each in schema(type(outputs)).quantities
                           if each.topic and getattr(outputs, each.name) is not None]
        if _has(outputs, 'cl', 'cd', 'cm') and run.plant != 'reduced':
            self._channels.append(channel(
                'loads', messages.WrenchStamped, run.scalar_rate,
                lambda now: messages.loads(now.outputs, case.flow, case.membrane.chord, wind)))
        if _has(outputs, 'x', 'y', 'pressure_jump', 'tension'):
            self._channels += [
                channel('membrane', messages.PointCloud2, run.membrane_rate,
                        lambda now: messages.membrane(now.outputs, wing)),
                channel('membrane_marker', messages.Marker, run.membrane_rate,
                        lambda now: messages.membrane_marker(
                            now.outputs, run.marker_exaggeration, wing))]

    @property
    def listeners(self) -> int:
        """Number of subscriptions to all topics.

        A listener of several subscribes to them one by one: while the number changes, the first
        sample would miss some.
        """
        return self.clock.listeners + sum(channel.publisher.get_subscription_count()
                                          for channel in self._channels)

    def publish(self, lockstep: LockStep) -> None:
        """Publish what is due at the present time; raise `RunFailed` for what is not finite.

        What is not measured is observed only if somebody listens to it.
        """
        step = round(lockstep.time / self._dt)
        self.clock.publish(lockstep.time, step)
        for publisher, period, make in self._channels:
            if step % period == 0 and publisher.get_subscription_count():
                publisher.publish(make(lockstep))


def _period(rate: float, dt: float) -> int:
    """Return how many steps of ``dt`` (s) there are from one message to the next."""
    return max(1, round(1.0 / (rate * dt)))


def _scalar(name: str, outputs: Outputs) -> Callable[[LockStep], Any]:
    if name in schema(type(outputs)).measured:
        return lambda now: messages.scalar(getattr(now.measurement, name))
    return lambda now: messages.scalar(getattr(now.outputs, name))


def _has(outputs: Outputs, *names: str) -> bool:
    return all(getattr(outputs, name) is not None for name in names)

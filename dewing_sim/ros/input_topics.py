# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What other nodes do to the wing beside V^2: topics in, and one that tells what took effect.

``gust``, ``pressure_disturbance`` and ``motion`` are held, limited and followed as
`inputs.outside` has it; ``inputs`` says what acted during the step that led to the measurement of
its stamp. A message that cannot be used is counted and refused with one sentence.
"""

from array import array
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import Vector3Stamped
from sensor_msgs.msg import FluidPressure, JointState

from dewing_sim.errors import BadInput
from dewing_sim.inputs.outside import NAMES, OutsideInputs
from dewing_sim.ros import messages, qos

Values = tuple[list[float], list[float]]        # and their rates, none where nothing is said


def outside(node) -> OutsideInputs:
    """Return what may act on the plant of a `SimulatorNode` beside V^2."""
    flow, chord = node.case.flow, node.case.membrane.chord
    return OutsideInputs(node.plant, flow.speed, flow.dynamic_pressure, chord,
                         node.settings.inputs.smoothing)


class InputTopics:
    """Listens for a `SimulatorNode`, gives what comes to its plant, and publishes what acts."""

    def __init__(self, node):
        """Subscribe on ``node`` and advertise ``inputs``."""
        self._node, self._outside = node, node.lockstep.outside
        self.refused = 0
        self._told: list = []               # values and rates published last
        self._subscriptions = [
            node.create_subscription(kind, topic, self._taking(topic, read), qos.EVENTS)
            for topic, kind, read in (('gust', Vector3Stamped, _gust),
                                      ('pressure_disturbance', FluidPressure, _pressure),
                                      ('motion', JointState, _motion))]
        self._publisher = node.create_publisher(JointState, 'inputs', qos.every(1))

    def _taking(self, topic: str, read: Callable[[Any, list], Values]) -> Callable[[Any], None]:
        def take(message: Any) -> None:
            try:
                self._outside.give(topic, messages.from_stamp(message.header.stamp),
                                   self._node.lockstep.stamp,
                                   *read(message, self._outside.last[topic].tolist()))
            except BadInput as error:
                self.refused += 1
                self._node.status.set(messages.WARN, str(error))
        return take

    def take(self) -> None:
        """Take what waits in the queues, once somebody has used them.

        A message that was published before a command is then seen before it, whatever the order
        in which the executor is told of them.
        """
        if self._outside.used:
            for subscription in self._subscriptions:
                for message in qos.waiting(subscription):
                    subscription.callback(message)

    def publish(self) -> None:
        """Publish what acted during the last step, unless it is what was said before."""
        if not self._outside.used:
            return
        names, values, rates = self._outside.acting
        if [values, rates] == self._told or not (self._told or any(values) or any(rates)):
            return
        self._told = [values, rates]
        message = JointState(name=list(names), position=array('d', values),
                             velocity=array('d', rates))
        message.header.stamp = messages.to_stamp(self._node.lockstep.stamp)
        qos.publish(self._publisher, message)

    @property
    def figures(self) -> dict[str, int]:
        """Counters for the diagnostics."""
        return dict(refused_inputs=self.refused, late_inputs=self._outside.late)


def _gust(message: Vector3Stamped, _last: list[float]) -> Values:
    vector, frame = message.vector, message.header.frame_id
    if frame.rpartition('/')[2] not in ('', 'wind'):
        raise BadInput(f'gust: frame_id = {frame!r} is not wind: x along the stream, y upwards')
    if vector.z:
        raise BadInput(f'gust: z = {vector.z} m/s, but the wing is a section: z must be zero')
    return [vector.x, vector.y], []


def _pressure(message: FluidPressure, _last: list[float]) -> Values:
    return [message.fluid_pressure], []


def _motion(message: JointState, last: list[float]) -> Values:
    """Return heave and pitch and their rates; one that is not named stays where it is."""
    names = list(message.name)
    if not (names and set(names) <= set(NAMES['motion']) and len(set(names)) == len(names)
            and len(message.position) == len(names)
            and len(message.velocity) in (0, len(names))):
        raise BadInput(f'motion with names {names}, {len(message.position)} positions and '
                       f'{len(message.velocity)} velocities; expected heave, pitch or both')
    value = dict(zip(NAMES['motion'], last)) | dict(zip(names, message.position))
    rate = dict.fromkeys(NAMES['motion'], 0.0) | dict(zip(names, message.velocity))
    return [*value.values()], [*rate.values()]

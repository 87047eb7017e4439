# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where the frames of a wing are: ``map`` to ``wing``, fixed, and ``wing`` to ``wind``.

``wing`` has x from the leading to the trailing edge, y towards the upper side and so z towards the
left wing tip. REP 103 has z upwards in the world: in ``map``, wing x is x, wing y is z, and the
air comes along x at no angle of attack. A body of REP 103 would have x forward and z up, which is
-x and y here. ``wind`` is turned about z by the incidence, so that its x is the stream; it moves
only with a wing that pitches. The place of a wing in ``map`` does not follow its heave.
"""

import math
from typing import Any

from geometry_msgs.msg import Quaternion, TransformStamped

from dewing_sim.lockstep import LockStep
from dewing_sim.ros import messages, names, qos

try:
    from tf2_msgs.msg import TFMessage
except ImportError:             # the wheels of ROS have no tf2_msgs; a system ROS has
    TFMessage = None

WORLD = 'map'                   # the frame that viewers begin with


class Transforms:
    """Publishes the frames of the wing of a `SimulatorNode`, if it has an incidence both."""

    def __init__(self, node):
        """Advertise ``/tf_static`` on ``node``, and ``/tf`` if its wing may pitch."""
        self._wing, self._wind = (names.frame(node.get_namespace(), name)
                                  for name in ('wing', 'wind'))
        self._incidence, self._publisher = node.built.incidence, None
        self._period = max(1, round(1.0 / (node.run.membrane_rate * node.plant.dt)))
        if TFMessage is None:
            return
        still = [about_x(WORLD, self._wing, 0.5 * math.pi)]
        if self._incidence and node.built.pitches:
            self._publisher = node.create_publisher(TFMessage, '/tf', qos.every(self._period))
        elif self._incidence:
            still.append(self._turned(node.lockstep.state))
        self._still = node.create_publisher(TFMessage, '/tf_static', qos.LATCHED)
        self._still.publish(TFMessage(transforms=still))

    def publish(self, lockstep: LockStep) -> None:
        """Publish what is due at the time of ``lockstep``."""
        if self._publisher is None or not self._publisher.get_subscription_count():
            return
        if round(lockstep.time / lockstep.plant.dt) % self._period == 0:
            turned = self._turned(lockstep.state)
            turned.header.stamp = messages.to_stamp(lockstep.stamp)
            self._publisher.publish(TFMessage(transforms=[turned]))

    def _turned(self, state: Any) -> TransformStamped:
        return about_z(self._wing, self._wind, self._incidence(state))


def about_x(parent: str, child: str, angle: float) -> TransformStamped:
    """Return a frame turned by ``angle`` (rad) about x, at the same place."""
    transform, half = _between(parent, child), 0.5 * angle
    transform.transform.rotation = Quaternion(x=math.sin(half), w=math.cos(half))
    return transform


def about_z(parent: str, child: str, angle: float) -> TransformStamped:
    """Return a frame turned by ``angle`` (rad) about z, at the same place."""
    transform, half = _between(parent, child), 0.5 * angle
    transform.transform.rotation = Quaternion(z=math.sin(half), w=math.cos(half))
    return transform


def _between(parent: str, child: str) -> TransformStamped:
    transform = TransformStamped(child_frame_id=child)
    transform.header.frame_id = parent
    return transform

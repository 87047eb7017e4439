# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Taking turns at one wing: who commands it, who stands by, and who gives it up for a while.

Whoever offers `command` counts as a controller, and the simulator waits for its answers. So a
node that commands now and then offers it only in its turn; between turns it stands by on
``standby``, and a simulator without any controller then waits for one as long as it takes.
"""

from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool

from dewing_sim.ros import qos

STANDBY, RELEASE = 'standby', 'controller/release'
ASKED = 'the controller is asked to give the wing up'


class Turn:
    """The turn of a node that commands now and then; a controller is asked to give up its own."""

    def __init__(self, node: Node):
        """Stand by."""
        self._node, self._command = node, None
        self._asked: Future | None = None
        self._release = node.create_client(SetBool, RELEASE)
        self._standby = node.create_publisher(String, STANDBY, qos.LATCHED)
        self._standby.publish(String(data=node.get_fully_qualified_name()))

    @property
    def obstacle(self) -> str | None:
        """Say who has the wing, asking for it if that can be done; None if nobody has it."""
        others = self._node.count_publishers('command') - (self._command is not None)
        if not others:
            return None
        if not self._release.service_is_ready():
            return 'another controller publishes commands: stop it first'
        if self._asked is None:
            self._asked = self._release.call_async(SetBool.Request(data=True))
        return ASKED

    def take(self) -> None:
        """Offer ``command``."""
        if self._command is None:
            self._command = self._node.create_publisher(JointState, 'command', qos.LOOP)

    def publish(self, data: bytes) -> None:
        """Publish a command."""
        if self._command is not None:
            qos.publish(self._command, data)

    def leave(self) -> None:
        """Offer ``command`` no longer, and give the wing back to whom it was taken from."""
        if self._command is not None:
            self._node.destroy_publisher(self._command)
            self._command = None
        if self._asked is not None:
            self._asked = None
            self._release.call_async(SetBool.Request(data=False))

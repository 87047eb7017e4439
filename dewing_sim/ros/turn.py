# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Taking turns at one wing: who commands it, who stands by, and who gives it up for a while.

Whoever offers `command` counts as a controller, and the simulator waits for its answers. So a
node that commands now and then offers it only in its turn; between turns it stands by on
``standby``, and a simulator without any controller then waits for one as long as it takes.
"""

from time import monotonic

from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool

from dewing_sim.ros import qos

STANDBY, RELEASE = 'standby', 'controller/release'
ASKED = 'the controller is asked to give the wing up'
SETTLING = 'listeners of command are waited for'
SOON = (ASKED, SETTLING)
SETTLED = 0.5               # s from the offer of command on: a recorder has subscribed to it


class Turn:
    """The turn of a node that commands now and then; a controller is asked to give up its own."""

    def __init__(self, node: Node, at_once: bool):
        """Stand by, or offer ``command`` already if the turn is to begin ``at_once``."""
        self._node, self._command, self._taken = node, None, 0.0
        self._asked: Future | None = None
        self._release = node.create_client(SetBool, RELEASE)
        self._standby = node.create_publisher(String, STANDBY, qos.LATCHED)
        self._standby.publish(String(data=node.get_fully_qualified_name()))
        if at_once:
            self._take()

    @property
    def obstacle(self) -> str | None:
        """Say what the turn waits for, and do something about it; None if it may begin."""
        others = self._node.count_publishers('command') - (self._command is not None)
        if not others:
            self._take()
            return SETTLING if monotonic() - self._taken < SETTLED else None
        if not self._release.service_is_ready():
            return 'another controller publishes commands: stop it first'
        if self._asked is None:
            self._asked = self._release.call_async(SetBool.Request(data=True))
        return ASKED

    def _take(self) -> None:
        if self._command is None:
            self._taken = monotonic()
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

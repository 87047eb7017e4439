# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes from outside for the executable ``loop``: one that answers, and one that fails."""

from rclpy.node import Node
from sensor_msgs.msg import JointState

from dewing_sim.ros import messages, qos

V_SQUARED = 2.0e5


class Constant(Node):
    """Answers every measurement with the same V^2; knows nothing of exit status and interrupt."""

    def __init__(self):
        super().__init__('constant', namespace='dewing')
        self.out = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(JointState, 'measurement', self.answer, qos.LATEST)

    def answer(self, message):
        self.out.publish(messages.command(V_SQUARED, message.header.stamp))


class Mortal(Constant):
    """Ends with status 1 after ten answers."""

    exit_status, reason, made = None, 'that was all', 0

    def answer(self, message):
        super().answer(message)
        self.made += 1
        if self.made == 10:
            self.exit_status = 1

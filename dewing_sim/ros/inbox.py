# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements that came before they could be answered, or faster than they are.

A plant in the loop sends a measurement again, or goes on without its answer: only the last counts.
A recording that is played does neither: every measurement counts, from the first one on, or the
answers are not those of the flight. The two are told apart by the ROS graph: a plant listens to
the commands, a player does not.
"""

from collections import deque
from collections.abc import Callable
from time import perf_counter

from rclpy.node import Node
from sensor_msgs.msg import JointState

from dewing_sim.ros import qos

AT_ONCE = 3.0e-5            # s after an answer: what comes sooner had been waiting


def is_live(node: Node) -> bool:
    """Return whether a node that publishes ``measurement`` listens to ``command``."""
    def ends(infos) -> set[tuple[str, str]]:
        return {(info.node_namespace, info.node_name) for info in infos}
    return not ends(node.get_publishers_info_by_topic('measurement')).isdisjoint(
        ends(node.get_subscriptions_info_by_topic('command')))


class Inbox:
    """The subscription to ``measurement`` of a controller; hands on one message after another.

    What comes while the controller is not ``ready()`` is kept, each message once and in order, and
    goes to ``answer(data)`` when it is. Only the last counts to a plant in the loop.
    """

    def __init__(self, node: Node, ready: Callable[[], bool], answer: Callable[[bytes], None]):
        """Subscribe; `look` is to be called now and then, and when ``ready`` may have changed."""
        self._node, self._ready, self._answer = node, ready, answer
        self._kept: deque[bytes] = deque(maxlen=qos.KEPT)
        self._answered, self._live = 0.0, False
        self._subscription = node.create_subscription(
            JointState, 'measurement', self._on_message, qos.DEEP, raw=True)

    def _on_message(self, data: bytes) -> None:
        self._keep(data)
        if self._live and perf_counter() - self._answered < AT_ONCE:
            self._keep_waiting()
        self._hand_on()

    def look(self) -> None:
        """See whether a plant is there, take what nobody told of, and hand on what was kept."""
        self._live = is_live(self._node)
        self._keep_waiting()
        self._hand_on()

    def _keep_waiting(self) -> None:
        for data in qos.waiting(self._subscription):
            self._keep(data)

    def _keep(self, data: bytes) -> None:
        if not self._kept or data != self._kept[-1]:
            self._kept.append(data)

    def _hand_on(self) -> None:
        if not self._ready():
            return
        while self._kept:
            data = self._kept.popleft()
            if not (self._live and self._kept):
                self._answer(data)
        self._answered = perf_counter()

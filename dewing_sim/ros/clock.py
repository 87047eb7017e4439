# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time on a topic, from before the first step on and while the run stands still.

A node with ``use_sim_time`` may wait for the clock before it does anything, even before it offers
the command that the run waits for. So the clock is published while nothing moves too.
"""

import math
from time import monotonic

from rclpy.clock import Clock, ClockType

from dewing_sim.ros import messages, qos
from dewing_sim.settings import Run

PERIOD = 0.1                # s, wall: longest silence


class SimulatedClock:
    """Publishes simulated time every few steps, and the last one again after `PERIOD`.

    Two clocks on one topic would make time jump to and fro for whoever listens.
    """

    def __init__(self, node, run: Run, period: int, time: float):
        """Advertise the clock topic of ``run`` on ``node``, unless there is to be none.

        Until the first step it is ``time`` (s); in a moving run every ``period``-th step is told.
        """
        self._node, self._period, self._time, self._told = node, period, time, -math.inf
        self._publisher = None
        if run.publish_clock:
            self._publisher = node.create_publisher(
                messages.Clock, run.clock_topic, qos.every(period))
            node.create_timer(PERIOD, self._repeat, clock=Clock(clock_type=ClockType.STEADY_TIME))

    @property
    def listeners(self) -> int:
        """Number of subscriptions to the clock."""
        return self._publisher.get_subscription_count() if self._publisher else 0

    @property
    def caution(self) -> str:
        """Say that another node publishes the same clock, or nothing."""
        if self._publisher is None:
            return ''
        topic = self._publisher.topic_name
        others = self._node.count_publishers(topic) - 1
        if others < 1:
            return ''
        return (f'{others} more publish {topic}, which jumps to and fro: set run.publish_clock '
                'to false, or run.clock_topic to another topic')

    def publish(self, time: float, step: int) -> None:
        """Let it be ``time`` (s), and publish it if ``step`` is one that is told."""
        self._time = time
        if step % self._period == 0:
            self._tell()

    def _repeat(self):
        if monotonic() - self._told > 0.9 * PERIOD:
            self._tell()

    def _tell(self):
        if self.listeners:
            self._publisher.publish(messages.clock(self._time))
            self._told = monotonic()

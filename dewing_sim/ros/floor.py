# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The floor of any lap over ROS 2: bytes to another process and back, without a plant."""

import tempfile
from time import perf_counter

import numpy as np
from rclpy.node import Node
from std_msgs.msg import UInt8MultiArray

from dewing_sim.machine import signals
from dewing_sim.ros import harness, qos

BYTES = bytes((0, 1, 0, 0)) + bytes(8) + bytes((232, 0, 0, 0)) + bytes(232)    # CDR, 232 bytes
PATIENCE = 60.0             # s


class Echo(Node):
    """Sends back what comes, and knows nothing of it."""

    def __init__(self, parameters=None, **options):
        super().__init__('echo', namespace='dewing', **harness.overrides(parameters), **options)
        back = self.create_publisher(UInt8MultiArray, 'back', qos.LOOP)
        self.create_subscription(UInt8MultiArray, 'there', back.publish, qos.LOOP, raw=True)

    def interrupt(self):
        """Nothing is kept."""


class Caller(Node):
    """Sends bytes and notes when they are back."""

    def __init__(self, parameters=None, **options):
        super().__init__('caller', namespace='dewing', **harness.overrides(parameters), **options)
        self.times: list[float] = []
        self.publisher = self.create_publisher(UInt8MultiArray, 'there', qos.LOOP)
        self.create_subscription(UInt8MultiArray, 'back', self._on_back, qos.LOOP, raw=True)

    @property
    def met(self) -> bool:
        """Whether the echo hears and is heard."""
        return bool(self.publisher.get_subscription_count() and self.count_publishers('back'))

    def call(self):
        """Send."""
        self._sent = perf_counter()
        self.publisher.publish(BYTES)

    def _on_back(self, _data: bytes):
        self.times.append(perf_counter() - self._sent)
        self.call()


def round_trip(repetitions: int) -> float:
    """Return the median milliseconds of raw bytes to another process and back over DDS."""
    with (harness.reserved_domain() as domain,
          tempfile.TemporaryDirectory(prefix='dewing-floor-') as folder):
        process = harness.start_node(__name__, {}, harness.environment(domain, folder))
        try:
            with harness.Session(domain) as session:
                caller = session.add(Caller)
                session.spin_until(lambda: caller.met, PATIENCE)
                caller.call()
                session.spin_until(lambda: len(caller.times) >= repetitions, PATIENCE)
        finally:
            signals.end(process)
    return 1.0e3 * float(np.median(caller.times[repetitions // 10:]))


def main(args=None) -> int:
    """Echo until a signal comes."""
    return harness.main(Echo, args)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service of every topic, and how much a listener may fall behind.

The loop (``measurement``, ``command``) keeps every message until all reliable listeners have
taken it. Fast DDS keeps `KEPT` on the side of the publisher and as many on that of a keep-all
listener; when both are full, the publisher waits, so that nobody loses a step of the loop. A
listener that died or does not run is given up 20 s after its last sign of life, the lease of its
participant: from then on nobody waits for it.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from rclpy.duration import Duration
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from dewing_sim.ros.awake import Awake

KEPT = 5000                 # messages, max_samples of Fast DDS
TELL = 2.0                  # s of waiting after which one says so
PATIENCE = 30.0             # s, longer than the lease of a participant that died

LOOP = QoSProfile(history=HistoryPolicy.KEEP_ALL)
LATEST = QoSProfile(depth=10)                   # of a listener that needs no old message
DEEP = QoSProfile(depth=KEPT)                   # of one that may be busy while a bag is played
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
EVENTS = QoSProfile(depth=1000)                 # diagnostics


def every(period: int) -> QoSProfile:
    """Return the profile of what is published every ``period`` steps of the loop.

    It is deep enough that a listener of the loop which lost nothing there loses nothing here.
    """
    return QoSProfile(depth=max(10, 2 * KEPT // period))


def complete(offered: QoSProfile) -> QoSProfile:
    """Return the profile of a listener that wants all that a publisher has ``offered``."""
    reliable = offered.reliability is not ReliabilityPolicy.BEST_EFFORT
    latched = offered.durability is DurabilityPolicy.TRANSIENT_LOCAL
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE)


def publish(publisher, message: Any) -> bool:
    """Return whether ``message`` went out, False if after 0.1 s all queues are still full."""
    try:
        publisher.publish(message)
    except rclpy_implementation.RCLError:
        return False
    return True


def waiting(subscription) -> Iterator[Any]:
    """Yield the messages that wait in the queue of ``subscription``, told of or not.

    An executor of events knows of a message only by being told. After one lost notice it would
    stay one message behind for good, and answer every question with the answer before it.
    """
    queue = subscription.handle
    with queue:
        while taken := queue.take_message(subscription.msg_type, subscription.raw):
            yield taken[0]


def deliver(publishers: Iterable[Any], patience: float = PATIENCE,
            slow: Callable[[str], None] = lambda topic: None) -> None:
    """Wait until the reliable listeners have all messages or are gone, ``patience`` s at most.

    ``slow`` is told of the topic whose listeners first take longer than `TELL` s.
    """
    awake, told = Awake(), False
    for publisher in list(publishers):
        while not publisher.wait_for_all_acked(Duration(seconds=0.2)):
            waited = awake()        # in short waits, between which a signal is heard
            if waited > patience:
                return
            if waited > TELL and not told:
                told = True
                slow(publisher.topic_name)

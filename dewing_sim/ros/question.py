# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement that awaits its answer: published, repeated, and held back by slow listeners."""

from time import monotonic

from sensor_msgs.msg import JointState

from dewing_sim.ros import codec, messages, qos


class Question:
    """The present measurement and how long ago it was published.

    While a listener cannot take a measurement it is `blocked`, the run waits, and says so.
    """

    def __init__(self, node, resend_period: float):
        """Advertise ``measurement`` on ``node``."""
        self._status, self._lockstep = node.status, node.lockstep
        self._layout = codec.layout(node.lockstep.measurement._fields[1:], 'position')
        self._message = b''
        self._publisher = node.create_publisher(JointState, 'measurement', qos.LOOP)
        self._resend_period = resend_period
        self.asked = self._sent = monotonic()       # for the first and for the last time
        self.answered, self.blocked, self.resent = True, False, 0

    @property
    def listeners(self) -> int:
        """Number of subscriptions to ``measurement``."""
        return self._publisher.get_subscription_count()

    def ask(self) -> None:
        """Publish the present measurement for the first time."""
        lockstep, self.answered = self._lockstep, False
        self._message = self._layout.encode(lockstep.stamp, lockstep.measurement[1:])
        self.asked = self._sent = monotonic()
        self.offer()

    def offer(self) -> None:
        """Publish the present measurement (again), or say that it cannot be taken."""
        self.blocked = not qos.publish(self._publisher, self._message)
        if self.blocked:
            self._status.set(messages.WARN, f'{self.missing}: simulated time waits for it')

    def repeat(self, now: float) -> None:
        """Publish again what was blocked, or what has had no answer for the resend period."""
        if self.blocked:
            self.offer()
        elif now - self._sent > self._resend_period:
            self._sent, self.resent = now, self.resent + 1
            self.offer()

    def gone(self, wanted: int) -> str:
        """Say that fewer listeners are left than were ``wanted``, or nothing."""
        if self.listeners >= wanted:
            return ''
        return (f'{self.listeners} of {wanted} listeners of measurement are left: nobody waits '
                'for the others, and what they record has a gap')

    @property
    def missing(self) -> str:
        """What the run waits for."""
        return 'a listener of measurement does not keep up' if self.blocked else 'no valid command'

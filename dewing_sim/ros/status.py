# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a node says of itself on ``/diagnostics``: a level, a sentence and some numbers."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from dewing_sim.ros import messages, qos

REMEMBERED = 1000           # warnings


class Status:
    """Level and sentence in force; published when they change and whenever `report` is called.

    ``values()`` gives the numbers that go with them.
    """

    def __init__(self, node, sentence: str, values: Callable[[], Mapping[str, Any]]):
        """Advertise ``/diagnostics`` on ``node``."""
        self._node, self._values = node, values
        self._publisher = node.create_publisher(messages.DiagnosticArray, '/diagnostics',
                                                qos.EVENTS)
        self.level, self.sentence = messages.OK, sentence
        self._fine, self._doubts = '', set()        # logged: the last sentence, all warnings

    def set(self, level: bytes, sentence: str) -> None:
        """Publish level and sentence if either is new, and log what was not logged before."""
        if (level, sentence) == (self.level, self.sentence):
            return
        self.level, self.sentence = level, sentence
        self.report()
        self._log(level, sentence)

    def _log(self, level: bytes, sentence: str) -> None:
        """Log each warning once, and what is well whenever it is not what it was."""
        if level != messages.OK:
            if sentence not in self._doubts:
                self._node.get_logger().warning(sentence)
            self._doubts.add(sentence)
            if len(self._doubts) > REMEMBERED:
                self._doubts.clear()
        elif sentence != self._fine:
            self._fine = sentence
            self._node.get_logger().info(sentence)

    def deliver(self, publishers: Iterable[Any], patience: float) -> None:
        """Wait for slow listeners as `qos.deliver` does, and say for which."""
        qos.deliver(publishers, patience, lambda topic: self.set(
            self.level, f'{self.sentence}; listeners of {topic} are waited for, '
                        f'{patience:g} s at most'))

    def report(self) -> None:
        """Publish what is in force."""
        stamp = self._node.get_clock().now().to_msg()
        qos.publish(self._publisher, messages.diagnostics(
            self._node.get_fully_qualified_name(), self.level, self.sentence, self._values(),
            stamp))

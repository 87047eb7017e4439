# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator brought to rest before every run, by its service ``reset``."""

from collections.abc import Callable

from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger


class Rest:
    """Asks for the rest state; ``granted`` is called when the last one asked for is there.

    A reply may get lost: on a busy machine the reader of replies can be known to the simulator
    only after it has answered. To ask again is safe.
    """

    def __init__(self, node: Node, granted: Callable[[], None]):
        """Look for the service from ``node``."""
        self._client = node.create_client(Trigger, 'simulator/reset')
        self._granted, self._asked = granted, None

    @property
    def there(self) -> bool:
        """Whether there is a simulator to ask."""
        return self._client.service_is_ready()

    @property
    def awaited(self) -> bool:
        """Whether the reply is still to come."""
        return self._asked is not None

    def ask(self) -> None:
        """Ask for the rest state (again)."""
        self._asked = self._client.call_async(Trigger.Request())
        self._asked.add_done_callback(self._on_reply)

    def leave(self) -> Future:
        """Ask for the rest state and do not wait for it."""
        self._asked = None
        return self._client.call_async(Trigger.Request())

    def _on_reply(self, reply: Future):
        if reply is self._asked:
            self._asked = None
            self._granted()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A service that may answer after its callback: what it was asked to do takes a while."""

from collections.abc import Callable
from typing import Any

Answer = tuple[bool, str]       # success and a sentence


class LateAnswer:
    """A service with success and message whose ``act(request)`` answers, or gives None for later.

    The executor of events runs no coroutines, with which rclpy's others would wait.
    """

    def __init__(self, node, kind: type, name: str, act: Callable[[Any], Answer | None]):
        """Advertise the service ``name`` on ``node``."""
        self._act, self._late = act, False
        self._waiting: list[tuple[Any, Any]] = []       # responses and to whom they go
        service = node.create_service(kind, name, self._take)
        self._send, service.send_response = service.send_response, self._respond

    def _take(self, request: Any, response: Any) -> Any:
        answer = self._act(request)
        self._late = answer is None
        if answer is not None:
            response.success, response.message = answer
        return response

    def _respond(self, response: Any, header: Any) -> None:
        """Send what the callback has answered, or keep it until `give`."""
        if self._late:
            self._waiting.append((response, header))
        else:
            self._send(response, header)

    def give(self, success: bool, message: str) -> None:
        """Answer everybody who waits."""
        waiting, self._waiting = self._waiting, []
        for response, header in waiting:
            response.success, response.message = success, message
            self._send(response, header)

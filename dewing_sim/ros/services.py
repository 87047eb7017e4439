# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's services: pause, step, reset, save and restore.

Each answers once it is done, with what is true then.
"""

from collections.abc import Callable
from typing import Any

from std_srvs.srv import SetBool, Trigger

from dewing_sim.errors import BadInput
from dewing_sim.ros.late_answer import Answer, LateAnswer

RESCUE = 'dewing_state.npz'


class Services:
    """Offers the services of a `SimulatorNode`; each answers with success and a sentence."""

    def __init__(self, node):
        """Advertise the services as ``~/NAME`` on ``node``."""
        self._node = node
        self._offer(SetBool, 'pause', lambda request: self._pause(request.data))
        self._steps = LateAnswer(node, Trigger, '~/step', lambda _: self._step())
        self._offer(Trigger, 'reset', lambda _: self._reset())
        self._offer(Trigger, 'save', lambda _: self.save())
        self._offer(Trigger, 'restore', lambda _: self._restore())

    def _offer(self, kind: type, name: str, act: Callable[[Any], Answer]):
        def answer(request, response):
            response.success, response.message = act(request)
            return response
        self._node.create_service(kind, f'~/{name}', answer)

    def _pause(self, wanted: bool) -> Answer:
        if self._over:
            return False, self._over
        self._node.loop.pause(wanted)
        return True, f'{"paused" if wanted else "running"} {self._at()}'

    def _step(self) -> Answer | None:
        """Make steps; those of lock-step wait for commands, and the answer for them."""
        loop = self._node.loop
        if not loop.make_steps(self._node.run.step_count):
            return False, self._over or 'only when paused, and when no other call is under way'
        if self._over:
            return False, self._over
        return None if loop.granted else (True, self._at())

    def steps_end(self, reason: str = '') -> None:
        """Answer who waits for steps: they are made, or will not be for a ``reason``."""
        self._steps.give(not reason, reason or self._at())

    def _reset(self) -> Answer:
        if self._over:
            return False, self._over
        self._node.loop.restart(self._node.built.rest)
        return True, f'at rest {self._at()}'

    def save(self) -> Answer:
        """Save the last good state; say where it is, or why it is not."""
        node = self._node
        try:
            node.built.save(self.rescue, node.lockstep.state)
        except (BadInput, OSError) as error:
            return False, f'its state could not be saved: {error}'
        return True, f'state saved in {self.rescue}, {self._at()}'

    @property
    def rescue(self) -> str:
        """The file for the state of the run."""
        return self._node.settings.save or RESCUE

    def _restore(self) -> Answer:
        if self._over:
            return False, self._over
        path = self._node.settings.restore or self.rescue
        try:
            self._node.loop.restart(self._node.built.load(path))
        except BadInput as error:
            return False, str(error)
        return True, f'{self._at()}, from {path}'

    @property
    def _over(self) -> str:
        """How the run ended, if it did."""
        return '' if self._node.exit_status is None else f'the run is over: {self._node.reason}'

    def _at(self) -> str:
        return f'at {self._node.lockstep.time:.9f} s'

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's services: pause, step, reset, save and restore."""

from collections.abc import Callable
from typing import Any

from std_srvs.srv import SetBool, Trigger

from dewing_sim.errors import BadInput

RESCUE = 'dewing_state.npz'
Answer = tuple[bool, str]       # success and a sentence


class Services:
    """Offers the services of a `SimulatorNode`; each answers with success and a sentence."""

    def __init__(self, node):
        """Advertise the services as ``~/NAME`` on ``node``."""
        self._node = node
        self._offer(SetBool, 'pause', lambda request: self._pause(request.data))
        self._offer(Trigger, 'step', lambda _: self._step())
        self._offer(Trigger, 'reset', lambda _: self._reset())
        self._offer(Trigger, 'save', lambda _: self.save())
        self._offer(Trigger, 'restore', lambda _: self._restore())

    def _offer(self, kind: type, name: str, act: Callable[[Any], Answer]):
        def answer(request, response):
            response.success, response.message = act(request)
            return response
        self._node.create_service(kind, f'~/{name}', answer)

    def _pause(self, wanted: bool) -> Answer:
        self._node.loop.pause(wanted)
        return True, 'paused' if wanted else 'running'

    def _step(self) -> Answer:
        if not self._node.loop.make_steps(self._node.run.step_count):
            return False, 'only when paused, and in lock-step after a command'
        return True, self._at()

    def _reset(self) -> Answer:
        self._node.loop.restart(self._node.built.rest)
        return True, 'at rest'

    def save(self) -> Answer:
        """Save the last good state; say where it is, or why it is not."""
        node = self._node
        try:
            node.built.save(self.rescue, node.lockstep.state)
        except (BadInput, OSError) as error:
            return False, f'its state could not be saved: {error}'
        return True, f'state saved in {self.rescue}'

    @property
    def rescue(self) -> str:
        """The file for the state of the run."""
        return self._node.settings.save or RESCUE

    def _restore(self) -> Answer:
        path = self._node.settings.restore or self.rescue
        try:
            self._node.loop.restart(self._node.built.load(path))
        except BadInput as error:
            return False, str(error)
        return True, f'{self._at()}, from {path}'

    def _at(self) -> str:
        return f'at {self._node.lockstep.time:.9f} s'

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator waits for, and how long: everybody at the start, then every answer."""

from time import monotonic

from rclpy.clock import Clock, ClockType

from dewing_sim.ros import messages, qos

PERIOD = 0.05               # s, wall


class Watch:
    """Starts the loop of a `SimulatorNode` and ends it when nobody comes or answers."""

    def __init__(self, node):
        """Look every `PERIOD` from now on."""
        self._node, self._loop, self._question = node, node.loop, node.question
        self._created = monotonic()
        self._held = 0.0        # when the measurement was asked whose silence was reported
        node.create_timer(PERIOD, self.look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    @property
    def controllers(self) -> int:
        """Number of publishers of ``command``."""
        return self._node.command.get_publisher_count()

    @property
    def absent(self) -> str:
        """Say who is there and who is waited for before the first step."""
        return self._question.waiting(self.controllers, self._node.run.subscribers)

    def look(self):
        """Start when everybody is there; ask again and give up when no answer comes."""
        if self._node.exit_status is not None:
            return
        now = monotonic()
        if not self._loop.started:
            self._start_when_ready(now)
        elif self._loop.awaits_command:
            for message in qos.waiting(self._node.command):
                self._loop.on_command(message)
            self._insist(now)

    def _start_when_ready(self, now: float):
        run = self._node.run
        ready = self._question.listeners >= run.subscribers
        if ready and (self.controllers or not self._loop.locked):
            self._loop.start(now)
        elif now - self._created > run.discovery_timeout:
            self._node.finish(1, f'waited for {run.discovery_timeout:g} s: {self.absent}')

    def _insist(self, now: float):
        lockstep, run = self._node.lockstep, self._node.run
        asked, missing = self._question.asked, self._question.missing
        waited = now - asked
        if waited > run.command_timeout + run.hold_timeout:
            self._node.finish(1, f'{missing} for {waited:.1f} s of wall time at '
                                 f'{lockstep.outputs.time:.6f} s: stopped')
            return
        self._question.repeat(now)
        if waited > run.command_timeout and self._held != asked:
            self._held = asked
            self._node.status.set(messages.WARN, (
                f'{missing} for {waited:.1f} s: V^2 = {lockstep.v_squared:g} V^2 and '
                f'simulated time are held, stopping in {run.hold_timeout:g} s'))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator waits for, and how long: everybody at the start, then every answer."""

from time import monotonic

from rclpy.clock import Clock, ClockType

from dewing_sim.ros import messages, qos, turn, watchdog
from dewing_sim.ros.awake import Awake
from dewing_sim.ros.watchdog import Watchdog

PERIOD = 0.05               # s, wall


class Watch:
    """Starts the loop of a `SimulatorNode` and ends it when nobody comes or answers."""

    def __init__(self, node):
        """Look every `PERIOD` from now on."""
        self._node, self._loop, self._question = node, node.loop, node.question
        self._awake = Awake()
        self._asked = (0.0, 0.0)    # when the measurement in force was: by the clock, and awake
        self._held = 0.0            # when that was asked whose silence was reported
        self._idle = False          # nobody commands, and somebody stands by
        self._listeners = -1        # to the telemetry, when last looked at
        self._watchdog = Watchdog(lambda sentence: node.status.set(messages.WARN, sentence),
                                  watchdog.PATIENCE + self._loop.deadlines.period)
        node.create_timer(PERIOD, self.look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    @property
    def controllers(self) -> int:
        """Number of publishers of ``command``."""
        return self._node.command.get_publisher_count()

    @property
    def absent(self) -> str:
        """Say who is waited for before the first step."""
        wanted = self._node.run.subscribers
        missing = wanted - self._question.listeners
        return ' and '.join(['a controller'] * self._lacks_controller + [
            f'{missing} of {wanted} listeners of measurement (run.subscribers)'] * (missing > 0))

    @property
    def _lacks_controller(self) -> bool:
        return self._loop.locked and not self.controllers

    def look(self):
        """Start when everybody is there; ask again and give up when no answer comes."""
        if self._node.exit_status is not None:
            return
        now = self._awake()
        if self._asked[0] != self._question.asked:
            self._asked = self._question.asked, now
        if not self._loop.started:
            self._start_when_ready(now)
        elif self._loop.awaits_command:
            for data in qos.waiting(self._node.command):
                self._loop.on_command(data)
            self._question.repeat(monotonic())
            if not self._stood_by(now):
                self._insist(now)
        if self._loop.paced:
            self._keep_pace(now)
        else:
            self._watchdog.rest()

    def _start_when_ready(self, now: float):
        run = self._node.run
        absent, listeners = self.absent, self._node.telemetry.listeners
        settled, self._listeners = listeners == self._listeners, listeners
        if not absent and settled:
            self._loop.start(monotonic())
        elif absent and now > run.discovery_timeout and not self.substitutes:
            self._node.finish(1, f'waited {run.discovery_timeout:g} s (run.discovery_timeout) for '
                                 f'{absent}')

    @property
    def substitutes(self) -> int:
        """Number of nodes that stand by to command, where nobody does."""
        return 0 if self.controllers else self._node.count_publishers(turn.STANDBY)

    def _stood_by(self, now: float) -> bool:
        """Return whether the run has no controller but somebody who may yet be one."""
        idle = self.substitutes > 0
        if idle:
            self._asked = self._question.asked, now         # nobody is late
            self._node.status.set(messages.OK, 'waiting for a controller; a node stands by')
        elif self._idle:
            self._loop.say_state()
        self._idle = idle
        return idle

    def _keep_pace(self, now: float):
        """Give up a listener that blocks for too long; wind up a timer that does not call."""
        if self._question.blocked:
            self._insist(now)
        elif self._watchdog.look(self._node.lockstep.steps,
                                 f'mode {self._node.run.mode}, the next step is overdue'):
            self._loop.wind_up()

    def _insist(self, now: float):
        """Say what a step waits for, and in the end stop."""
        lockstep, run = self._node.lockstep, self._node.run
        asked, missing = self._question.asked, self._question.missing
        waited = now - self._asked[1] if asked == self._asked[0] else 0.0
        if waited > run.command_timeout + run.hold_timeout:
            self._node.finish(1, f'{missing} for {waited:.1f} s of wall time at '
                                 f'{lockstep.time:.6f} s: stopped')
            return
        if waited > run.command_timeout and self._held != asked:
            self._held = asked
            self._node.status.set(messages.WARN, (
                f'{missing} for {waited:.1f} s: V^2 = {lockstep.v_squared:g} V^2 and '
                f'simulated time are held, stopping in {run.hold_timeout:g} s'))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The loop of the simulator: which commands count, when a step is made, what follows it."""

from time import monotonic
from typing import Any

from rclpy.clock import Clock, ClockType

from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.lockstep import Deadlines
from dewing_sim.ros import codec, messages, qos
from dewing_sim.tempo import Tempo


class Loop:
    """Steps the plant of a `SimulatorNode` on commands, in real time, or freely.

    Each of its three entries, `on_command`, `on_pace` and `make_steps`, ends in one step and the
    next measurement.
    """

    def __init__(self, node):
        """Begin before the first measurement: nothing is stepped until `start`."""
        self._node, self._run, self.lockstep = node, node.run, node.lockstep
        self._commands = codec.Reader('effort')
        self.locked = self._run.mode == 'lockstep'
        self.paused = self.started = False
        self.pending: float | None = None       # V^2 that came while paused
        self.granted = 0                        # steps of a paused run still to be made
        self.began = monotonic()
        rate = self._run.rate if self._run.mode == 'realtime' else 0.0
        self.deadlines = Deadlines(node.plant.dt / rate if rate else 0.0)
        self.tempo = Tempo(node.plant.dt, rate)
        self._pace = node.create_timer(self.deadlines.period, self.on_pace,
                                       clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._pace.cancel()

    @property
    def running(self) -> bool:
        """Whether measurements are published and commands taken."""
        return self.started and self._node.exit_status is None

    @property
    def awaits_command(self) -> bool:
        """Whether a step waits for its command."""
        return self.running and self.locked and self.pending is None

    @property
    def paced(self) -> bool:
        """Whether steps are made without waiting for commands."""
        return self.running and not (self.locked or self.paused)

    def wind_up(self):
        """Let the timer of paced steps call again."""
        self.deadlines.start(monotonic())
        self._pace.reset()

    def start(self, now: float):
        """Publish the first measurement."""
        self.started, self.began = True, now
        self._ask()
        self._resume()

    def stop(self):
        """Make no further step by itself."""
        self._pace.cancel()
        self._revoke('the run ended before they were made')

    def on_command(self, data: bytes):
        """Take a command: step on it, keep it, or say why it is not obeyed."""
        if not self.running:
            return
        try:
            command = self._commands.read(data)
            if (self.locked or command.stamp > self.lockstep.stamp) and (
                    not self.lockstep.expects(command.stamp)):
                return
            v_squared = messages.commanded(command)
            self.lockstep.check(v_squared)
        except BadInput as error:
            self.lockstep.rejected += 1
            self._node.status.set(messages.WARN, str(error))
            return
        if not self.locked:
            self._apply(command.stamp, v_squared)
            return
        self.tempo.answered(monotonic())
        if self.paused and not self.granted:
            self.pending = v_squared
        else:
            self._advance(v_squared)

    def _apply(self, stamp: int, v_squared: float):
        """Let V^2 act from now on, whether or not it answers the present measurement."""
        self.lockstep.v_squared = v_squared
        ago = self.lockstep.stamp - stamp
        self.lockstep.late += ago > 0
        self._node.question.answered |= ago == 0
        self.tempo.answered(monotonic(), round(ago * 1.0e-9 / self.tempo.dt))

    def on_pace(self):
        """Make the next step of the modes that wait for no command.

        An answer that is there by now is in time, whatever the executor would have called first.
        """
        for data in qos.waiting(self._node.command):
            self.on_command(data)
        if self._node.exit_status is not None:
            return
        if self._node.question.blocked:
            self._node.question.offer()
            return
        if self._run.mode == 'realtime':
            self._begin_on_time()
            self.lockstep.unanswered += not self._node.question.answered
        self._advance(self.lockstep.v_squared)

    def _begin_on_time(self):
        now = monotonic()
        self.tempo.begin(now, self.deadlines.due)
        self.deadlines.begin(now)

    def _advance(self, v_squared: float):
        was_granted, self.pending = self.granted, None
        self.granted = max(was_granted - 1, 0)
        self._node.inputs.take()
        try:
            if not self.tempo.rate:
                self.tempo.begin(monotonic())
            self.lockstep.advance(v_squared)
            self._ask()
            self.tempo.made(monotonic())
        except RunFailed as error:
            self._node.finish(1, str(error))
            return
        if self._node.status.level != messages.OK and not self._node.question.blocked:
            self.say_state()
        if self._run.save_steps and self.lockstep.steps % self._run.save_steps == 0:
            self._node.served.save()
        if was_granted == 1:
            self._node.served.steps_end()
        end = self._run.duration
        if end and self.lockstep.time > end - 0.5 * self._node.plant.dt:
            self._node.finish(0, f'finished at {end:g} s')

    def _ask(self):
        """Publish the measurement, then, while it is answered, what is due beside it.

        What is found wrong here ends the run before the answer is used.
        """
        self._node.question.ask()
        self._node.telemetry.publish(self.lockstep)
        self._node.inputs.publish()
        self._node.transforms.publish(self.lockstep)

    def say_state(self):
        """Say whether the run goes on or is paused."""
        self._node.status.set(messages.OK, 'paused' if self.paused else 'running')

    def _resume(self):
        self.say_state()
        if not (self.locked or self.paused):
            self.wind_up()

    def pause(self, wanted: bool):
        """Hold simulated time, or go on."""
        self.paused = wanted
        self.tempo.forget()
        if not wanted:
            self._revoke('the run was let go on before they were made')
        if wanted:
            self._pace.cancel()
        if self.running:
            self._resume()
            if not wanted and self.pending is not None:
                self._advance(self.pending)

    def make_steps(self, count: int) -> bool:
        """Grant a paused run ``count`` steps, unless it has some; in lock-step they await answers.

        ``granted`` are those that are not made on return.
        """
        if not (self.running and self.paused and not self.granted):
            return False
        self.granted = count
        if self.locked and self.pending is not None:
            self._advance(self.pending)
        while not self.locked and self.granted and self.running:
            self._advance(self.lockstep.v_squared)
        return True

    def _revoke(self, reason: str):
        """Grant no further step for a ``reason``, and tell who waits for them."""
        self.granted = 0
        self._node.served.steps_end(reason)

    def restart(self, state: Any):
        """Go on from ``state`` at its time."""
        self._revoke('the run began anew before they were made')
        self.lockstep.restart(state)
        self.pending = None
        if self.started:
            self._ask()

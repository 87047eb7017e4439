# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator node: publishes measurement k and steps on the command with the same stamp."""

from collections.abc import Mapping
from time import monotonic
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from dewing_sim.build import build
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.lockstep import Deadlines, LockStep
from dewing_sim.ros import harness, messages, qos
from dewing_sim.ros.question import Question
from dewing_sim.ros.services import Services
from dewing_sim.ros.simulator_parameters import settings_of
from dewing_sim.ros.status import Status
from dewing_sim.ros.telemetry import Telemetry

WATCH_PERIOD = 0.05         # s, wall


class SimulatorNode(Node):
    """Runs a plant in lock-step with a controller, in real time or freely, and publishes it.

    ``exit_status`` is None while the run goes on, then 0 (duration reached) or 1 with ``reason``.
    ``parameters`` maps dotted names to values, as on the command line; raises `BadInput`.
    """

    def __init__(self, parameters: Mapping[str, Any] | None = None, **options):
        super().__init__('simulator', namespace='dewing', **harness.overrides(parameters),
                         **options)
        self.settings, self.case = settings_of(self)
        self.run, restore = self.settings.run, self.settings.restore
        self.built = build(self.settings, self.case, self._log_trim)
        self.plant, self.identity = self.built.plant, self.built.identity
        self.lockstep = LockStep(
            self.plant, self.built.load(restore) if restore else self.built.rest,
            self.identity.v_squared_max)
        self.exit_status: int | None = None
        self.status = Status(self, 'waiting for a controller and listeners', self._values)
        self._locked = self.run.mode == 'lockstep'
        self._paused = self._started = self._overdue = False
        self._pending, self._granted = None, 0
        self._began = self._created = monotonic()
        self._deadlines = Deadlines(
            self.plant.dt / self.run.rate if self.run.mode == 'realtime' else 0.0)
        self._connect()

    @property
    def reason(self) -> str:
        """The sentence of the diagnostics."""
        return self.status.sentence

    def _connect(self):
        self._question = Question(self, self.run.resend_period)
        self._identity = self.create_publisher(String, 'case', qos.LATCHED)
        self._telemetry = Telemetry(
            self, self.case, self.run, self.plant.dt, self.lockstep.outputs)
        self._command = self.create_subscription(
            JointState, 'command', self._on_command, qos.LATEST)
        self.served = Services(self)
        self.add_on_set_parameters_callback(self._on_parameters)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WATCH_PERIOD, self._watch, clock=steady)
        self.create_timer(1.0, self._report, clock=steady)
        self._pace = self.create_timer(self._deadlines.period, self._on_pace, clock=steady)
        self._pace.cancel()
        self._identity.publish(String(data=self.identity.to_yaml()))

    def _log_trim(self, done: int, total: int):
        self.get_logger().info(f'trimming: step {done} of {total}', throttle_duration_sec=2.0)

    def _watch(self):
        """Start when everybody is there; ask again and give up when no answer comes."""
        if self.exit_status is not None:
            return
        now = monotonic()
        if not self._started:
            self._start_when_ready(now)
        elif self._locked and self._pending is None:
            for message in qos.waiting(self._command):
                self._on_command(message)
            self._insist(now)

    def _start_when_ready(self, now: float):
        controllers = self._command.get_publisher_count() if self._locked else 1
        if controllers and self._question.listeners >= self.run.subscribers:
            self._started, self._began = True, now
            self._ask()
            self._resume()
        elif now - self._created > self.run.discovery_timeout:
            self._finish(1, f'waited for {self.run.discovery_timeout:g} s: '
                         + self._question.waiting(controllers, self.run.subscribers))

    def _resume(self):
        self.status.set(messages.OK, 'paused' if self._paused else 'running')
        if not (self._locked or self._paused):
            self._deadlines.start(monotonic())
            self._pace.reset()

    def _ask(self):
        """Publish the present measurement for the first time."""
        self._question.ask(self.lockstep.outputs)
        self._warn_of_block()
        self._telemetry.publish(self.lockstep.outputs)

    def _warn_of_block(self):
        if self._question.blocked:
            self.status.set(messages.WARN,
                            f'{self._question.missing}: simulated time waits for it')

    def _insist(self, now: float):
        waited, missing = now - self._question.asked, self._question.missing
        if waited > self.run.command_timeout + self.run.hold_timeout:
            self._finish(1, f'{missing} for {waited:.1f} s of wall time at '
                            f'{self.lockstep.outputs.time:.6f} s: stopped')
            return
        self._question.repeat(now)
        self._warn_of_block()
        if waited > self.run.command_timeout and not self._overdue:
            self._overdue = True
            self.status.set(messages.WARN, (
                f'{missing} for {waited:.1f} s: V^2 = {self.lockstep.v_squared:g} V^2 and '
                f'simulated time are held, stopping in {self.run.hold_timeout:g} s'))

    def _on_command(self, message: JointState):
        if not self._started or self.exit_status is not None:
            return
        stamp = messages.from_stamp(message.header.stamp)
        if self._locked and not self.lockstep.expects(stamp):
            return
        try:
            v_squared = messages.to_v_squared(message)
            self.lockstep.check(v_squared)
        except BadInput as error:
            self.lockstep.rejected += 1
            self.status.set(messages.WARN, str(error))
            return
        if not self._locked:
            self.lockstep.v_squared = v_squared
            self._question.answered |= stamp == self.lockstep.stamp
        elif self._paused and not self._granted:
            self._pending = v_squared
        else:
            self._advance(v_squared)

    def _on_pace(self):
        """Make the next step of the modes that wait for no command."""
        if self.exit_status is not None:
            return
        if self._question.blocked:
            self._question.offer()
            self._warn_of_block()
            return
        if self.run.mode == 'realtime':
            self._deadlines.begin(monotonic())
            self.lockstep.unanswered += not self._question.answered
        self._advance(self.lockstep.v_squared)

    def _advance(self, v_squared: float):
        self._pending, self._granted = None, max(self._granted - 1, 0)
        try:
            self.lockstep.advance(v_squared)
        except RunFailed as error:
            self._finish(1, str(error))
            return
        if self._overdue or self.status.level != messages.OK:
            self._overdue = False
            self.status.set(messages.OK, 'running')
        if self.run.save_steps and self.lockstep.steps % self.run.save_steps == 0:
            self.served.save()
        self._ask()
        end = self.run.duration
        if end and self.lockstep.outputs.time > end - 0.5 * self.plant.dt:
            self._finish(0, f'finished at {end:g} s')

    def _finish(self, status: int, sentence: str):
        if status or self.settings.save:
            sentence += '; ' + self.served.save()[1]
        self._pace.cancel()
        self.status.set(messages.ERROR if status else messages.OK, sentence)
        self.status.deliver(self.publishers, self.run.delivery_timeout)
        self.exit_status = status

    def interrupt(self):
        """End the run as asked from outside, the state saved if a file is named for it."""
        if self.exit_status is None:
            self._finish(0, f'interrupted at {self.lockstep.outputs.time:.6f} s')

    def _report(self):
        controllers, wanted = self._command.get_publisher_count(), self.run.subscribers
        if not self._started:
            self.status.set(messages.OK, self._question.waiting(controllers, wanted))
        caution = (f'{controllers} controllers: the first answer to a measurement counts'
                   if controllers > 1 else self._question.gone(wanted * self._started)
                   or self.built.caution(self.lockstep.state))
        if self.status.level == messages.OK and caution:
            self.status.set(messages.WARN, caution)
        else:
            self.status.report()

    def _values(self) -> dict[str, Any]:
        wall = self._question.asked - self._began if self._started else 0.0
        return dict(mode=self.run.mode, **self.lockstep.figures(wall),
                    resent=self._question.resent, missed_deadlines=self._deadlines.missed,
                    **vars(self.built.monitor(self.lockstep.state)))

    def pause(self, wanted: bool):
        """Hold simulated time, or go on."""
        self._paused = wanted
        if wanted:
            self._pace.cancel()
        if self._started and self.exit_status is None:
            self._resume()
            if not wanted and self._pending is not None:
                self._advance(self._pending)

    def make_steps(self, count: int) -> bool:
        """Make ``count`` steps of a paused run; in lock-step all but the first await commands."""
        if not (self._started and self._paused and self.exit_status is None
                and (not self._locked or self._pending is not None)):
            return False
        self._granted = count
        if self._locked:
            self._advance(self._pending)
        while not self._locked and self._granted and self.exit_status is None:
            self._advance(self.lockstep.v_squared)
        return True

    def restart(self, state: Any):
        """Go on from ``state`` at its time."""
        self.lockstep.restart(state)
        self._pending, self._granted = None, 0
        if self._started:
            self._ask()

    def _on_parameters(self, given):
        self.settings, answer = messages.changed(self.settings, given)
        self.run = self.settings.run
        return answer


def main(args=None) -> int:
    """Run the simulator until its end or a signal that asks for it; return the exit status."""
    return harness.main(SimulatorNode, args)

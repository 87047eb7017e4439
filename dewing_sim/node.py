# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator node: publishes measurement k and steps on the command with the same stamp."""

from collections.abc import Mapping
from time import monotonic
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from dewing_sim import harness, messages, parameters, qos
from dewing_sim.build import build
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.lockstep import LockStep
from dewing_sim.parameters import Case
from dewing_sim.settings import SimulatorSettings
from dewing_sim.telemetry import Telemetry

WATCH_PERIOD = 0.05         # s, wall
RESCUE = 'dewing_state.npz'


def settings_of(node: Node) -> tuple[SimulatorSettings, Case]:
    """Return the settings and the case that the parameters of ``node`` describe, declared."""
    given = messages.take_overrides(node)
    own = {name for name, _field in parameters.fields(SimulatorSettings)}
    settings = parameters.load('simulator', SimulatorSettings,
                               {name: given.pop(name) for name in own & given.keys()})
    case = parameters.load(settings.case, Case, given)
    messages.declare(node, settings, read_only=True)
    messages.declare(node, case, read_only=True)
    return settings, case


class SimulatorNode(Node):
    """Runs a plant in lock-step with a controller, or freely, and publishes what it does.

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
        self.reason = 'waiting for a controller and listeners'
        self._level = messages.OK
        self._paused, self._pending = False, None
        self._began = self._created = self._asked = self._sent = monotonic()
        self._started, self._overdue, self._resent = False, False, 0
        self._blocked = False
        self._connect()

    def _connect(self):
        self._measurement = self.create_publisher(JointState, 'measurement', qos.LOOP)
        self._identity = self.create_publisher(String, 'case', qos.LATCHED)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', qos.EVENTS)
        self._telemetry = Telemetry(self, self.case, self.run, self.plant.dt)
        self._command = self.create_subscription(
            JointState, 'command', self._on_command, qos.LATEST)
        for name, kind, callback in (('pause', SetBool, self._on_pause),
                                     ('reset', Trigger, self._on_reset),
                                     ('step', Trigger, self._on_step),
                                     ('save', Trigger, self._on_save)):
            self.create_service(kind, f'~/{name}', callback)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WATCH_PERIOD, self._watch, clock=steady)
        self.create_timer(1.0, self._report, clock=steady)
        self._pace = self.create_timer(0.0, self._on_free_step, clock=steady)
        self._pace.cancel()
        self._identity.publish(String(data=self.identity.to_yaml()))

    def _log_trim(self, done: int, total: int):
        self.get_logger().info(f'trimming the wing: step {done} of {total}',
                               throttle_duration_sec=2.0)

    # --- the loop ---------------------------------------------------------------------------

    def _watch(self):
        """Start when everybody is there; ask again and give up when no answer comes."""
        if self.exit_status is not None:
            return
        now = monotonic()
        if not self._started:
            self._start_when_ready(now)
        elif self.run.mode == 'lockstep' and self._pending is None:
            self._insist(now)

    def _start_when_ready(self, now: float):
        controllers = self._command.get_publisher_count() if self.run.mode == 'lockstep' else 1
        listeners = self._measurement.get_subscription_count()
        if controllers and listeners >= self.run.subscribers:
            self._started, self._began = True, now
            self._ask()
            self._set_status(messages.OK, 'running')
            if self.run.mode == 'free' and not self._paused:
                self._pace.reset()
        elif now - self._created > self.run.discovery_timeout:
            self._finish(1, f'{controllers} controllers and {listeners} listeners within '
                            f'{self.run.discovery_timeout:g} s; at least 1 and '
                            f'{self.run.subscribers} are needed')

    def _ask(self):
        """Publish the present measurement for the first time."""
        self._asked = self._sent = monotonic()
        self._offer()
        self._telemetry.publish(self.lockstep.outputs)

    def _offer(self):
        """Publish the present measurement; while a listener cannot take it, the run waits."""
        self._blocked = not qos.publish(self._measurement,
                                        messages.measurement(self.lockstep.outputs))
        if self._blocked:
            self._set_status(messages.WARN, f'{self._missing}: simulated time waits for it')

    @property
    def _missing(self) -> str:
        return ('a listener of measurement does not keep up' if self._blocked
                else 'no valid command')

    def _insist(self, now: float):
        waited = now - self._asked
        if waited > self.run.command_timeout + self.run.hold_timeout:
            self._finish(1, f'{self._missing} for {waited:.1f} s of wall time at '
                            f'{self.lockstep.outputs.time:.6f} s: stopped')
            return
        if self._blocked:
            self._offer()
        elif now - self._sent > self.run.resend_period:
            self._sent, self._resent = now, self._resent + 1
            self._offer()
        if waited > self.run.command_timeout and not self._overdue:
            self._overdue = True
            self._set_status(messages.WARN, (
                f'{self._missing} for {waited:.1f} s: V^2 = {self.lockstep.v_squared:g} V^2 and '
                f'simulated time are held, stopping in {self.run.hold_timeout:g} s'))

    def _on_command(self, message: JointState):
        free = self.run.mode == 'free'
        if not self._started or self.exit_status is not None:
            return
        if not (free or self.lockstep.expects(messages.from_stamp(message.header.stamp))):
            return
        try:
            v_squared = messages.to_v_squared(message)
            self.lockstep.check(v_squared)
        except BadInput as error:
            self.lockstep.rejected += 1
            self._set_status(messages.WARN, str(error))
            return
        if free:
            self.lockstep.v_squared = v_squared
        elif self._paused:
            self._pending = v_squared
        else:
            self._advance(v_squared)

    def _on_free_step(self):
        if self.exit_status is not None:
            return
        if self._blocked:
            self._offer()
        else:
            self._advance(self.lockstep.v_squared)

    def _advance(self, v_squared: float):
        self._pending = None
        try:
            self.lockstep.advance(v_squared)
        except RunFailed as error:
            self._finish(1, str(error))
            return
        if self._overdue or self._level != messages.OK:
            self._overdue = False
            self._set_status(messages.OK, 'running')
        self._ask()
        end = self.run.duration
        if end and self.lockstep.outputs.time > end - 0.5 * self.plant.dt:
            self._finish(0, f'finished at {end:g} s')

    # --- the end, and what is said about it --------------------------------------------------

    def _finish(self, status: int, sentence: str):
        if status or self.settings.save:
            sentence += '; ' + self._save(self.settings.save or RESCUE)
        self._pace.cancel()
        self._set_status(messages.ERROR if status else messages.OK, sentence)
        qos.deliver(self.publishers)
        self.exit_status = status

    def interrupt(self):
        """End the run as asked from outside, the state saved if a file is named for it."""
        if self.exit_status is None:
            self._finish(0, f'interrupted at {self.lockstep.outputs.time:.6f} s')

    def _save(self, path: str) -> str:
        """Save the last good state and say where, or why not."""
        try:
            self.built.save(path, self.lockstep.state)
        except OSError as error:
            return f'its state could not be saved in {path} ({error.strerror})'
        return f'state saved in {path}'

    def _set_status(self, level: bytes, sentence: str):
        changed = (level, sentence) != (self._level, self.reason)
        self._level, self.reason = level, sentence
        if changed:
            self._report()
            if level != messages.OK:
                self.get_logger().warning(sentence)

    def _report(self):
        step, stamp = self.lockstep, self.get_clock().now().to_msg()
        wall = self._asked - self._began if self._started else 0.0
        made = max(step.steps, 1)
        values = dict(
            simulated_time=step.outputs.time, v_squared=step.v_squared, steps=step.steps,
            stale=step.stale, rejected=step.rejected, resent=self._resent,
            ms_per_step=1.0e3 * step.plant_seconds / made,
            overhead_ms_per_step=1.0e3 * max(wall - step.plant_seconds, 0.0) / made)
        self._diagnostics.publish(messages.diagnostics(
            self.get_fully_qualified_name(), self._level, self.reason, values, stamp))

    # --- services ----------------------------------------------------------------------------

    def _on_pause(self, request, response):
        self._paused = request.data
        if self.run.mode == 'free' and self._started:
            (self._pace.cancel if self._paused else self._pace.reset)()
        elif not self._paused and self._pending is not None:
            self._advance(self._pending)
        response.success, response.message = True, 'paused' if request.data else 'running'
        return response

    def _on_reset(self, _request, response):
        self.lockstep.restart(self.built.rest)
        self._pending = None
        if self._started:
            self._ask()
        response.success, response.message = True, 'at rest'
        return response

    def _on_step(self, _request, response):
        free = self.run.mode == 'free'
        response.success = self._started and self._paused and (free or self._pending is not None)
        if response.success:
            self._advance(self.lockstep.v_squared if free else self._pending)
        response.message = (f'at {self.lockstep.outputs.time:.9f} s' if response.success
                            else 'only when paused, and in lock-step after a command')
        return response

    def _on_save(self, _request, response):
        response.message = self._save(self.settings.save or RESCUE)
        response.success = response.message.startswith('state saved')
        return response


def main(args=None) -> int:
    """Run the simulator until its end, SIGINT or SIGTERM; return the exit status."""
    return harness.main(SimulatorNode, args)

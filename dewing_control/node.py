# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The controller node: answers every measurement with V^2 under the measurement's stamp."""

from collections.abc import Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from dewing_control.closed_loop import controller, same_memory
from dewing_control.settings import ControllerSettings
from dewing_sim import harness, messages, parameters, qos
from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity


class ControllerNode(Node):
    """A supervised controller driven by measurements alone; it never looks at a clock.

    A repeated stamp repeats the answer; an earlier one means that the simulator began anew, and
    so does the controller. Settings may change while it runs; the controller keeps what it
    remembers, or begins at the present V^2 where its memory has to be of another form.
    """

    def __init__(self, parameters: Mapping[str, Any] | None = None, **options):
        super().__init__('controller', namespace='dewing', **harness.overrides(parameters),
                         **options)
        self.settings = settings_of(self)
        self.identity: Identity | None = None
        self._law, self._memory = None, None
        self._stamp, self._v_squared = -1, 0.0
        self._answers, self._saturated, self._complaint = 0, 0, ''
        self.add_on_set_parameters_callback(self._on_parameters)
        self._command = self.create_publisher(JointState, 'command', qos.LOOP)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', qos.EVENTS)
        self.create_subscription(String, 'case', self._on_case, qos.LATCHED)
        self.create_subscription(JointState, 'measurement', self._on_measurement, qos.LATEST)
        self.create_timer(1.0, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _on_case(self, message: String):
        try:
            identity = Identity.from_yaml(message.data)
            if identity != self.identity:
                self._law = controller(self.settings, identity)
                self.identity, self._stamp = identity, -1
        except BadInput as error:
            self._complain(str(error))

    def _on_measurement(self, message: JointState):
        """Answer; a measurement that comes before the case will be sent again."""
        if self._law is None:
            return
        stamp = messages.from_stamp(message.header.stamp)
        if stamp != self._stamp:
            try:
                self._decide(messages.to_measurement(message), begin=stamp < self._stamp)
            except BadInput as error:
                self._complain(str(error))
                return
            self._stamp = stamp
        qos.publish(self._command, messages.command(self._v_squared, message.header.stamp))

    def _decide(self, measurement, begin: bool):
        if begin or self._stamp < 0:
            self._memory = self._law.start(measurement.v_squared)
        self._memory, self._v_squared = self._law.step(self._memory, measurement)
        self._answers += 1
        limit = min(self.settings.command.voltage_limit**2, self.identity.v_squared_max)
        self._saturated += self._v_squared in (0.0, limit)

    def _on_parameters(self, given):
        settings, answer = messages.changed(self.settings, given)
        if answer.successful and self.identity is not None:
            try:
                self._law = controller(settings, self.identity)
            except BadInput as error:
                return SetParametersResult(successful=False, reason=str(error))
            if not same_memory(self.settings, settings):
                self._memory = self._law.start(self._v_squared)
        if answer.successful:
            self.settings = settings
        return answer

    def _complain(self, sentence: str):
        if sentence != self._complaint:
            self._complaint = sentence
            self.get_logger().warning(sentence)
            self._report()

    def _report(self):
        level = messages.WARN if self._complaint or self.identity is None else messages.OK
        waiting = 'waiting for the case' if self.identity is None else 'running'
        values = dict(v_squared=self._v_squared, answers=self._answers,
                      saturation_share=self._saturated / max(self._answers, 1))
        self._diagnostics.publish(messages.diagnostics(
            self.get_fully_qualified_name(), level, self._complaint or waiting, values,
            self.get_clock().now().to_msg()))

    def interrupt(self):
        """Say goodbye in the diagnostics."""
        self._complain('the controller was asked to stop')


def settings_of(node: Node) -> ControllerSettings:
    """Return the settings that the parameters of ``node`` describe, declared and changeable."""
    settings = parameters.load('controller', ControllerSettings, messages.take_overrides(node))
    messages.declare(node, settings, read_only=False)
    return settings


def main(args=None) -> int:
    """Run the controller until SIGINT or SIGTERM; return the exit status."""
    return harness.main(ControllerNode, args)

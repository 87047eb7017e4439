# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The controller node: answers every measurement with V^2 under the measurement's stamp."""

from collections.abc import Mapping
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool

from dewing_control.audience import Audience
from dewing_control.settings import ControllerSettings
from dewing_control.state_messages import StateTopic
from dewing_control.trial.closed_loop import controller, same_memory
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.identity import Identity
from dewing_sim.ros import codec, given_parameters, harness, messages, qos
from dewing_sim.ros.inbox import Inbox
from dewing_sim.ros.status import Status

RELEASED = 'released: another node has its turn'


class ControllerNode(Node):
    """A supervised controller driven by measurements alone; it never looks at a clock.

    A repeated stamp repeats the answer; an earlier one means that the simulator began anew, and
    so does the controller. Settings may change while it runs; the controller keeps what it
    remembers, or begins at the present V^2 where its memory has to be of another form. A change
    that the law cannot be designed with is refused, and the law before it goes on. Disabled, it
    answers zero.
    """

    def __init__(self, parameters: Mapping[str, Any] | None = None, **options):
        super().__init__('controller', namespace='dewing', **harness.overrides(parameters),
                         **options)
        self.settings = settings_of(self)
        self._declared = _names(self.settings)
        self.identity: Identity | None = None
        self._law, self._memory = None, None
        self._stamp, self._v_squared = -1, 0.0
        self._enabled, self._begun, self._answers, self._saturated = True, 0, 0, 0
        self.exit_status: int | None = None
        self.reason = ''
        self.status = Status(self, 'waiting for the case', self._values)
        self.add_on_set_parameters_callback(self._on_parameters)
        self.add_post_set_parameters_callback(self._declare_anew)
        self._command = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(String, 'case', self._on_case, qos.LATCHED)
        self._inbox = Inbox(self, self._ready, self._on_message)
        self._measurements = codec.Reader('position')
        self._layout = codec.layout(messages.COMMANDED, 'effort')
        self._state = StateTopic(self)
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(SetBool, '~/release', self._on_release)
        self._audience = Audience()
        self._heard = False                         # a measurement came in the last second
        self.create_timer(1.0, self._watch, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _on_case(self, message: String):
        try:
            identity = Identity.from_yaml(message.data)
            if identity != self.identity:
                self._law = controller(self.settings, identity)
                self.identity, self._stamp = identity, -1
                self._say_running()
                self._inbox.look()
        except BadInput as error:
            self.status.set(messages.WARN, str(error))

    def _on_message(self, data: bytes):
        try:
            self._on_measurement(self._measurements.read(data))
        except BadInput as error:
            self.status.set(messages.WARN, str(error))

    def _on_measurement(self, read: codec.Reading):
        """Answer."""
        self._heard = True
        self._state.begin()
        if read.stamp != self._stamp:
            try:
                self._decide(messages.measured(read), begin=read.stamp < self._stamp)
            except RunFailed as error:              # of a law from outside
                self.exit_status, self.reason = 1, str(error)
                self.status.set(messages.ERROR, self.reason)
                return
            self._stamp = read.stamp
            self._say_running()
        if not qos.publish(self._command, self._layout.encode(read.stamp, (self._v_squared,))):
            self.status.set(messages.WARN, 'a listener of command does not keep up')
        self._state.publish(read, self.settings.reference.output, self.identity, self._law,
                            self._memory, self._v_squared)

    def _ready(self) -> bool:
        """Return whether there is a law and everybody listens to its answers."""
        return (self._law is not None and self._command is not None and not self._absent()
                and self.exit_status is None)

    def _absent(self) -> int:
        """Return how many listeners of command are waited for, none once all have been there."""
        if self._command is None:
            return 0
        return self._audience.absent(self._command, self.settings.command.subscribers)

    def _watch(self):
        """Look for a measurement that nobody told of, and say what is waited for."""
        self._inbox.look()
        if self._law is not None and self._absent():
            self.status.set(messages.OK, f'waiting for {self._absent()} of '
                            f'{self.settings.command.subscribers} listeners of command')
        elif self._ready() and self.status.level == messages.OK and not self._heard:
            self.status.set(messages.OK, 'waiting for a measurement')
        self._heard = False
        self.status.report()

    def _decide(self, measurement, begin: bool):
        if begin or self._stamp < 0:
            self._begun += 1
            self._memory = self._law.start(measurement.v_squared)
        self._answers += 1
        if not self._enabled:
            self._v_squared = 0.0
            return
        self._memory, self._v_squared = self._law.step(self._memory, measurement)
        self._saturated += self._v_squared in (0.0, self._law.limit)

    def _on_parameters(self, given):
        settings, answer = messages.changed(self.settings, given)
        if settings == self.settings:
            return answer
        if self.identity is not None:
            try:
                self._law = controller(settings, self.identity)
            except BadInput as error:
                return SetParametersResult(successful=False, reason=str(error))
            if not same_memory(self.settings, settings):
                self._memory = self._law.start(self._v_squared)
        self.settings = settings
        return answer

    def _declare_anew(self, _given):
        """Declare the parameters of a law from outside that came, drop those of one that went."""
        names = _names(self.settings)
        gone, come, self._declared = self._declared - names, names - self._declared, names
        for name in gone:
            self.undeclare_parameter(name)
        if come:
            messages.declare(self, self.settings, read_only=False)

    def _on_enable(self, request, response):
        self._enabled = request.data
        self._memory, self._stamp = None, -1        # the next answer begins anew
        self._say_running()
        response.success, response.message = True, 'enabled' if request.data else 'disabled'
        return response

    def _on_release(self, request, response):
        """Leave the wing to another node, which is to command it in its turn, or take it again."""
        if request.data and self._command is not None:
            self.destroy_publisher(self._command)
            self._command = None
        elif not request.data and self._command is None:
            self._command = self.create_publisher(JointState, 'command', qos.LOOP)
            self._audience = Audience()
        self._memory, self._stamp = None, -1
        self._say_running()
        response.success, response.message = True, 'released' if request.data else 'taken again'
        return response

    def _say_running(self):
        if self._command is None:
            self.status.set(messages.OK, RELEASED)
        elif self._law is not None:
            self.status.set(messages.OK, 'running' if self._enabled else 'disabled: V^2 is zero')

    def _values(self) -> dict[str, Any]:
        return dict(kind=self.settings.kind, v_squared=self._v_squared, answers=self._answers,
                    begun=self._begun, saturation_share=self._saturated / max(self._answers, 1))

    def interrupt(self):
        """Say goodbye in the diagnostics."""
        if self.exit_status is None:
            self.status.set(messages.WARN, 'the controller was asked to stop')


def _names(settings: ControllerSettings) -> set[str]:
    return {name for name, _, _ in parameters.leaves(settings)}


def settings_of(node: Node) -> ControllerSettings:
    """Return the settings that the parameters of ``node`` describe, declared and changeable."""
    given = messages.take_overrides(node)
    kind = {name: given[name] for name in ('kind',) if name in given}   # it may bring sections
    schema = type(parameters.load('controller', ControllerSettings, kind))
    changes, = given_parameters.take(node, schema, given=given)
    settings = parameters.load('controller', ControllerSettings, changes)
    messages.declare(node, settings, read_only=False)
    return settings


def main(args=None) -> int:
    """Run the controller until a signal asks for the end; return the exit status."""
    return harness.main(ControllerNode, args,
                        lambda: [parameters.load('controller', ControllerSettings)])

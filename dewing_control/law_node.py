# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A controller of one's own as a node: a function of memory and measurement, and nothing else.

A measurement that has no answer yet is sent again, and after a reset time starts anew: a law that
acted on every message would act several times in a stall, and remember a flight that never was.
The node steps the law once for each stamp, repeats its answer to a repeated stamp, and starts it
anew when time goes back.
"""

from abc import ABC, ABCMeta, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from dewing_control.answers import Answers
from dewing_control.audience import Audience
from dewing_control.law.base import Command
from dewing_control.law.supervisor import Controller, Supervisor
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput, RunFailed
from dewing_sim.identity import Identity
from dewing_sim.plant import Measurement
from dewing_sim.ros import codec, harness, messages, qos
from dewing_sim.ros.inbox import Inbox
from dewing_sim.ros.status import Status

WATCH_PERIOD = 1.0          # s, wall


@dataclass(frozen=True)
class LawNodeSettings:
    """Parameters that every law has as a node; a node may declare others of its own."""

    command: Command


class LawNode(Node, ABC):
    """Answers every measurement by `step`, which a class derived from it gives, as may `start`.

    Before the first step `identity` tells time step, passive cambers and limits of the plant.
    What the law asks for is kept between zero and ``limit`` (V^2); the parameters ``command.*``
    are those of every controller. A law that fails ends the node with status 1 and one sentence.
    """

    def __init__(self, overrides: Mapping[str, Any] | None = None, *, name: str = 'controller',
                 **options):
        super().__init__(name, namespace='dewing', **harness.overrides(overrides), **options)
        self.settings = settings_of(self)
        self.identity: Identity | None = None
        self.limit = 0.0                            # V^2
        self.answers: Answers | None = None
        self.exit_status: int | None = None
        self.reason = ''
        self._audience = Audience()
        self.status = Status(self, 'waiting for the case', self._values)
        self._command = self.create_publisher(JointState, 'command', qos.LOOP)
        self.create_subscription(String, 'case', self._on_case, qos.LATCHED)
        self._measurements = codec.Reader('position')
        self._layout = codec.layout(messages.COMMANDED, 'effort')
        self._inbox = Inbox(self, self._ready, self._on_measurement)
        self.create_timer(WATCH_PERIOD, self._watch,
                          clock=Clock(clock_type=ClockType.STEADY_TIME))

    def start(self, v_squared: float = 0.0) -> Any:
        """Return the memory of a law that takes over at ``v_squared``; None by default."""
        return None

    @abstractmethod
    def step(self, memory: Any, measurement: Measurement) -> tuple[Any, float]:
        """Return the next memory and V^2."""

    def _on_case(self, message: String):
        try:
            identity = Identity.from_yaml(message.data)
        except BadInput as error:
            self.status.set(messages.WARN, str(error))
            return
        if identity != self.identity:
            command = self.settings.command
            self.identity = identity
            self.limit = min(command.voltage_limit**2, identity.v_squared_max)
            self.answers = Answers(Supervisor(self, command.period_steps, command.hold_steps,
                                              self.limit))
            self.status.set(messages.OK, 'running')
            self._inbox.look()

    def _ready(self) -> bool:
        """Return whether the plant is known and everybody listens to the answers."""
        return self.answers is not None and not self._absent() and self.exit_status is None

    def _on_measurement(self, data: bytes):
        """Answer."""
        try:
            read = self._measurements.read(data)
            v_squared = self.answers.to(read.stamp, messages.measured(read))
        except BadInput as error:
            self.status.set(messages.WARN, str(error))
            return
        except RunFailed as error:
            self.exit_status, self.reason = 1, str(error)
            self.status.set(messages.ERROR, self.reason)
            return
        self.status.set(messages.OK, 'running')
        if not qos.publish(self._command, self._layout.encode(read.stamp, (v_squared,))):
            self.status.set(messages.WARN, 'a listener of command does not keep up')

    def _absent(self) -> int:
        """Return how many listeners of command are waited for, none once all have been there."""
        return self._audience.absent(self._command, self.settings.command.subscribers)

    def _watch(self):
        """Look for a measurement that nobody told of, and say what is waited for."""
        self._inbox.look()
        if self.answers is not None and self._absent():
            self.status.set(messages.OK, f'waiting for {self._absent()} of '
                            f'{self.settings.command.subscribers} listeners of command')
        self.status.report()

    def _values(self) -> dict[str, Any]:
        found = self.answers
        return dict(kind=type(self).__name__) | (found.figures if found else {})

    def interrupt(self):
        """Say goodbye in the diagnostics."""
        if self.exit_status is None:
            self.status.set(messages.WARN, 'the controller was asked to stop')


def law_node(law: Controller | Callable[[Any, Measurement], tuple[Any, float]],
             ) -> type[LawNode]:
    """Return a class of nodes that fly ``law``; also a decorator.

    ``law`` is a function ``step(memory, measurement)`` that returns the next memory and V^2, and
    is given None as its first memory, or an object with such a ``step`` and with ``start``.
    """
    begin = getattr(law, 'start', lambda v_squared: None)
    step = getattr(law, 'step', law)
    name = getattr(law, '__name__', type(law).__name__)
    return ABCMeta(name, (LawNode,), {
        '__doc__': law.__doc__, '__module__': law.__module__,
        'start': lambda _self, v_squared=0.0: begin(v_squared),
        'step': lambda _self, memory, measurement: step(memory, measurement)})


def settings_of(node: Node) -> LawNodeSettings:
    """Return the settings that the parameters of ``node`` describe, declared.

    Others that were given wait until the node declares them.
    """
    given = messages.take_overrides(node)
    shipped = parameters.load('controller', ControllerSettings)
    own = {name: value for name, value in given.items() if name.startswith('command.')}
    settings = parameters.replace(LawNodeSettings(shipped.command), own)
    messages.declare(node, settings, read_only=True)
    return settings

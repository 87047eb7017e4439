# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator node: publishes measurement k and steps on the command with the same stamp.

What it is made of stands beside it: the `loop`, what it waits for (`watch`), what it says of
itself (`report`), its `services` and its `telemetry`.
"""

from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from dewing_sim.build import build
from dewing_sim.lockstep import LockStep
from dewing_sim.ros import harness, input_topics, messages, qos, report
from dewing_sim.ros.input_topics import InputTopics
from dewing_sim.ros.loop import Loop
from dewing_sim.ros.question import Question
from dewing_sim.ros.services import Services
from dewing_sim.ros.simulator_parameters import settings_of, shipped
from dewing_sim.ros.status import Status
from dewing_sim.ros.telemetry import Telemetry
from dewing_sim.ros.transforms import Transforms
from dewing_sim.ros.watch import Watch


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
            self.identity.v_squared_max, input_topics.outside(self))
        self.exit_status: int | None = None
        self.status = Status(self, 'waiting for a controller and listeners', self._values)
        self._connect()

    @property
    def reason(self) -> str:
        """The sentence of the diagnostics."""
        return self.status.sentence

    def _connect(self):
        self._identity = self.create_publisher(String, 'case', qos.LATCHED)
        self.telemetry = Telemetry(
            self, self.case, self.run, self.plant.dt, self.lockstep.outputs)
        self.inputs = InputTopics(self)
        self.transforms = Transforms(self)
        # The last publisher: who listens to it, and so is waited for, knows of all others.
        self.question = Question(self, self.run.resend_period)
        self.loop = Loop(self)
        self.command = self.create_subscription(
            JointState, 'command', self.loop.on_command, qos.LATEST, raw=True)
        self.served = Services(self)
        self.add_on_set_parameters_callback(self._on_parameters)
        self.watch = Watch(self)
        self._report = report.Report(self)
        self._identity.publish(String(data=self.identity.to_yaml()))

    def _log_trim(self, done: int, total: int):
        self.get_logger().info(f'trimming: step {done} of {total}', throttle_duration_sec=2.0)

    def _values(self) -> dict[str, Any]:
        return report.values(self)

    def _on_parameters(self, given):
        self.settings, answer = messages.changed(self.settings, given)
        self.run = self.settings.run
        return answer

    def finish(self, status: int, sentence: str):
        """End the run with an exit status: save the state if asked to, and say it to everybody."""
        if status or self.settings.save:
            sentence += '; ' + self.served.save()[1]
        self.loop.stop()
        self.status.set(messages.ERROR if status else messages.OK, sentence)
        self.status.deliver(self.publishers, self.run.delivery_timeout)
        self.exit_status = status

    def interrupt(self):
        """End the run as asked from outside, the state saved if a file is named for it."""
        if self.exit_status is None:
            self.finish(0, f'interrupted at {self.lockstep.time:.6f} s')


def main(args=None) -> int:
    """Run the simulator until its end or a signal that asks for it; return the exit status."""
    return harness.main(SimulatorNode, args, shipped)

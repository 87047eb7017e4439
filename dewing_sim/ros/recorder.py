# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The recorder node: every topic of its namespace, the clock and diagnostics into an MCAP bag.

It is for machines without ``ros2 bag record``, whose files it matches. Messages wait in the
queues of the middleware until a timer writes them, many at a time: woken for every message, the
recorder would take a good part of the processor time of the run it records.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile

from dewing_sim import parameters
from dewing_sim.parameters import text
from dewing_sim.records import bag
from dewing_sim.ros import given_parameters, harness, messages, qos
from dewing_sim.ros.transforms import TFMessage

DISCOVERY_PERIOD = 0.05     # s
WRITE_PERIOD = 0.02         # s
FLUSH_PERIOD = 0.5          # s
COMMON = ('/clock', '/diagnostics', *(('/tf', '/tf_static') if TFMessage else ()))
DEFAULTS = dict(output='dewing.mcap')


@dataclass(frozen=True)
class RecorderSettings:
    """Parameters of the recorder."""

    output: str = text('MCAP file to write; it must not exist')


class RecorderNode(Node):
    """Subscribes to topics as they appear and writes what they carry, unread, to the bag."""

    def __init__(self, overrides: Mapping[str, Any] | None = None, **options):
        super().__init__('recorder', namespace='dewing', **harness.overrides(overrides),
                         **options)
        given, = given_parameters.take(self, RecorderSettings)
        self.settings = parameters.from_mapping(RecorderSettings, DEFAULTS | given)
        messages.declare(self, self.settings, read_only=True)
        self.exit_status: int | None = None
        self.reason = ''
        self._listener = Node(      # in no executor
            'recorder_queues', namespace=self.get_namespace(), context=self.context,
            use_global_arguments=False, enable_rosout=False, start_parameter_services=False)
        self._topics: dict[str, Any] = {}
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(DISCOVERY_PERIOD, self._discover, clock=steady)
        self.create_timer(WRITE_PERIOD, self._write, clock=steady)
        self.create_timer(FLUSH_PERIOD, self._flush, clock=steady)
        # Last: from here on a signal finds a node that closes it.
        self.bag = bag.BagWriter(self.settings.output)

    def _discover(self):
        """Subscribe to what is new, to measurement last: the simulator waits for its listeners.

        When the run starts, it knows of every subscription made before that one.
        """
        own = self.get_namespace().rstrip('/') + '/'
        for topic, kinds in sorted(self.get_topic_names_and_types(),
                                   key=lambda item: item[0] == f'{own}measurement'):
            if topic in self._topics or not (topic.startswith(own) or topic in COMMON):
                continue
            publishers = self.get_publishers_info_by_topic(topic)
            if publishers and bag.is_known(kinds[0]):
                self._subscribe(topic, kinds[0], publishers[0].qos_profile)

    def _subscribe(self, topic: str, kind: str, offered: QoSProfile):
        package, _, name = kind.split('/')
        self.bag.add_topic(topic, kind, dict(
            reliability=offered.reliability.name.lower(),
            durability=offered.durability.name.lower()))
        self._topics[topic] = self._listener.create_subscription(
            getattr(import_module(f'{package}.msg'), name), topic, lambda message: None,
            qos.complete(offered), raw=True)

    def _write(self):
        self._guarded(self._write_waiting)

    def _write_waiting(self):
        """Write every message that has come in."""
        for topic, subscription in self._topics.items():
            queue = subscription.handle
            with queue:
                while taken := queue.take_message(subscription.msg_type, True):
                    data, times = taken
                    self.bag.write(topic, data, times['received_timestamp'],
                                   times['source_timestamp'])

    def _flush(self):
        self._guarded(self.bag.flush)

    def _guarded(self, act):
        """Run ``act``; a full disk ends the recording, not the run that is recorded."""
        if self.exit_status is None:
            try:
                act()
            except OSError as error:
                self.exit_status = 1
                self.reason = f'{self.settings.output}: recording stopped ({error.strerror})'

    def destroy_node(self):
        """Destroy the queues too."""
        self._listener.destroy_node()
        super().destroy_node()

    def interrupt(self):
        """Write what has come in and close the bag."""
        self._write()
        self._guarded(self.bag.close)


def main(args=None) -> int:
    """Record until a signal asks for the end; return the exit status."""
    return harness.main(RecorderNode, args, lambda: [RecorderSettings(**DEFAULTS)])

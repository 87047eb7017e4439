# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Experiments that are played from a bag instead of made: heard to the end, then identified."""

from collections.abc import Callable
from time import monotonic, monotonic_ns
from types import SimpleNamespace

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.records.mcap_file import Losses
from dewing_sim.records.runs import JOINTS, Splitter
from dewing_sim.ros import qos
from dewing_sysid import sources
from dewing_sysid.disturbed import Disturbances
from dewing_sysid.experiment import Record

QUIET = 8.0                 # s without a message: the end. What DDS lost comes within 3 s
PERIOD = 0.1                # s


class Replay:
    """Listens to all that a campaign consists of, and gives the records once it is over."""

    def __init__(self, node: Node, identity: Callable[[], Identity | None],
                 over: Callable[[dict[str, Record]], None], failed: Callable[[str], None]):
        """Listen from now on; ``over`` gets the records, ``failed`` what is wrong with them."""
        self._identity, self._over, self._failed = identity, over, failed
        self._heard: float | None = None
        self._begin()
        keepers = {topic: self._keeper(topic) for topic in (*self._splitters, 'inputs')}
        self._subscriptions = [
            (node.create_subscription(JointState, topic, keep, qos.LOOP), keep)
            for topic, keep in keepers.items()]
        node.create_timer(PERIOD, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _begin(self):
        losses, self._disturbances = Losses(), Disturbances()
        self._splitters = {topic: Splitter(topic, losses) for topic in ('measurement', 'command')}

    def _keeper(self, topic: str) -> Callable[[JointState], None]:
        def keep(message: JointState):
            self._heard = monotonic()
            if topic == 'inputs':
                self._disturbances.acted(monotonic_ns(), message)
                return
            if topic == 'measurement':
                self._disturbances.measured(monotonic_ns(), message)
            self._splitters[topic].add(SimpleNamespace(
                __msgtype__=JOINTS, header=message.header, name=message.name,
                position=message.position, effort=message.effort))
        return keep

    def _look(self):
        """Conclude when nothing has come for a while."""
        for subscription, keep in self._subscriptions:
            for message in qos.waiting(subscription):       # of which nobody told
                keep(message)
        if self._heard is None or monotonic() - self._heard < QUIET:
            return
        self._heard = None
        disturbances = self._disturbances
        measured, commanded = (splitter.runs for splitter in self._splitters.values())
        self._begin()
        try:
            if self._identity() is None or not measured:
                raise BadInput('neither case nor measurements were played')
            records, _ = sources.from_runs('what was played', self._identity(), measured,
                                           commanded, disturbances)
        except BadInput as error:
            self._failed(str(error))
        else:
            self._over(records)

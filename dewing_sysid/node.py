# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The identification node: drives the running simulator through every run of a plan."""

from collections.abc import Mapping
from time import monotonic
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String
from std_srvs.srv import Trigger

from dewing_sim.errors import BadInput, DewingError
from dewing_sim.files import check_free
from dewing_sim.identity import Identity
from dewing_sim.ros import codec, harness, qos
from dewing_sim.ros import messages as common
from dewing_sim.ros.awake import Awake
from dewing_sim.ros.rest import Rest
from dewing_sim.ros.status import Status
from dewing_sim.ros.turn import SOON, Turn
from dewing_sim.ros.watchdog import Watchdog
from dewing_sysid import messages, plan
from dewing_sysid.campaign import Campaign
from dewing_sysid.experiment import Record, save_records
from dewing_sysid.identify import Identification, concerns, identify
from dewing_sysid.parameters_node import settings_of
from dewing_sysid.replay_node import Replay
from dewing_sysid.settings import shipped

WATCH_PERIOD = 0.1          # s, wall
FAREWELL = 1.0              # s, longest wait for the last reset


class SysidNode(Node):
    """Resets the simulator before every run, answers its measurements, then publishes the model.

    ``exit_status`` is None while the node lives on, 0 or 1 with ``reason`` at its end.
    ``overrides`` maps dotted names to values, as on the command line; raises `BadInput`.
    """

    def __init__(self, overrides: Mapping[str, Any] | None = None, **options):
        super().__init__('sysid', namespace='dewing', **harness.overrides(overrides), **options)
        self.settings, self.node_settings = settings_of(self)
        for path in filter(None, (self.node_settings.output, self.node_settings.records)):
            check_free(path, way_out='name another file')
        self.exit_status: int | None = None
        self.found: Identification | None = None
        self._identity, self._campaign = None, None
        self._latest, self._heard, self._shown = None, 0.0, -1.0
        self._wanted = self.node_settings.begin == 'at_start'
        self.get_logger().info(f'begin: {self.node_settings.begin}')
        self._awake = Awake()
        self.status = Status(self, 'idle', self._values)
        self._watchdog = Watchdog(lambda sentence: self.status.set(common.WARN, sentence))
        self._connect()
        if self.node_settings.begin == 'on_replay':
            self._replay = Replay(self, lambda: self._identity, self._end,
                                  lambda sentence: self._finish(1, sentence))
            return
        self._measurement = self.create_subscription(
            JointState, 'measurement', self._on_measurement, qos.LATEST, raw=True)

    reason = property(lambda self: self.status.sentence, doc='The sentence of the diagnostics.')

    def _connect(self):
        self._turn = Turn(self, self._wanted)
        self._progress = self.create_publisher(Float64, '~/progress', qos.EVENTS)
        self._announcement = messages.Announcement(self)
        self._rest = Rest(self, self._on_rest)
        self.create_subscription(String, 'case', self._on_case, qos.LATCHED)
        self._measurements = codec.Reader('position')
        self._layout = codec.layout(common.COMMANDED, 'effort')
        self.create_service(Trigger, '~/start', self._on_start)
        self.create_service(Trigger, '~/stop', self._on_stop)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WATCH_PERIOD, self._watch, clock=steady)
        self.create_timer(1.0, self.status.report, clock=steady)

    def _on_case(self, message: String):
        try:
            self._identity = Identity.from_yaml(message.data)
        except BadInput as error:
            self._finish(1, str(error))

    def _watch(self):
        """Begin when asked and everybody is there; give up when the simulator falls silent."""
        if self._campaign is None and self._wanted:
            obstacle = self._obstacle()
            if obstacle:
                self.status.set(common.OK, f'waiting: {obstacle}')
            else:
                self._begin()
        elif self._campaign:
            for data in qos.waiting(self._measurement):     # of which nobody told
                self._on_measurement(data)
            self._insist()

    def _insist(self):
        """Say that a run makes no progress, ask for its reset again, and in the end give up."""
        campaign, patience = self._campaign, self.node_settings.patience
        if campaign is None:
            return
        if self._awake() - self._heard > patience:
            self._finish(1, f'run {campaign.run!r}: nothing heard from the simulator for '
                            f'{patience:g} s')
            return
        awaited = 'the simulator to be reset' if self._rest.awaited else 'the next measurement'
        stalled = self._watchdog.look((campaign.run, campaign.progress), (
            f'run {campaign.run!r} at {campaign.progress:.0%}, waiting for {awaited}'))
        if not stalled:
            self.status.set(common.OK, f'run {campaign.run!r}')
        elif self._rest.awaited:
            self._watchdog.rest()
            self._rest.ask()

    def _obstacle(self) -> str | None:
        if self._campaign:
            return 'experiments are already under way'
        if self.node_settings.begin == 'on_replay':
            return 'experiments are played, not made'
        if self._identity is None or not self._rest.there:
            return 'the simulator is not there'
        return self._turn.obstacle

    def _begin(self):
        self._wanted = False
        try:
            self._campaign = Campaign(plan.make(self.settings, self._identity))
        except BadInput as error:
            self._finish(1, str(error))
            return
        self._begin_run()

    def _begin_run(self):
        """Ask for the rest state; measurements count from the moment it is granted."""
        self.status.set(common.OK, f'run {self._campaign.run!r}')
        self._heard, self._latest = self._awake(), None
        self._rest.ask()

    def _on_rest(self):
        if self._campaign and self._latest is not None:
            self._answer(self._latest)

    def _on_measurement(self, data: bytes):
        self._heard = self._awake()
        if self._rest.awaited:
            self._latest = data
        elif self._campaign:
            self._answer(data)

    def _answer(self, data: bytes):
        campaign = self._campaign
        try:
            stamp, names, values = self._measurements.read(data)
            v_squared = campaign.answer(stamp, dict(zip(names, values)))
        except BadInput as error:
            self._finish(1, f'unusable measurement: {error}')
            return
        self._show_progress()
        if campaign.run_complete:
            self._next_run()
        elif v_squared is not None:
            self._turn.publish(self._layout.encode(stamp, (v_squared,)))

    def _show_progress(self):
        share = self._campaign.progress
        if share - self._shown >= 0.01 or share == 1.0:
            self._shown = share
            self._progress.publish(Float64(data=share))

    def _next_run(self):
        campaign = self._campaign
        campaign.proceed()
        if campaign.run:
            self._begin_run()
            return
        self._restore()
        self.status.set(common.OK, 'realising the model')
        self._end(campaign.plan.records(campaign.outputs))

    def _end(self, records: dict[str, Record]):
        try:
            self._conclude(records)
        except (DewingError, OSError) as error:
            self._finish(1, str(error))

    def _conclude(self, records: dict[str, Record]):
        """Identify, publish and save; what this node has saved before is written over."""
        again = self.found is not None
        if self.node_settings.records:
            save_records(self.node_settings.records, records, self._identity, again)
        self.found = identify(records, self.settings, self._identity)
        self._announcement.publish(self.found)
        model = self.found.model
        if self.node_settings.output:
            model.save(self.node_settings.output, again)
        fits = ', '.join(f'{name} {fit:.1f} %' for name, fit in model.fit['window'].items())
        doubts = concerns(self.found, self.settings)
        sentence = '; '.join([f'order {model.order} model: fit of {fits}', *doubts])
        self.status.set(common.WARN if doubts else common.OK, sentence)
        if self.node_settings.afterwards == 'exit':
            self._finish(0, sentence)

    def _restore(self):
        self._campaign, self._shown = None, -1.0
        self._turn.leave()
        return self._rest.leave()

    def _on_start(self, _request, response):
        obstacle = self._obstacle()
        self._wanted = obstacle in SOON
        response.success, response.message = self._wanted or not obstacle, obstacle or 'started'
        if not obstacle:
            self._begin()
        return response

    def _on_stop(self, _request, response):
        response.success, response.message = bool(self._campaign), 'no experiment is under way'
        if response.success:
            response.message = f'run {self._campaign.run!r} stopped, the simulator is reset'
            self._restore()
            self.status.set(common.WARN, response.message)
        return response

    def _finish(self, status: int, sentence: str):
        if self._campaign:
            self._restore()
        self.status.set(common.ERROR if status else common.OK, sentence)
        qos.deliver(self.publishers)
        self.exit_status = status

    def interrupt(self):
        """Restore the operating point if an experiment is under way."""
        if self._campaign:
            self.status.set(common.WARN, f'interrupted in run {self._campaign.run!r}')
            granted, deadline = self._restore(), monotonic() + FAREWELL
            while not granted.done() and monotonic() < deadline:
                self.executor.spin_once(timeout_sec=0.1)

    def _values(self) -> dict[str, float]:
        progress = self._campaign.progress if self._campaign else float(self.found is not None)
        return dict(progress=progress)


def main(args=None) -> int:
    """Run the identification until its end or a signal that asks for it; return the status."""
    return harness.main(SysidNode, args, shipped)

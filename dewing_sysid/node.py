# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The identification node: drives the running simulator through every run of a plan."""

from collections.abc import Mapping
from time import monotonic
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray, String
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory

from dewing_sim import parameters
from dewing_sim.errors import BadInput, DewingError
from dewing_sim.files import check_free
from dewing_sim.identity import Identity
from dewing_sim.ros import given_parameters, harness, qos
from dewing_sim.ros import messages as common
from dewing_sysid import messages, plan
from dewing_sysid.campaign import Campaign
from dewing_sysid.experiment import save_records
from dewing_sysid.identify import Identification, concerns, identify
from dewing_sysid.settings import NODE_DEFAULTS, NodeSettings, Settings

WATCH_PERIOD = 0.1          # s, wall
FAREWELL = 1.0              # s, longest wait for the last reset
MATRICES = {'a': ('state', 'state'), 'b': ('state', 'input'), 'c': ('output', 'state')}


def settings_of(node: Node) -> tuple[Settings, NodeSettings]:
    """Return the settings that the parameters of ``node`` describe, declared."""
    own, changes = given_parameters.take(node, NodeSettings, Settings)
    node_settings = parameters.from_mapping(NodeSettings, NODE_DEFAULTS | own)
    settings = parameters.load('sysid', Settings, changes)
    common.declare(node, settings, read_only=True)
    common.declare(node, node_settings, read_only=True)
    return settings, node_settings


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
        self.reason = 'idle'
        self.found: Identification | None = None
        self._level, self._identity, self._campaign = common.OK, None, None
        self._resetting, self._latest, self._heard, self._shown = None, None, 0.0, -1.0
        self._wanted = self.node_settings.begin == 'at_start'
        self._connect()

    def _connect(self):
        self._command = self.create_publisher(JointState, 'command', qos.LOOP)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', qos.EVENTS)
        self._progress = self.create_publisher(Float64, '~/progress', qos.EVENTS)
        self._model = {name: self.create_publisher(Float64MultiArray, f'model/{name}',
                                                   qos.LATCHED) for name in MATRICES}
        self._pulse = self.create_publisher(JointTrajectory, 'pulse', qos.LATCHED)
        self._reset = self.create_client(Trigger, 'simulator/reset')
        self.create_subscription(String, 'case', self._on_case, qos.LATCHED)
        self.create_subscription(JointState, 'measurement', self._on_measurement, qos.LATEST)
        self.create_service(Trigger, '~/start', self._on_start)
        self.create_service(Trigger, '~/stop', self._on_stop)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WATCH_PERIOD, self._watch, clock=steady)
        self.create_timer(1.0, self._report, clock=steady)

    # --- begin and end of the runs -------------------------------------------------------------

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
                self._set_status(common.OK, f'waiting: {obstacle}')
            else:
                self._begin()
        elif self._campaign and monotonic() - self._heard > self.node_settings.patience:
            self._finish(1, f'run {self._campaign.run!r}: nothing heard from the simulator for '
                            f'{self.node_settings.patience:g} s')

    def _obstacle(self) -> str | None:
        if self._campaign:
            return 'experiments are already under way'
        if self._identity is None or not self._reset.service_is_ready():
            return 'the simulator is not there'
        if self.count_publishers('command') > 1:
            return 'another controller publishes commands: stop it first'
        return None

    def _begin(self):
        self._wanted = False
        try:
            planned = plan.make(self.settings, self._identity)
        except BadInput as error:
            self._finish(1, str(error))
            return
        self._campaign = Campaign(planned)
        self._begin_run()

    def _begin_run(self):
        """Ask for the rest state; measurements count from the moment it is granted."""
        self._set_status(common.OK, f'run {self._campaign.run!r}')
        self._heard, self._latest = monotonic(), None
        self._resetting = self._reset.call_async(Trigger.Request())
        self._resetting.add_done_callback(self._on_rest)

    def _on_rest(self, _future):
        self._resetting, latest = None, self._latest
        if self._campaign and latest is not None:
            self._answer(latest)

    # --- the loop ------------------------------------------------------------------------------

    def _on_measurement(self, message: JointState):
        self._heard = monotonic()
        if self._resetting is not None:
            self._latest = message
        elif self._campaign:
            self._answer(message)

    def _answer(self, message: JointState):
        campaign = self._campaign
        try:
            v_squared = campaign.answer(common.from_stamp(message.header.stamp),
                                        dict(zip(message.name, message.position)))
        except BadInput as error:
            self._finish(1, f'unusable measurement: {error}')
            return
        self._show_progress()
        if campaign.run_complete:
            self._next_run()
        elif v_squared is not None:
            qos.publish(self._command, common.command(v_squared, message.header.stamp))

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
        self._set_status(common.OK, 'realising the model')
        try:
            self._conclude(campaign)
        except (DewingError, OSError) as error:
            self._finish(1, str(error))

    def _conclude(self, campaign: Campaign):
        """Identify, publish and save."""
        records = campaign.plan.records(campaign.outputs)
        if self.node_settings.records:
            save_records(self.node_settings.records, records, self._identity)
        self.found = identify(records, self.settings, self._identity)
        model = self.found.model
        for name, labels in MATRICES.items():
            self._model[name].publish(messages.matrix(getattr(model, name), *labels))
        self._pulse.publish(messages.response(records[plan.EXPERIMENT]))
        if self.node_settings.output:
            model.save(self.node_settings.output)
        fits = ', '.join(f'{name} {fit:.1f} %' for name, fit in model.fit['window'].items())
        doubts = concerns(self.found, self.settings)
        sentence = '; '.join([f'order {model.order} model: fit of {fits}', *doubts])
        self._set_status(common.WARN if doubts else common.OK, sentence)
        if self.node_settings.afterwards == 'exit':
            self._finish(0, sentence)

    def _restore(self):
        """Bring the simulator back to its operating point."""
        self._campaign, self._resetting, self._shown = None, None, -1.0
        return self._reset.call_async(Trigger.Request())

    # --- services, status, the end -------------------------------------------------------------

    def _on_start(self, _request, response):
        obstacle = self._obstacle()
        response.success, response.message = obstacle is None, obstacle or 'started'
        if response.success:
            self._begin()
        return response

    def _on_stop(self, _request, response):
        response.success = self._campaign is not None
        response.message = 'no experiment is under way'
        if response.success:
            response.message = f'run {self._campaign.run!r} stopped, the simulator is reset'
            self._restore()
            self._set_status(common.WARN, response.message)
        return response

    def _finish(self, status: int, sentence: str):
        if self._campaign:
            self._restore()
        self._set_status(common.ERROR if status else common.OK, sentence)
        qos.deliver([self._diagnostics, *self._model.values(), self._pulse])
        self.exit_status = status

    def interrupt(self):
        """Restore the operating point if an experiment is under way."""
        if self._campaign:
            self._set_status(common.WARN, f'interrupted in run {self._campaign.run!r}')
            granted, deadline = self._restore(), monotonic() + FAREWELL
            while not granted.done() and monotonic() < deadline:
                self.executor.spin_once(timeout_sec=0.1)

    def _set_status(self, level: bytes, sentence: str):
        changed = (level, sentence) != (self._level, self.reason)
        self._level, self.reason = level, sentence
        if changed:
            self._report()
            if level != common.OK:
                self.get_logger().warning(sentence)

    def _report(self):
        progress = self._campaign.progress if self._campaign else float(self.found is not None)
        self._diagnostics.publish(common.diagnostics(
            self.get_fully_qualified_name(), self._level, self.reason, dict(progress=progress),
            self.get_clock().now().to_msg()))


def main(args=None) -> int:
    """Run the identification until its end or a signal that asks for it; return the status."""
    return harness.main(SysidNode, args)

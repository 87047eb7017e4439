# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator says of its run: numbers, and what to beware of."""

from time import monotonic
from typing import Any

from rclpy.clock import Clock, ClockType

from dewing_sim.ros import messages
from dewing_sim.tempo import Tempo

PERIOD = 1.0                # s, wall


class Report:
    """Publishes the status of a `SimulatorNode` every `PERIOD`, with a caution if there is one."""

    def __init__(self, node):
        """Report from now on."""
        self._node, self._speed_told = node, False
        node.create_timer(PERIOD, self.publish, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def publish(self):
        """Publish level, sentence and numbers."""
        status, started = self._node.status, self._node.loop.started
        tempo = self._node.loop.tempo
        tempo.close(monotonic())
        if not self._speed_told and (
                tempo.found.rtf_now if tempo.rate else self._node.lockstep.steps):
            self._tell_speed(tempo)
        if not started:
            absent = self._node.watch.absent
            if absent:
                status.set(messages.OK, f'waiting for {absent}')
        caution = self._caution(started)
        if status.level == messages.OK and caution:
            status.set(messages.WARN, caution)
        else:
            status.report()

    def _tell_speed(self, tempo: Tempo):
        """Log the speed of the first second or so, and in real time what the machine holds."""
        self._speed_told, figures = True, values(self._node)
        self._node.get_logger().info(
            'simulated over wall time: {rtf:.3g}, {ms_per_step:.3g} ms a step and '
            '{overhead_ms_per_step:.3g} ms beside it'.format(**figures)
            + (f'; up to run.rate = {tempo.found.largest_rate:.2g} would hold' if tempo.rate
               else ''))

    def _caution(self, started: bool) -> str:
        node = self._node
        controllers = node.watch.controllers
        if controllers > 1:
            return f'{controllers} controllers: the first answer to a measurement counts'
        return (node.telemetry.clock.caution
                or node.question.gone(node.run.subscribers * started)
                or node.built.caution(node.lockstep.state)
                or node.loop.tempo.caution)


def values(node) -> dict[str, Any]:
    """Return the numbers in the diagnostics of a `SimulatorNode`."""
    loop, question = node.loop, node.question
    wall = question.asked - loop.began if loop.started else 0.0
    return dict(mode=node.run.mode, **node.lockstep.figures(wall), resent=question.resent,
                missed_deadlines=loop.deadlines.missed, **loop.tempo.found._asdict(),
                **node.inputs.figures, **vars(node.built.monitor(node.lockstep.state)))

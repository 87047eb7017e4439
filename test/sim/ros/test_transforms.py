# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Where the frames are: the axes that docs/ros.md states, and over DDS where there is tf2_msgs."""

import math

import numpy as np
import pytest
from rclpy.node import Node
from reduced_wing import first_mode
from ros_processes import PATIENCE, graph

from dewing_sim import parameters
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.ros import harness, qos, transforms
from dewing_sim.ros.node import SimulatorNode
from dewing_sim.wing import Wing


def turned(transform, vector):
    """Return a vector of the child frame in the axes of the parent."""
    q = transform.transform.rotation
    axis, w = np.array([q.x, q.y, q.z]), q.w
    return vector + 2.0 * np.cross(axis, np.cross(axis, vector) + w * np.array(vector))


def test_the_upper_side_is_up_in_the_world_and_the_left_tip_to_the_left_of_who_flies():
    still = transforms.about_x('map', 'wing', 0.5 * math.pi)
    aft, up, left = np.eye(3)                       # x, y and z of the wing
    assert turned(still, aft) == pytest.approx([1.0, 0.0, 0.0])
    assert turned(still, up) == pytest.approx([0.0, 0.0, 1.0])
    forward = -turned(still, aft)
    assert turned(still, left) == pytest.approx(np.cross([0.0, 0.0, 1.0], forward))
    assert (still.header.frame_id, still.child_frame_id) == ('map', 'wing')


def test_the_stream_comes_from_below_at_an_angle_of_attack():
    alpha = math.radians(4.0)
    wind = transforms.about_z('wing', 'wind', alpha)
    assert turned(wind, np.array([1.0, 0.0, 0.0])) == pytest.approx(
        [math.cos(alpha), math.sin(alpha), 0.0])


def test_the_incidence_of_a_wing_is_that_of_its_state():
    case = parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime', 'numerics.trim_time': 0.1,
        'numerics.time_step': 5.0e-4, 'membrane.elements': 16})
    wing = Wing(case, motion=lambda time: (0.0, 0.02 * math.sin(40.0 * max(time, 0.0))**3))
    state = wing.rest()
    assert wing.incidence(state) == pytest.approx(case.flow.angle_of_attack)
    for _ in range(8):
        state = wing.step(state, Inputs(0.0))
    pitch = 0.02 * math.sin(40.0 * 8 * wing.dt)**3
    assert wing.incidence(state) == pytest.approx(case.flow.angle_of_attack + pitch)


class Viewer(Node):
    """Keeps the transforms, as RViz does."""

    def __init__(self, _parameters=None, **options):
        super().__init__('viewer', namespace='elsewhere', **options)
        self.still, self.moving = {}, []
        for topic, take, quality in (('/tf_static', self.keep, qos.LATCHED),
                                     ('/tf', self.add, qos.EVENTS)):
            self.create_subscription(transforms.TFMessage, topic, take, quality)

    def keep(self, message):
        self.still |= {each.child_frame_id: each for each in message.transforms}

    def add(self, message):
        self.moving += message.transforms


@pytest.mark.skipif(transforms.TFMessage is None, reason='this ROS has no tf2_msgs')
@pytest.mark.parametrize('engine, namespace', [('finite_volume', ''), ('conformal', 'left')])
def test_a_viewer_finds_every_frame(tmp_path, engine, namespace):
    with graph(tmp_path) as processes, harness.Session(processes.domain) as session:
        prefix = f'{namespace}/' if namespace else ''
        renamed = ('-r', f'__ns:=/{namespace}') if namespace else ()
        settings = {'run.mode': 'free', 'run.subscribers': 0, 'run.duration': 0.02,
                    'numerics.engine': engine, 'numerics.trim_time': 0.1,
                    'numerics.grid': 'fast' if engine == 'finite_volume' else 'realtime',
                    'numerics.time_step': 5.0e-4}
        viewer = session.add(Viewer)
        processes.start('simulator', settings, arguments=renamed)
        session.spin_until(lambda: f'{prefix}wing' in viewer.still and (
            viewer.moving or 'wind' in viewer.still), PATIENCE)
    assert viewer.still[f'{prefix}wing'].header.frame_id == 'map'
    wind = viewer.moving[0] if viewer.moving else viewer.still['wind']
    assert bool(viewer.moving) == (engine == 'conformal')
    assert (wind.header.frame_id, wind.child_frame_id) == (f'{prefix}wing', f'{prefix}wind')
    assert 2.0 * math.asin(wind.transform.rotation.z) == pytest.approx(math.radians(4.0))


def test_without_tf2_msgs_nothing_else_is_missing(monkeypatch, tmp_path):
    monkeypatch.setattr(transforms, 'TFMessage', None)
    reduced.save(tmp_path / 'model.npz', first_mode())
    with harness.reserved_domain() as domain, harness.Session(domain) as session:
        node = session.add(SimulatorNode, {
            'run.plant': 'reduced', 'model': str(tmp_path / 'model.npz'), 'run.mode': 'free',
            'run.subscribers': 0, 'run.duration': 0.01})
        session.spin_until(lambda: node.exit_status is not None, PATIENCE)
        topics = [topic for topic, _ in node.get_topic_names_and_types()]
    assert node.exit_status == 0 and '/tf_static' not in topics

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Matrices and records to ROS messages, and the topics that carry what was found."""

from array import array

import numpy as np
from builtin_interfaces.msg import Duration
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from dewing_sim.lockstep import nanoseconds
from dewing_sim.ros import qos
from dewing_sysid.experiment import Record
from dewing_sysid.identify import Identification
from dewing_sysid.plan import EXPERIMENT

MATRICES = {'a': ('state', 'state'), 'b': ('state', 'input'), 'c': ('output', 'state')}


def matrix(values: np.ndarray, rows: str, columns: str) -> Float64MultiArray:
    """Return a matrix by rows, its dimensions labelled; ``dim[0].stride`` is the total size."""
    height, width = values.shape
    layout = MultiArrayLayout(dim=[
        MultiArrayDimension(label=rows, size=height, stride=height * width),
        MultiArrayDimension(label=columns, size=width, stride=width)])
    return Float64MultiArray(layout=layout, data=array('d', values.ravel().tolist()))


def to_matrix(message: Float64MultiArray) -> np.ndarray:
    """Return the matrix of a message made by `matrix`."""
    return np.array(message.data).reshape([dimension.size for dimension in message.layout.dim])


def response(record: Record) -> JointTrajectory:
    """Return V^2 - V0^2 and the outputs minus their baseline, in SI units, point by point."""
    message = JointTrajectory(joint_names=['v_squared', *record.names])
    for k, row in enumerate(np.vstack([record.u, record.y]).T.tolist()):
        seconds, rest = divmod(nanoseconds(k * record.dt), 1_000_000_000)
        message.points.append(JointTrajectoryPoint(
            positions=array('d', row), time_from_start=Duration(sec=seconds, nanosec=rest)))
    return message


class Announcement:
    """Publishes ``model/a``, ``model/b``, ``model/c`` and ``pulse``, for late listeners too."""

    def __init__(self, node: Node):
        """Advertise the topics on ``node``."""
        self._matrices = {name: node.create_publisher(Float64MultiArray, f'model/{name}',
                                                      qos.LATCHED) for name in MATRICES}
        self._pulse = node.create_publisher(JointTrajectory, 'pulse', qos.LATCHED)
        self.publishers = [*self._matrices.values(), self._pulse]

    def publish(self, found: Identification) -> None:
        """Publish model and record."""
        for name, labels in MATRICES.items():
            self._matrices[name].publish(matrix(getattr(found.model, name), *labels))
        self._pulse.publish(response(found.records[EXPERIMENT]))

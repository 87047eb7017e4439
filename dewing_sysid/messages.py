# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Matrices and records to ROS messages: pure functions."""

from array import array

import numpy as np
from builtin_interfaces.msg import Duration
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from dewing_sim.lockstep import nanoseconds
from dewing_sysid.experiment import Record


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

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bags written message by message, with rosbags's serialisation."""

import numpy as np

from dewing_sim.records import bag
from dewing_sim.records.bag import _types

JOINTS, TEXT = 'sensor_msgs/msg/JointState', 'std_msgs/msg/String'


def text(said):
    """Return a serialised String."""
    return bytes(_types().serialize_cdr(_types().types[TEXT](said), TEXT))


def joints(stamp, names, position=(), effort=()):
    """Return a serialised JointState; ``stamp`` is in ns."""
    types = _types().types
    header, time = types['std_msgs/msg/Header'], types['builtin_interfaces/msg/Time']
    message = types[JOINTS](header(time(*divmod(stamp, 1_000_000_000)), ''), list(names),
                            np.array(position, float), np.empty(0), np.array(effort, float))
    return bytes(_types().serialize_cdr(message, JOINTS))


def write(path, *messages):
    """Write (topic, type, bytes) into a new bag, 1 ms of arrival apart; return its path."""
    writer = bag.BagWriter(path)
    for number, (topic, kind, data) in enumerate(messages):
        if topic not in writer._channels:
            writer.add_topic(topic, kind)
        writer.write(topic, data, 1_000_000 * number, 1_000_000 * number)
    writer.close()
    return path


def measured(stamp, camber, v_squared):
    """Return a measurement for `write`."""
    return '/dewing/measurement', JOINTS, joints(
        stamp, ['camber_mean', 'v_squared'], [camber, v_squared])

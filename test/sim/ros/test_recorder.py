# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bags: complete, self-describing, readable by others, and after a kill."""

import random
import time

import numpy as np
import pytest
from ros_processes import PATIENCE, graph, simulated_time

from dewing_sim.errors import BadInput
from dewing_sim.machine.signals import kill
from dewing_sim.records import bag

KIND = 'sensor_msgs/msg/JointState'


def write_bag(path, stamps, close=True):
    """Write commands of 10 V^2 a step, serialised by rosbags, and return the writer."""
    types = bag._types()
    header, time = types.types['std_msgs/msg/Header'], types.types['builtin_interfaces/msg/Time']
    writer = bag.BagWriter(path)
    writer.add_topic('/dewing/command', KIND)
    for stamp in stamps:
        message = types.types[KIND](
            header(time(0, stamp), ''), ['v_squared'], np.empty(0), np.empty(0),
            np.array([10.0 * stamp]))
        writer.write('/dewing/command', types.serialize_cdr(message, KIND), stamp, stamp)
    if close:
        writer.close()
    return writer


def test_series_come_back_as_written_and_repeats_count_once(tmp_path):
    write_bag(tmp_path / 'a.mcap', [1, 2, 2, 3])
    series = bag.series(tmp_path / 'a.mcap', '/dewing/command')
    np.testing.assert_array_equal(series['time'], np.array([1, 2, 3]) * 1.0e-9)
    np.testing.assert_array_equal(series['v_squared'], [10.0, 20.0, 30.0])


def test_an_unclosed_bag_is_read_up_to_its_last_flush(tmp_path):
    writer = write_bag(tmp_path / 'a.mcap', range(1, 101), close=False)
    writer.flush()
    assert len(bag.series(tmp_path / 'a.mcap', '/dewing/command')['time']) == 100


def test_a_bag_cut_anywhere_is_read_up_to_the_cut(tmp_path):
    write_bag(tmp_path / 'a.mcap', range(1, 2001))
    whole = (tmp_path / 'a.mcap').read_bytes()
    counts = []
    for cut in np.linspace(0, len(whole), 200, dtype=int):
        (tmp_path / 'cut.mcap').write_bytes(whole[:cut])
        counts.append(sum(1 for _ in bag.read(tmp_path / 'cut.mcap')))
    assert counts == sorted(counts) and counts[0] == 0 and counts[-1] == 2000
    assert 0 < counts[100] < 2000


def test_what_is_no_bag_is_refused(tmp_path):
    (tmp_path / 'text.mcap').write_text('this is not a bag at all')
    with pytest.raises(BadInput, match='not an MCAP file'):
        bag.series(tmp_path / 'text.mcap', '/dewing/command')
    with pytest.raises(BadInput, match='No such file'):
        bag.series(tmp_path / 'absent.mcap', '/dewing/command')
    write_bag(tmp_path / 'a.mcap', [1])
    with pytest.raises(BadInput, match='no messages on /dewing/other'):
        bag.series(tmp_path / 'a.mcap', '/dewing/other')
    with pytest.raises(BadInput, match='exists'):
        bag.BagWriter(tmp_path / 'a.mcap')


def test_a_bag_has_the_layout_of_rosbag2(tmp_path):
    from mcap.reader import make_reader
    write_bag(tmp_path / 'a.mcap', [1, 2])
    with open(tmp_path / 'a.mcap', 'rb') as file:
        reader = make_reader(file)
        assert reader.get_header().profile == 'ros2'
        summary = reader.get_summary()
    channel, = summary.channels.values()
    schema, = summary.schemas.values()
    assert (channel.topic, channel.message_encoding) == ('/dewing/command', 'cdr')
    assert (schema.name, schema.encoding) == (KIND, 'ros2msg')
    assert b'MSG: std_msgs/Header' in schema.data
    assert channel.metadata['topic_type_hash'].startswith('RIHS01_')
    assert summary.statistics.message_count == 2


def test_rosbags_reads_a_recorded_run(tmp_path):
    from pathlib import Path

    from rosbags.highlevel import AnyReader
    with graph(tmp_path) as ros:
        path = ros.recorder()
        assert ros.simulator(duration=0.02, subscribers=1, mode='free').wait(PATIENCE) == 0
    with AnyReader([Path(path)]) as reader:
        counts = {item.topic: item.msgcount for item in reader.connections}
        connection, = (c for c in reader.connections if c.topic == '/dewing/case')
        (_, _, raw), = reader.messages(connections=[connection])
        assert 'plant: reduced' in reader.deserialize(raw, connection.msgtype).data
    assert counts['/dewing/measurement'] == 201
    assert {'/clock', '/diagnostics', '/dewing/cl', '/dewing/camber', '/dewing/v_squared'
            } <= counts.keys()


def test_a_killed_recorder_leaves_a_readable_bag(tmp_path):
    with graph(tmp_path) as ros:
        path = ros.recorder()
        ros.simulator(subscribers=2, delivery_timeout=0.1)
        ros.controller()
        ros.wait_until(lambda: simulated_time(path) > 0.05)
        time.sleep(random.Random(14).uniform(0.0, 0.5))
        kill(ros.processes[0])
    assert np.all(np.diff(bag.series(path, '/dewing/measurement')['time']) < 1.5e-4)
    assert simulated_time(path) > 0.05


def test_hashes_and_qos_are_those_of_the_publishers(tmp_path):
    from mcap.reader import make_reader
    from sensor_msgs.msg import JointState

    from dewing_sim.ros import harness
    with graph(tmp_path) as ros, harness.Session(ros.domain) as session:
        path = ros.recorder()
        ros.simulator(duration=0.01, subscribers=2, mode='free')
        node = session.watch_clock()
        node.create_subscription(JointState, 'measurement', lambda message: None, 10)
        known = {}

        def seen():
            for topic in ('/dewing/measurement', '/dewing/case'):
                for info in node.get_publishers_info_by_topic(topic):
                    known[topic] = info
            return len(known) == 2

        session.spin_until(ros.alive(seen), PATIENCE)
        assert ros.processes[1].wait(PATIENCE) == 0
    with open(path, 'rb') as file:
        channels = {c.topic: c for c in make_reader(file).get_summary().channels.values()}
    for topic, info in known.items():
        assert channels[topic].metadata['topic_type_hash'] == str(info.topic_type_hash)
    assert 'durability: transient_local' in channels['/dewing/case'].metadata[
        'offered_qos_profiles']

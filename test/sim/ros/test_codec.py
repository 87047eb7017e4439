# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The codec of the loop says what ROS's own serialiser says, of every JointState there is."""

import struct
from array import array

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState

from dewing_sim.errors import BadInput
from dewing_sim.ros import codec, messages

NAMES = ('camber_mean', 'camber_max', 'cl', 'cd', 'v_squared')
COMMAND = codec.layout(messages.COMMANDED, 'effort')

doubles = st.floats(width=64)       # NaN, infinities, subnormal numbers and -0 among them
stamps = st.integers(-2**31, 2**31 - 1).flatmap(
    lambda second: st.integers(0, 999_999_999).map(lambda rest: second * 10**9 + rest))
words = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=12)
names = st.lists(words, min_size=1, max_size=6).map(tuple)
arrays = st.sampled_from(('position', 'effort'))


def bits(values):
    """Return numbers so that NaN equals NaN and -0 differs from 0."""
    return struct.pack(f'<{len(values)}d', *values)


def assert_same(read, other):
    assert (read.stamp, read.names) == (other.stamp, other.names)
    assert bits(read.values) == bits(other.values)


def message_of(stamp, names, frame_id='', **numbers):
    message = JointState(name=list(names), **{
        name: array('d', values) for name, values in numbers.items()})
    message.header.stamp, message.header.frame_id = messages.to_stamp(stamp), frame_id
    return message


@settings(max_examples=50)
@given(stamps, names, arrays, words, st.data())
def test_what_it_writes_is_what_ros_reads(stamp, names, array_name, frame_id, data):
    values = data.draw(st.lists(doubles, min_size=len(names), max_size=len(names)))
    layout = codec.Layout(names, array_name, frame_id)
    message = deserialize_message(layout.encode(stamp, values), JointState)
    assert_same(codec.reading(message, array_name), codec.Reading(stamp, names, values))
    assert message.header.frame_id == frame_id
    assert sum(len(getattr(message, each)) for each in codec.ARRAYS) == len(names)
    assert_same(layout.decode(layout.encode(stamp, values)), codec.reading(message, array_name))


any_message = st.builds(
    message_of, stamps, st.one_of(names, st.permutations(NAMES), st.just(('v_squared',))),
    st.sampled_from(('', 'wing', 'a/wing')), position=st.lists(doubles, max_size=6),
    velocity=st.lists(doubles, max_size=2), effort=st.lists(doubles, max_size=2))


@settings(max_examples=50)
@given(arrays, st.lists(any_message, min_size=1, max_size=6))
def test_what_it_reads_is_what_ros_reads_whatever_came_before(array_name, sent):
    reader = codec.Reader(array_name)
    for message in sent * 2:
        data = serialize_message(message)
        assert_same(reader.read(data), codec.reading(message, array_name))


@settings(max_examples=50)
@given(stamps, doubles, st.binary(min_size=5, max_size=5))
def test_what_fills_the_gaps_does_not_matter(stamp, value, noise):
    """It is undefined in what ROS's own serialiser writes, which is to be read quickly too."""
    plain = COMMAND.encode(stamp, (value,))
    generic = serialize_message(message_of(stamp, messages.COMMANDED, effort=[value]))
    noisy = bytearray(plain)
    gaps = (17, 18, 19, 38, 39)     # behind frame and name
    for place, byte in zip(gaps, noise):
        noisy[place] = byte
    for data in (plain, bytes(noisy), generic, plain + noise):
        assert_same(COMMAND.decode(data), codec.Reading(stamp, messages.COMMANDED, (value,)))
        assert messages.to_v_squared(deserialize_message(data, JointState)) == value or (
            value != value)


@settings(max_examples=50)
@given(st.integers(0, 2**31 - 1), doubles)
def test_the_other_byte_order_is_left_to_ros(second, value):
    data = struct.pack('>4siI I1s3x I I10s2x III d', b'\0\0\0\0', second, 5, 1, b'\0', 1, 10,
                       b'v_squared\0', 0, 0, 1, value)
    assert COMMAND.decode(data) is None
    assert_same(codec.Reader('effort').read(data),
                codec.Reading(second * 10**9 + 5, messages.COMMANDED, (value,)))


@settings(max_examples=100)
@given(st.one_of(st.binary(max_size=80), st.integers(0, 63).map(
    lambda size: COMMAND.encode(7, (1.0,))[:size])))
def test_rubbish_is_refused_or_read_as_ros_reads_it(data):
    reader = codec.Reader('effort')
    reader.read(COMMAND.encode(7, (1.0,)))
    try:
        expected = codec.reading(deserialize_message(data, JointState), 'effort')
    except Exception:       # whatever the middleware raises
        with pytest.raises(BadInput, match='bytes that are no JointState'):
            reader.read(data)
    else:
        assert_same(reader.read(data), expected)


def test_a_known_layout_is_read_without_ros(monkeypatch):
    reader = codec.Reader('position')
    generic = message_of(5, NAMES, 'wing', position=range(5))
    reader.read(serialize_message(generic))
    monkeypatch.setattr(codec, 'deserialize_message', None)
    again = reader.read(serialize_message(message_of(6, NAMES, 'wing', position=range(5))))
    assert again.stamp == 6 and again.values == [0.0, 1.0, 2.0, 3.0, 4.0]

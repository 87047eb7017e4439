# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Foreign and damaged bags: what can be decoded is, what cannot is counted and named."""

import json

import bags
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer

from dewing_cli import main as cli
from dewing_sim.errors import BadInput
from dewing_sim.records import bag
from dewing_sim.records.mcap_file import Losses

STEP, TOPIC = 100_000, '/dewing/measurement'
OWN = 'float64 lift\nint32[] ids\n'


@pytest.fixture
def foreign(tmp_path):
    """Return a bag that has, beside ten measurements, messages of every strange kind."""
    with open(tmp_path / 'foreign.mcap', 'xb') as file:
        writer = Writer(file)
        writer.start(profile='ros2')
        known = writer.register_schema(bags.JOINTS, 'ros2msg', b'')
        unknown = writer.register_schema('their_msgs/msg/Lift', 'ros2msg', b'')
        defined = writer.register_schema('their_msgs/msg/Own', 'ros2msg', OWN.encode())
        channels = [writer.register_channel(topic, encoding, schema) for topic, encoding, schema in
                    [(TOPIC, 'cdr', known), ('/unknown', 'cdr', unknown), ('/bare', 'json', 0),
                     ('/json', 'json', known), ('/short', 'cdr', known),
                     ('/own', 'cdr', defined)]]
        own = b'\0\1\0\0' + np.float64(0.5).tobytes() + np.array([1, 7], '<i4').tobytes()
        for step in range(10):
            data = bags.joints(step * STEP, ['camber_mean', 'v_squared'], [2.0e-5, 1.0])
            for channel, content in zip(channels, (data, b'abc', b'{}', b'{}', data[:30], own)):
                writer.add_message(channel, step, content, step)
        writer.finish()
    return tmp_path / 'foreign.mcap'


def test_what_is_foreign_is_counted_and_named(foreign, tmp_path, capsys):
    losses = Losses()
    found = [topic for topic, _, _ in bag.read(foreign, losses=losses)]
    assert found.count(TOPIC) == found.count('/own') == 10 and len(found) == 20
    assert {topic: (number, reason) for (topic, reason), number in losses.messages.items()} == {
        '/unknown': (10, 'are of the type their_msgs/msg/Lift, which is neither known nor '
                         'defined in the file'),
        '/bare': (10, 'have no schema (json)'), '/json': (10, 'are encoded as json, not as cdr'),
        '/short': (10, f'do not fit their type, {bags.JOINTS}')}
    assert cli.main(['bag', 'info', str(foreign), '--json', str(tmp_path / 'info.json')]) == 0
    topics = json.loads((tmp_path / 'info.json').read_text())['topics']
    assert topics['/unknown'] == {'type': 'their_msgs/msg/Lift', 'messages': 10, 'undecoded': 10}
    assert topics['/own'] == {'type': 'their_msgs/msg/Own', 'messages': 10}
    said = capsys.readouterr()
    assert 'lost: /json: 10 messages are encoded as json, not as cdr' in said.out
    assert said.err == ''


def test_a_type_that_the_file_defines_is_decoded(foreign):
    message = next(bag.read(foreign, '/own')).message
    assert message.lift == 0.5 and message.ids.tolist() == [7]


def test_without_a_counter_losses_are_warnings(foreign):
    with pytest.warns(RuntimeWarning, match='/short: 10 messages do not fit their type'):
        assert not list(bag.read(foreign, '/short'))
    with pytest.raises(BadInput, match='no messages on /own'):
        with pytest.warns(RuntimeWarning, match='/own: 10 messages are of the type their_msgs'):
            bag.series(foreign, '/own')


def test_quantities_go_by_name_in_each_message(tmp_path):
    names = ['camber_mean', 'v_squared', 'cl']
    values = dict(zip(names, [2.0e-5, 1.0e4, 0.4]))
    orders = [names, names[::-1], ['cl', 'camber_mean', 'v_squared'],
              names[:2], [*names, 'cd'], ['cl', 'cl', 'cl']]
    path = bags.write(tmp_path / 'run.mcap', *(
        (TOPIC, bags.JOINTS, bags.joints(step * STEP, order, [values.get(k, 0) for k in order]))
        for step, order in enumerate(orders)))
    with pytest.warns(RuntimeWarning) as said:
        series = bag.series(path, TOPIC)
    assert {name: set(series[name]) for name in names} == {k: {v} for k, v in values.items()}
    assert len(series['time']) == 3
    assert sorted(str(each.message).partition(': /')[2] for each in said) == [
        'dewing/measurement: 1 messages do not have one name for each number',
        'dewing/measurement: 2 messages have other names than the first of their run']


def written(path, compression, steps=3000):
    """Write a bag of several chunks; return where their data begin and end."""
    with open(path, 'xb') as file:
        writer = Writer(file, chunk_size=64 * 1024, compression=compression)
        writer.start(profile='ros2')
        schema = writer.register_schema(bags.JOINTS, 'ros2msg', b'')
        channel = writer.register_channel(TOPIC, 'cdr', schema)
        for step in range(steps):
            data = bags.joints(step * STEP, ['camber_mean', 'v_squared'], [2.0e-5, step])
            writer.add_message(channel, step, data, step)
        writer.finish()
    spans, start = [], 8
    with open(path, 'rb') as file:
        for record in StreamReader(file, emit_chunks=True).records:
            if type(record).__name__ == 'Chunk':
                spans.append((start, file.tell()))
            start = file.tell()
    return spans


@pytest.mark.parametrize('compression', CompressionType)
@pytest.mark.parametrize('number', [0, 1])
def test_a_flipped_byte_costs_its_chunk_alone(compression, number, tmp_path, capsys):
    """Also in the first chunk, in which alone the channel stood before the summary."""
    path = tmp_path / 'run.mcap'
    start, end = written(path, compression)[number]
    spoilt = bytearray(path.read_bytes())
    spoilt[(start + end) // 2] ^= 0x10
    path.write_bytes(spoilt)
    losses = Losses()
    steps = [round(message.position[1]) for _, _, message in bag.read(path, losses=losses)]
    lost = losses.messages[TOPIC, 'are in damaged parts of the file']
    assert 0 < lost < 1000 and len(steps) + lost == 3000 and len(losses.chunks) == 1
    assert np.count_nonzero(np.diff(steps) != 1) == number
    assert cli.main(['bag', 'info', str(path)]) == 0
    said = capsys.readouterr().out
    assert f'lost: {TOPIC}: {lost} messages are in damaged parts of the file' in said
    assert 'lost: 1 chunks are left out: they' in said or 'their checksums are wrong' in said


def test_what_a_wrong_length_hides_is_missed(tmp_path):
    """The length of the first chunk is made to reach to the third."""
    path = tmp_path / 'run.mcap'
    (first, _), (_, _), (third, _), *_ = written(path, CompressionType.ZSTD, 9000)
    spoilt = bytearray(path.read_bytes())
    spoilt[first + 1:first + 9] = (third - first - 9).to_bytes(8, 'little')
    path.write_bytes(spoilt)
    losses = Losses()
    found = sum(1 for _ in bag.read(path, losses=losses))
    assert 8000 < found < 9000 and losses.sentences() == [
        f'{9000 - found} of the 9000 messages that the file says to hold are not found']


@settings(max_examples=150, deadline=None,
          suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_byte_that_is_wrong_ends_in_a_traceback(data, tmp_path, foreign):
    whole = foreign.read_bytes()
    spoilt = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 3))):
        spoilt[data.draw(st.integers(0, len(whole) - 1))] ^= data.draw(st.integers(1, 255))
    path = tmp_path / 'spoilt.mcap'
    path.write_bytes(spoilt[:data.draw(st.integers(len(whole) // 2, len(whole)))])
    assert cli.main(['bag', 'info', str(path)]) in (0, 2)
    try:
        for _, _, message in bag.read(path, TOPIC, losses=Losses()):
            assert message.position[0] == 2.0e-5        # a checksum guards every number
    except BadInput:
        pass

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""MCAP bags of the ROS 2 profile, as rosbag2 writes them: one file, definitions embedded.

Messages are kept in small chunks that go to disk as they fill, so that a run that is killed
leaves a file that `read` (and ``mcap recover``) can use up to the last chunk.
"""

import functools
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from dewing_sim.errors import BadInput
from dewing_sim.files import check_free

CHUNK = 64 * 1024           # bytes
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


@functools.cache
def _types():
    from rosbags.typesys import Stores, get_typestore
    return get_typestore(Stores.ROS2_JAZZY)


def is_known(kind: str) -> bool:
    """Return whether the definition of a message type is at hand."""
    return kind in _types().fielddefs


class BagWriter:
    """Writes serialised messages to ``path``, which must not exist."""

    def __init__(self, path: str | Path):
        """Open the file; raise `BadInput` if it exists or cannot be written."""
        from mcap.writer import Writer
        path = check_free(path, way_out='name another file')
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open('xb')
        self._writer = Writer(self._file, chunk_size=CHUNK)
        self._writer.start(profile='ros2', library='dewing')
        self._channels: dict[str, int] = {}
        self._sequence: dict[str, int] = {}

    def add_topic(self, topic: str, kind: str, qos: dict[str, Any] | None = None) -> None:
        """Announce a topic of message type ``kind`` and the QoS its publisher offers."""
        definition, _ = _types().generate_msgdef(kind, ros_version=2)
        schema = self._writer.register_schema(kind, 'ros2msg', definition.encode())
        self._channels[topic] = self._writer.register_channel(topic, 'cdr', schema, {
            'offered_qos_profiles': yaml.safe_dump([_qos(qos or {})], sort_keys=False),
            'topic_type_hash': _types().hash_rihs01(kind)})
        self._sequence[topic] = 0

    def write(self, topic: str, data: bytes, received: int, published: int) -> None:
        """Append a CDR message with its two times in ns."""
        self._writer.add_message(self._channels[topic], received, data, published,
                                 self._sequence[topic])
        self._sequence[topic] += 1

    def flush(self) -> None:
        """Put everything written so far on its way to the disk."""
        self._writer.flush()

    def close(self) -> None:
        """Write the index and close the file."""
        self._writer.finish()
        self._file.close()


def _qos(given: dict[str, Any]) -> dict[str, Any]:
    """Return a profile in the layout of rosbag2 9, with ROS's defaults where not given."""
    return dict(history='keep_last', depth=10, reliability='reliable', durability='volatile',
                deadline=dict(_FOREVER), lifespan=dict(_FOREVER), liveliness='automatic',
                liveliness_lease_duration=dict(_FOREVER),
                avoid_ros_namespace_conventions=False) | given


class Recorded(NamedTuple):
    """A message with the topic it was on and the wall time of its arrival in ns."""

    topic: str
    received: int
    message: Any


def read(path: str | Path, topic: str | None = None) -> Iterator[Recorded]:
    """Yield the messages of ``topic`` (default: all) in the order of their arrival.

    The file need not have been closed. Raises `BadInput` if it is not a bag.
    """
    from mcap.records import Channel, Message, Schema
    schemas, channels = {}, {}
    for record in _records(path):
        if isinstance(record, Schema):
            schemas[record.id] = record.name
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Message):
            channel = channels[record.channel_id]
            if topic in (None, channel.topic):
                kind = schemas[channel.schema_id]
                yield Recorded(channel.topic, record.log_time,
                               _types().deserialize_cdr(record.data, kind))


def _records(path: str | Path) -> Iterator[Any]:
    """Yield records up to the end, or to where a killed writer left off."""
    from mcap.exceptions import EndOfFile, InvalidMagic, McapError
    from mcap.stream_reader import StreamReader
    try:
        with open(path, 'rb') as file:
            yield from StreamReader(file).records
    except (EndOfFile, struct.error):       # mcap has no word of its own for half a record
        return
    except OSError as error:
        raise BadInput(f'{path}: cannot be read ({error.strerror})') from None
    except InvalidMagic:
        raise BadInput(f'{path}: not an MCAP file') from None
    except McapError as error:
        raise BadInput(f'{path}: damaged ({error})') from None


def series(path: str | Path, topic: str) -> dict[str, np.ndarray]:
    """Return ``time`` (s, from the stamps) and every named quantity of a JointState topic.

    All have shape (messages,); repeated stamps count once, the first.
    """
    stamps, rows, names = [], [], ()
    for _, _, message in read(path, topic):
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        if not stamps or stamp > stamps[-1]:
            names = tuple(message.name)
            stamps.append(stamp)
            rows.append(message.position if len(message.position) else message.effort)
    if not stamps:
        raise BadInput(f'{path}: no messages on {topic}')
    columns = np.array(rows, float).T
    return {'time': np.array(stamps) * 1.0e-9, **dict(zip(names, columns))}

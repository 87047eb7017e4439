# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""MCAP bags of the ROS 2 profile, as rosbag2 writes them: one file, definitions embedded.

Messages are kept in small chunks that go to disk as they fill, so that a run that is killed
leaves a file that `read` (and ``mcap recover``) can use up to the last chunk.
"""

import functools
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from dewing_sim.files import check_free, is_stream, target_of
from dewing_sim.records.mcap_file import Losses, messages
from dewing_sim.records.runs import Run, choose, split

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
        check_free(path, way_out='name another file')
        if is_stream(path):
            self._file = open(path, 'wb')
        else:
            target = target_of(path)
            target.parent.mkdir(parents=True, exist_ok=True)
            self._file = target.open('xb')
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


def read(path: str | Path, *topics: str, losses: Losses | None = None) -> Iterator[Recorded]:
    """Yield the messages of ``topics`` (default: all) in the order of their arrival.

    The file need not have been closed. What cannot be read or decoded is counted in ``losses``;
    without it every kind of loss is one warning at the end. Raises `BadInput` if the file is not
    a bag.
    """
    found = Losses() if losses is None else losses
    for channel, schema, record in messages(path, found, topics):
        try:
            message = _decoded(channel, schema, record.data)
        except _Undecodable as reason:
            found.messages[channel.topic, str(reason)] += 1
            found.kinds[channel.topic] = schema.name if schema else channel.message_encoding
        else:
            yield Recorded(channel.topic, record.log_time, message)
    if losses is None:
        for sentence in found.sentences():
            warnings.warn(f'{path}: {sentence}', RuntimeWarning, stacklevel=2)


class _Undecodable(Exception):
    """Says why, as the rest of a sentence that begins with the messages."""


def _decoded(channel: Any, schema: Any, data: bytes) -> Any:
    if schema is None:
        raise _Undecodable(f'have no schema ({channel.message_encoding or "no encoding"})')
    if channel.message_encoding != 'cdr':
        raise _Undecodable(f'are encoded as {channel.message_encoding or "nothing known"}, '
                           'not as cdr')
    types = _types() if is_known(schema.name) else _embedded(
        schema.name, schema.encoding, schema.data)
    if types is None:
        raise _Undecodable(f'are of the type {schema.name}, which is neither known nor defined '
                           'in the file')
    try:
        return types.deserialize_cdr(data, schema.name)
    except Exception:               # rosbags raises whatever wrong bytes provoke
        raise _Undecodable(f'do not fit their type, {schema.name}') from None


@functools.cache
def _embedded(name: str, encoding: str, definition: bytes) -> Any:
    """Return a store of types that knows ``name`` by the definition in the file, or None."""
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
    types = get_typestore(Stores.ROS2_JAZZY)
    try:
        text = definition.decode()
        types.register(get_types_from_idl(text) if encoding == 'ros2idl'
                       else get_types_from_msg(text, name))
    except Exception:               # as above
        return None
    return types if name in types.fielddefs and text.strip() else None


def runs(path: str | Path, topic: str) -> list[Run]:
    """Return the runs of a JointState topic: one begins wherever its stamps start again."""
    losses = Losses()
    found = split(read(path, topic, losses=losses), losses)
    for sentence in losses.sentences():
        warnings.warn(f'{path}: {sentence}', RuntimeWarning, stacklevel=3)
    return found


def series(path: str | Path, topic: str, run: int | None = None) -> dict[str, np.ndarray]:
    """Return ``time`` (s, from the stamps) and every named quantity of a JointState topic.

    All have shape (messages,); repeated stamps count once, the first. ``run`` counts from 1; it
    must be given if the bag holds several. Raises `BadInput` if there is no such run.
    """
    return choose(runs(path, topic), run, path, topic).series()

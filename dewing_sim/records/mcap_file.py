# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of an MCAP file, undecoded, up to the end or around the damage.

Chunks whose checksum is wrong are left out. What they described, the channels, is looked for in
the rest of the file, and what they held is counted by the index behind them.
"""

import os
import struct
from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dewing_sim.errors import BadInput

LOST = 'are in damaged parts of the file'


@dataclass
class Losses:
    """What of a file could not be read.

    ``messages`` are counted by topic and reason, ``kinds`` are the types of their topics,
    ``chunks`` the reasons why chunks were left out, ``remarks`` sentences about the whole file.
    """

    messages: Counter[tuple[str, str]] = field(default_factory=Counter)
    kinds: dict[str, str] = field(default_factory=dict)
    chunks: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    def sentences(self) -> list[str]:
        """Return one sentence for each kind of loss."""
        return [*(f'{topic or "unknown topics"}: {number} messages {reason}'
                  for (topic, reason), number in sorted(self.messages.items())),
                *(f'{number} chunks are left out: {reason}'
                  for reason, number in Counter(self.chunks).items()), *self.remarks]


def messages(path: str | Path, losses: Losses, topics: Collection[str] = (),
             ) -> Iterator[tuple[Any, Any, Any]]:
    """Yield (channel, schema or None, message), of ``topics`` if any, in the order of the file.

    Raises `BadInput` if the file cannot be opened or is not MCAP.
    """
    from mcap.records import Channel, Message, MessageIndex, Schema, Statistics
    known, found = _Descriptions(path), 0
    for record in _records(path, losses):
        if isinstance(record, (Channel, Schema)):
            known.add(record)
        elif isinstance(record, Statistics):
            _compare(record.message_count, found, losses)
        elif isinstance(record, (Message, MessageIndex)):
            found += len(record.records) if isinstance(record, MessageIndex) else 1
            channel = known.channel(record.channel_id)
            topic = channel.topic if channel else ''
            if topics and topic not in topics:
                continue
            if isinstance(record, MessageIndex):
                losses.messages[topic, LOST] += len(record.records)
            elif channel is None:
                losses.messages[topic, 'are on channels that the file does not describe'] += 1
            else:
                yield channel, known.schemas.get(channel.schema_id), record


def _compare(listed: int, found: int, losses: Losses) -> None:
    """Note messages that are in no damaged chunk, but behind a length that is wrong."""
    if listed > found and not losses.remarks:
        losses.remarks.append(f'{listed - found} of the {listed} messages that the file says to '
                              'hold are not found')


class _Descriptions:
    """Channels and schemas by number."""

    def __init__(self, path: str | Path):
        self._path, self._searched = path, False
        self.channels: dict[int, Any] = {}
        self.schemas: dict[int, Any] = {}

    def add(self, record: Any) -> None:
        from mcap.records import Channel
        (self.channels if isinstance(record, Channel) else self.schemas)[record.id] = record

    def channel(self, number: int) -> Any:
        """Return a channel, or None; one from a damaged chunk stands again at the end."""
        from mcap.records import Channel, Schema
        if number not in self.channels and not self._searched:
            self._searched = True
            for record in _records(self._path, Losses()):
                if isinstance(record, (Channel, Schema)):
                    self.add(record)
        return self.channels.get(number)


def _records(path: str | Path, losses: Losses) -> Iterator[Any]:
    """Yield the records of a file and its chunks, and the indices of chunks that are left out."""
    from mcap.exceptions import EndOfFile, InvalidMagic, RecordLengthLimitExceeded
    from mcap.records import Chunk, MessageIndex
    from mcap.stream_reader import CRCValidationError, StreamReader
    began = damaged = False
    try:
        with open(path, 'rb') as file:
            size = os.fstat(file.fileno()).st_size
            for record in StreamReader(file, emit_chunks=True, validate_crcs=True,
                                       record_size_limit=size).records:
                began = True
                if isinstance(record, Chunk):
                    content = _content(record, losses)
                    damaged = content is None
                    yield from content or ()
                elif damaged or not isinstance(record, MessageIndex):
                    damaged = damaged and isinstance(record, MessageIndex)
                    yield record
    except OSError as error:
        raise BadInput(f'{path}: cannot be read ({error.strerror})') from None
    except (EndOfFile, RecordLengthLimitExceeded, struct.error):    # mcap: half a record
        if damaged:
            losses.chunks.pop()     # the last one was not complete
        losses.remarks.append('the file was not closed or is cut short; all before is read')
    except CRCValidationError:
        if not losses.chunks:
            losses.remarks.append('the checksum of the file is wrong: do not trust its numbers')
    except InvalidMagic:
        if not began:
            raise BadInput(f'{path}: not an MCAP file') from None
        losses.remarks.append('the last bytes of the file are wrong')
    except (ValueError, MemoryError, OverflowError):    # of numbers and names that are damaged
        losses.remarks.append('the file is damaged; what follows the damage is not read')


def _content(chunk: Any, losses: Losses) -> list[Any] | None:
    """Return the records in a chunk, None if it is damaged."""
    from mcap.exceptions import UnsupportedCompressionError
    from mcap.stream_reader import CRCValidationError, breakup_chunk
    try:
        return breakup_chunk(chunk, validate_crc=True)
    except CRCValidationError:
        losses.chunks.append('their checksums are wrong')
    except UnsupportedCompressionError as error:
        losses.chunks.append(str(error))
    except Exception:               # what zstandard, lz4 and struct raise for damaged bytes
        losses.chunks.append('they cannot be unpacked')
    return None

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The two messages of the loop, JointStates, between numbers and the bytes that DDS carries.

ROS makes a Python object of a message, and a message of that, in some 70 us a lap; a layout that
is known takes 2. On the wire is classic CDR, little endian: four bytes that say so, then every
number at a multiple of its size, counted from there; a string is its length with the closing
NUL, its bytes and the NUL; a sequence is its length and its elements. In ``measurement`` and
``command`` all lengths stay the same from step to step, and so does every byte but those of the
stamp and of the values. What fills the gaps between numbers is undefined, and differs in every
message of ROS's own serialiser. Whatever does not have the layout goes to ROS's deserialiser.
"""

from collections.abc import Sequence
from functools import lru_cache
from struct import Struct
from typing import NamedTuple

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from dewing_sim.errors import BadInput

LITTLE_ENDIAN = b'\x00\x01\x00\x00'
ARRAYS = ('position', 'velocity', 'effort')
SECOND = 1_000_000_000      # ns


class Reading(NamedTuple):
    """Names and values of one array of a JointState, and its stamp in ns."""

    stamp: int
    names: tuple[str, ...]
    values: Sequence[float]


def reading(message: JointState, array: str) -> Reading:
    """Return what ``array`` of a message says, ``position`` or ``effort``."""
    stamp = message.header.stamp
    return Reading(stamp.sec * SECOND + stamp.nanosec, tuple(message.name),
                   getattr(message, array))


class Layout:
    """The bytes of a JointState with ``names``, as many numbers in ``array``, and nothing else."""

    def __init__(self, names: tuple[str, ...], array: str, frame_id: str = ''):
        """Lay out ``position`` or ``effort``, whichever ``array`` names; at least one name."""
        self.names = names
        before, after = _Fixed(8), _Fixed(0)        # behind the stamp, behind the values
        before.string(frame_id)
        before.number(len(names))
        for name in names:
            before.string(name)
        place = ARRAYS.index(array)
        for _ in ARRAYS[:place]:
            before.number(0)
        before.number(len(names))
        before.align(8)
        for _ in ARRAYS[place + 1:]:
            after.number(0)
        self._before, self._after = bytes(before.data), bytes(after.data)
        self._told = int.from_bytes(before.told, 'little')      # all but the gaps
        self._fixed = int.from_bytes(before.data, 'little')
        self._struct = Struct(f'<4siI{len(self._before)}s{len(names)}d{len(self._after)}s')

    def encode(self, stamp: int, values: Sequence[float]) -> bytes:
        """Return the message that says ``values`` under ``stamp`` (ns)."""
        seconds, rest = divmod(stamp, SECOND)
        return self._struct.pack(
            LITTLE_ENDIAN, seconds, rest, self._before, *values, self._after)

    def decode(self, data: bytes) -> Reading | None:
        """Return what ``data`` says, or None if it is laid out otherwise."""
        if len(data) < self._struct.size:
            return None
        kind, seconds, rest, before, *values, after = self._struct.unpack_from(data)
        if kind != LITTLE_ENDIAN or after != self._after or (
                before != self._before
                and int.from_bytes(before, 'little') & self._told != self._fixed):
            return None
        return Reading(seconds * SECOND + rest, self.names, values)


class _Fixed:
    """Bytes that are the same in every message; ``told`` is 255 for each, 0 in the gaps."""

    def __init__(self, offset: int):
        """Begin ``offset`` bytes behind the header."""
        self._offset = offset
        self.data, self.told = bytearray(), bytearray()

    def align(self, size: int):
        gap = -(self._offset + len(self.data)) % size
        self.data += bytes(gap)
        self.told += bytes(gap)

    def number(self, value: int):
        self.align(4)
        self._tell(value.to_bytes(4, 'little'))

    def string(self, value: str):
        text = value.encode() + b'\0'
        self.number(len(text))
        self._tell(text)

    def _tell(self, data: bytes):
        self.data += data
        self.told += b'\xff' * len(data)


@lru_cache(maxsize=64)
def layout(names: tuple[str, ...], array: str, frame_id: str = '') -> Layout:
    """Return the layout, made once."""
    return Layout(names, array, frame_id)


class Reader:
    """Reads one array of JointStates; fast as long as they keep the layout of the last one."""

    def __init__(self, array: str):
        """Read ``position`` or ``effort``, whichever ``array`` names."""
        self._array, self._layout = array, layout(('',), array)

    def read(self, data: bytes) -> Reading:
        """Return what the message says; raise `BadInput` if it is none."""
        return self._layout.decode(data) or self._read_slowly(data)

    def _read_slowly(self, data: bytes) -> Reading:
        try:
            message = deserialize_message(data, JointState)
        except Exception as error:      # that of the middleware
            raise BadInput(f'{len(data)} bytes that are no JointState '
                           f'({" ".join(str(error).split())})') from None
        found = reading(message, self._array)
        if found.names:
            self._layout = layout(found.names, self._array, message.header.frame_id)
        return found

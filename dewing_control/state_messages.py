# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller thinks, on ``~/state``, for people who tune it: published if one listens.

Camber counts in passive cambers a_ref and V^2 in V_L^2, as in the laws.
"""

from array import array
from collections.abc import Iterator
from time import perf_counter
from typing import Any

import numpy as np
from sensor_msgs.msg import JointState

from dewing_control.law.supervisor import Supervisor
from dewing_sim.identity import Identity
from dewing_sim.plant import Measurement
from dewing_sim.ros import messages, qos
from dewing_sim.ros.codec import Reading

LONGEST = 16        # numbers of one array in the memory of a law


class StateTopic:
    """Publishes how a controller answered each measurement."""

    def __init__(self, node):
        """Advertise ``~/state`` on ``node``."""
        self._publisher = node.create_publisher(JointState, '~/state', qos.every(1))
        self._told = -1                     # stamp of the last message
        self._began = 0.0

    def begin(self) -> None:
        """Note that a measurement has come."""
        self._began = perf_counter()

    def publish(self, read: Reading, output: str, identity: Identity, law: Supervisor,
                memory: Any, v_squared: float) -> None:
        """Tell how ``law`` answered ``read``, in which ``output`` was fed back."""
        if not self._publisher.get_subscription_count() or read.stamp == self._told:
            return
        known = {'latency': perf_counter() - self._began}
        known |= state(messages.measured(read), output, identity, law, memory, v_squared)
        self._told = read.stamp
        message = JointState(name=list(known), position=array('d', known.values()))
        message.header.stamp = messages.to_stamp(read.stamp)
        qos.publish(self._publisher, message)


def state(measurement: Measurement, output: str, identity: Identity, law: Supervisor,
          memory: Any, v_squared: float) -> dict[str, float]:
    """Return reference, camber, error, V^2 and the terms of the law by name.

    ``saturated`` is 1 where V^2 is at one of its bounds. A law that keeps no ``reference`` in its
    memory has none here, and no error.
    """
    inner = getattr(memory, 'inner', None)
    known = dict(terms(inner))
    camber = getattr(measurement, output) / identity.passive(output)
    found = {'camber': camber}
    if 'reference' in known:
        found = {'reference': known.pop('reference'), **found}
        found['error'] = found['reference'] - camber
    share = v_squared / identity.v_squared_slack
    saturated = float(v_squared in (0.0, law.limit))
    return found | dict(v_squared=v_squared, v_squared_share=share, saturated=saturated) | {
        f'term_{name}': value for name, value in known.items() if name != 'error'}


def terms(memory: Any, name: str = '') -> Iterator[tuple[str, float]]:
    """Yield the finite numbers in the memory of a law, by the names of its fields.

    Of complex numbers it is the modulus; arrays are numbered from 1, those of more than `LONGEST`
    are left out.
    """
    if isinstance(memory, (bool, int, float, np.number)):
        if np.isfinite(memory):
            yield name or 'memory', float(memory)
    elif isinstance(memory, complex):
        yield from terms(abs(memory), name)
    elif hasattr(memory, '_fields'):
        for field, value in zip(memory._fields, memory):
            yield from terms(value, field)
    elif isinstance(memory, (tuple, list, np.ndarray)) and len(memory) <= LONGEST:
        for number, value in enumerate(memory, start=1):
            yield from terms(value, f'{name or "memory"}_{number}')

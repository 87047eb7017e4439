# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of an identification, `config/sysid.yaml`."""

import os
from dataclasses import dataclass

from dewing_sim.errors import BadInput
from dewing_sim.parameters import choice, count, load, real, text
from dewing_sim.schema.relations import Bound


@dataclass(frozen=True)
class Experiment:
    """What is done to the plant about its operating point."""

    kind: str = choice('experiment to identify from', 'pulse', 'doublet', 'step', 'prbs', 'chirp')
    amplitude: float = real(
        'V', 'voltage whose square is the excursion of V^2', 1.0e-3, 1.0e5)
    linearity_tolerance: float = real(
        '-', 'admissible departure of the response from twice that at half amplitude', 0.0, 1.0)
    record: float = real('-', 'recorded convective times c/U', 1.0e-3, 1.0e3)
    hold: int = count('samples each level of a pulse, doublet or binary sequence lasts', 1, 10000)
    sweep_low: float = real('Hz', 'start of the chirp', 1.0e-3, 1.0e6)
    sweep_high: float = real('Hz', 'end of the chirp', 1.0e-3, 1.0e6)
    seed: int = count('start of the binary sequence', 1, 2047)

    relations = (Bound('sweep_low', 'sweep_high'),)


@dataclass(frozen=True)
class Fresh:
    """Experiments not used for identification, on which the model is judged."""

    amplitude: float = real(
        'V', 'voltage whose square is the excursion of V^2', 1.0e-3, 1.0e5)
    record: float = real('-', 'recorded convective times c/U', 1.0e-3, 1.0e3)
    hold: int = count('samples each bit of the binary sequence lasts', 1, 10000)
    seed: int = count('start of the binary sequence', 1, 2047)


@dataclass(frozen=True)
class Realisation:
    """How matrices are made of the record."""

    order: int = count('number of states', 2, 200)
    window: float = real('-', 'convective times c/U of pulse response used', 1.0e-3, 1.0e3)
    at_once: str = choice('the response to V^2 within one sample: a state of its own, or left '
                          'to the Hankel matrix as in the paper', 'state', 'hankel')
    lags: int = count('observer lags for experiments other than pulse', 1, 10000)
    unstable_poles: str = choice('what is done to unstable poles', 'keep', 'reflect')
    outputs: str = text('identified outputs: standard, modal, or names with commas between')


@dataclass(frozen=True)
class Settings:
    """A complete description of one identification."""

    experiment: Experiment
    fresh: Fresh
    realisation: Realisation

    ros_node = 'sysid'


@dataclass(frozen=True)
class NodeSettings:
    """What the node does beside identifying; given to it together with `Settings`.

    Raises `BadInput` if model and experiments are to go to one file.
    """

    output: str = text('npz file of the model; it must not exist, none is written if empty')
    records: str = text('npz file of the experiments; none is written if empty')
    begin: str = choice(
        'when the experiments begin; on_replay: none are made, the model is that of a bag that '
        'is played', 'at_start', 'on_request', 'on_replay')
    afterwards: str = choice('what the node does with the model published', 'stay', 'exit')
    patience: float = real('s', 'wall time without a measurement after which the node gives up',
                           0.1, 1.0e6)

    def __post_init__(self):
        """Compare the files, links followed."""
        if self.records and os.path.realpath(self.output) == os.path.realpath(self.records):
            raise BadInput(f'output and records are both {self.output}: name another file for one')


NODE_DEFAULTS = dict(output='model.npz', records='', begin='at_start', afterwards='stay',
                     patience=30.0)


def shipped() -> tuple[NodeSettings, Settings]:
    """Return the parameters of the node."""
    return NodeSettings(**NODE_DEFAULTS), load('sysid', Settings)

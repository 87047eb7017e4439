# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The schema of an identification, `config/sysid.yaml`."""

from dataclasses import dataclass

from dewing_sim.parameters import choice, count, real


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

    order: int = count('number of states', 1, 200)
    window: float = real('-', 'convective times c/U of pulse response used', 1.0e-3, 1.0e3)
    lags: int = count('observer lags for experiments other than pulse', 1, 10000)
    unstable_poles: str = choice('what is done to unstable poles', 'keep', 'reflect')
    outputs: str = choice('identified outputs', 'standard', 'modal')


@dataclass(frozen=True)
class Settings:
    """A complete description of one identification."""

    experiment: Experiment
    fresh: Fresh
    realisation: Realisation

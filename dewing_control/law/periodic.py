# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The PID with learnt feed-forward against a periodic disturbance of known frequency.

Each harmonic n f has a phasor s that learns from the error through the PID's own response C,

    w = PID + sum Re s_n,    s_n+ = exp(2 pi i n f T) (s_n + lambda T C(n f) e),

which is adaptive feed-forward cancellation and, seen from e, a resonator (Bodson, Sacks and
Khosla 1994, doi:10.1109/9.310041). Where the loop gain is high the camber answers s by s/C, so
the error at n f fades like exp(-lambda t / 2). Phasors rest while the command saturates.
"""

import cmath
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import linalg

from dewing_control.law import pid
from dewing_control.law.base import DisturbanceModel, Law, Settings
from dewing_control.law.pid import Pid, PidGains
from dewing_sim.identity import Identity
from dewing_sim.linear.state_space import Matrices, frequency_response
from dewing_sim.parameters import real
from dewing_sim.plant import Measurement


@dataclass(frozen=True)
class Learning:
    """How fast the feed-forward is learnt."""

    learning_rate: float = real(
        '1/s', 'rate at which the phasors learn', 0.0, 1.0e4)


class Memory(NamedTuple):
    """Memory of the PID and the phasors in V_L^2."""

    base: pid.Memory
    phasors: tuple[complex, ...]


@dataclass(frozen=True)
class Periodic(Law):
    """PID and phasors from a camber in m to V^2 in V^2."""

    kind = 'periodic'
    title = 'PID, learnt feed-forward'
    about = ('`pid` and learnt phasors at the harmonics of a known frequency (adaptive '
             'feed-forward cancellation, a resonator)')
    sections = {'pid': PidGains, 'disturbance_model': DisturbanceModel, 'periodic': Learning}
    memory = ('disturbance_model.harmonics',)
    ranges = {'periodic.learning_rate': (1.0, 200.0)}

    base: Pid
    rotations: tuple[complex, ...]      # of each phasor in one sampling time
    learning: tuple[complex, ...]       # lambda T C(n f)

    @classmethod
    def of(cls, settings: Settings, identity: Identity) -> 'Periodic':
        """Return the controller that ``settings`` describe for the plant of ``identity``."""
        base = Pid.of(settings, identity)
        angles = settings.disturbance_model.angles(base.dt)
        response = frequency_response(
            base.compensator(), np.array(angles) / (2.0 * np.pi * base.dt), base.dt)[0]
        rate = settings.periodic.learning_rate * base.dt
        return cls(base, tuple(cmath.exp(1j * angle) for angle in angles),
                   tuple(complex(rate * value) for value in response))

    @property
    def v_squared_max(self) -> float:
        """Return the largest V^2 asked for."""
        return self.base.v_squared_max

    def start(self, v_squared: float = 0.0) -> Memory:
        """Return the memory of a controller that takes over, without a bump, at ``v_squared``."""
        return Memory(self.base.start(v_squared), (0j,) * len(self.rotations))

    def step(self, memory: Memory, measurement: Measurement) -> tuple[Memory, float]:
        """Return the next memory and V^2, which is never negative nor above the limit."""
        addition = sum(phasor.real for phasor in memory.phasors)
        base, v_squared = self.base.step_with(memory.base, measurement, addition)
        error = base.error if 0.0 < v_squared < self.v_squared_max else 0.0
        return Memory(base, tuple(
            rotation * (phasor + learning * error) for rotation, phasor, learning
            in zip(self.rotations, memory.phasors, self.learning))), v_squared

    def compensator(self) -> Matrices:
        """Return the law without saturation, from the normalised error to V^2/V_L^2."""
        base = self.base.compensator()
        blocks = [np.array([[r.real, -r.imag], [r.imag, r.real]]) for r in self.rotations]
        inlets = [[(r * g).real, (r * g).imag] for r, g in zip(self.rotations, self.learning)]
        return Matrices.siso(
            linalg.block_diag(base.a, *blocks), np.concatenate([base.b[:, 0], *inlets]),
            np.concatenate([base.c[0], np.tile([1.0, 0.0], len(blocks))]), base.d[0, 0])

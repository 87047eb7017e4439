# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The modes of a steady wing: flow, wake, membrane and coupling together.

An eigenvalue of the propagator over N steps is mu = exp(lambda N dt), lambda = growth + i omega.
Its logarithm knows omega only up to the sampling frequency 1 / (N dt). One more step of the
eigenvector tells which, up to 1 / (2 dt), and is a check that needs no Krylov space: what is none
of the wing's own, as rounding can produce, does not pass it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from dewing_sim.modes import energy
from dewing_sim.modes.krylov import Ritz, arnoldi
from dewing_sim.modes.propagator import KICK, Propagator, of_kick
from dewing_sim.state import State
from dewing_sim.wing import Wing

IN_PLANE = 0.5             # share of all kinetic energy beyond which a mode is one of the plane
OUTPUTS = ('camber_mean', 'cl')
CONVERGED = 1.0e-3          # largest residual of a mode that is listed
SAME = 0.05                 # how far one step may disagree with N: |mu_1 phi - P_1 phi|, relative


@dataclass(frozen=True, eq=False)
class Mode:
    """A mode of kinetic energy 1 (rho U^2 c^2, mean over a period).

    ``vector`` (n,) is complex; with theta its phase the perturbation is Re(vector exp(i theta)).
    """

    frequency: float            # Hz, of the oscillation
    growth: float               # 1/s, negative if damped
    residual: float             # |P v - mu v| / |mu v| in the Krylov space
    check: float                # the same over one step, without it
    membrane_share: float       # of the kinetic energy
    in_plane_share: float       # of the membrane's kinetic energy, along the chord
    controllability: float      # what a pulse of 1 V^2 s adds to its amplitude, 1/(V^2 s)
    observability: dict[str, float]     # amplitude of each of `OUTPUTS` in its unit
    vector: np.ndarray

    @property
    def damping(self) -> float:
        """Damping ratio -Re(lambda) / |lambda|, negative if the mode grows."""
        return -self.growth / float(np.hypot(self.growth, 2.0 * np.pi * self.frequency))

    def metrics(self) -> dict[str, float]:
        """Return the figures by the names that scripts know."""
        return {'frequency_hz': self.frequency, 'growth_per_s': self.growth,
                'damping': self.damping, 'residual': self.residual, 'check': self.check,
                'membrane_share': self.membrane_share, 'in_plane_share': self.in_plane_share,
                'controllability_per_v2s': self.controllability} | {
            f'observability_{name}': value for name, value in self.observability.items()}


@dataclass(frozen=True, eq=False)
class Modes:
    """The least damped modes of a base, those within the sheet's plane apart.

    Nothing but the time scheme damps the latter, and neither V^2 nor the air moves them much.
    """

    modes: list[Mode]
    in_plane: list[Mode]
    propagator: Propagator
    vectors: int
    unsettled: int              # less damped than the last listed, with too large a residual


def find(wing: Wing, base: State, period: float = 1.0e-3, vectors: int = 130, count: int = 6,
         progress: Callable[[int, int], None] | None = None) -> Modes:
    """Return the ``count`` least damped modes of ``wing`` about ``base``.

    ``period`` (s) is that of the propagator, rounded to steps: short for modes of the membrane,
    long for slow ones of the wake.
    """
    steps = max(1, round(period / wing.dt))
    propagator, kick = of_kick(wing, base, steps)
    ritz = arnoldi(propagator, kick, vectors, progress)
    one = replace(propagator, steps=1)
    found, in_plane, unsettled = [], [], 0
    for k in range(len(ritz.values)):
        if ritz.values[k].imag < 0.0 or len(found) == count:
            continue
        mode = _mode(propagator, one, ritz, k) if ritz.residuals[k] < CONVERGED else None
        if mode is None or mode.check >= SAME:
            unsettled += 1
        elif mode.membrane_share * mode.in_plane_share > IN_PLANE:
            in_plane.append(mode)
        else:
            found.append(mode)
    return Modes(found, in_plane, propagator, len(ritz.values), unsettled)


def _mode(propagator: Propagator, one: Propagator, ritz: Ritz, k: int) -> Mode:
    """Return the k-th pair as a mode."""
    vector, mu = ritz.vector(k), ritz.values[k]
    after = one(vector)
    single = complex(np.vdot(vector, after))
    check = float(np.linalg.norm(after - single * vector)) / abs(single)
    rate = _unwrapped(mu, single, propagator)
    if rate.imag < 0.0:                 # the sampling has mirrored it
        rate, vector = rate.conjugate(), vector.conj()
    shares = _shares(propagator, vector, abs(_bdf2(np.exp(rate * propagator.wing.dt))) / one.dt)
    amplitude = np.sqrt(sum(shares))
    vector = vector / amplitude
    return Mode(
        rate.imag / (2.0 * np.pi), rate.real, float(ritz.residuals[k]), check,
        membrane_share=(shares[0] + shares[1]) / sum(shares),
        in_plane_share=shares[0] / (shares[0] + shares[1]),
        controllability=float(abs(ritz.shares[k] * amplitude)) / KICK,
        observability=_outputs(propagator, vector), vector=vector)


def _unwrapped(mu: complex, single: complex, propagator: Propagator) -> complex:
    """Return lambda in 1/s of mu, with the frequency next to that of one step's factor."""
    rate, sampling = np.log(mu) / propagator.period, 2.0 * np.pi / propagator.period
    coarse = np.angle(single) / propagator.wing.dt
    return complex(rate + 1j * sampling * round((coarse - rate.imag) / sampling))


def _bdf2(z: complex) -> complex:
    """Return the velocity times dt of a unit displacement that grows by z in a step."""
    return 1.5 - 2.0 / z + 0.5 / z**2


def _shares(propagator: Propagator, vector: np.ndarray, speed: float,
            ) -> tuple[float, float, float]:
    """Return the kinetic energies of the membrane along and across the chord, and of the air.

    ``speed`` (U/c) is the velocity for a unit displacement. What solvers leave over is a smaller
    share of displacements than of velocities, hence so.
    """
    found = np.zeros(3)
    for part in (vector.real, vector.imag):
        if not part.any():
            continue
        norm = float(np.linalg.norm(part))
        ahead, behind = about(propagator, part / norm)
        scale = (norm / propagator.size)**2
        velocity = 0.5 * speed * (ahead.motion.position - behind.motion.position)
        found += scale * np.array([*energy.membrane(propagator.wing, velocity),
                                   energy.air(propagator.wing, ahead, behind)])
    return tuple(0.5 * found)           # of Re(v exp(i theta)), the mean over theta


def _outputs(propagator: Propagator, vector: np.ndarray) -> dict[str, float]:
    """Return the amplitudes of the outputs of a complex perturbation."""
    found = dict.fromkeys(OUTPUTS, 0.0j)
    for part, unit in ((vector.real, 1.0), (vector.imag, 1.0j)):
        norm = float(np.linalg.norm(part))
        if norm == 0.0:
            continue
        ahead, behind = map(propagator.wing.observe, about(propagator, part / norm))
        for name in found:
            change = getattr(ahead, name) - getattr(behind, name)
            found[name] += unit * 0.5 * norm / propagator.size * change
    return {name: float(abs(value)) for name, value in found.items()}


def about(propagator: Propagator, direction: np.ndarray) -> tuple[State, State]:
    """Return the base with a perturbation along a unit ``direction`` added and subtracted."""
    coordinates = propagator.coordinates
    middle, step = coordinates.vector(propagator.base), propagator.size * direction
    return coordinates.state(middle + step), coordinates.state(middle - step)

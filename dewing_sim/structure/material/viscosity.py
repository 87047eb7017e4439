# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Quasi-linear viscoelasticity: a Prony series on the deviatoric stress.

To the long-term stress of the elastomer, branches i add the second Piola-Kirchhoff overstress
(Holzapfel and Gasser, doi 10.1016/S0045-7825(00)00323-6)

    dh_i/dt + h_i / tau_i = beta_i dS_dev/dt,

with S_dev the deviatoric stress of the law. A step of dt in which S_dev changes linearly
is solved exactly: h_i' = e_i h_i + beta_i r_i (S_dev' - S_dev), e = exp(-dt/tau),
r = (1 - e) tau / dt. Statics see the long-term elastomer.
"""

from abc import ABC, abstractmethod
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.scales import Scales
from dewing_sim.structure.dynamics.motion import Motion


@dataclass(frozen=True)
class Prony:
    """Branches with moduli ``shares`` (of the long-term modulus) and relaxation ``times``."""

    shares: tuple[float, ...]
    times: tuple[float, ...]

    def __post_init__(self):
        """Raise `BadInput` unless shares and positive times come in pairs."""
        if len(self.shares) != len(self.times):
            raise BadInput(f'{len(self.shares)} shares of viscous branches, '
                           f'{len(self.times)} times')
        for share, time in zip(self.shares, self.times):
            if not (0.0 <= share < np.inf and 0.0 < time < np.inf):
                raise BadInput(f'viscous branch of share {share} and time {time} s is out of '
                               'range: zero or more, and more than zero')

    @classmethod
    def from_parameters(cls, section: parameters.Membrane, scales: Scales) -> 'Prony | None':
        """Return the branch of a parameter section, None if it has none."""
        if not section.viscous_share:
            return None
        return cls((section.viscous_share,), (section.viscous_time / scales.time,))

    def instant_gain(self, dt: float) -> float:
        """Return the sum of beta r: the overstress per change of S_dev within a step."""
        return float(np.dot(self.shares, self._ramp(dt)))

    def held(self, memory: np.ndarray, dt: float) -> np.ndarray:
        """Return the overstress of the next step less its gain times the new S_dev.

        ``memory`` (branches + 1, components, n) holds the h_i and, last, S_dev.
        """
        fade = np.exp(-dt / np.array(self.times))
        return np.tensordot(fade, memory[:-1], 1) - self.instant_gain(dt) * memory[-1]

    def remember(self, memory: np.ndarray, stress: np.ndarray, dt: float) -> np.ndarray:
        """Return the memory after a step that ended at S_dev = ``stress`` (components, n)."""
        fade = np.exp(-dt / np.array(self.times))[:, None, None]
        gain = (np.array(self.shares) * self._ramp(dt))[:, None, None]
        return np.concatenate([fade * memory[:-1] + gain * (stress - memory[-1]), stress[None]])

    def relaxed(self, stress: np.ndarray) -> np.ndarray:
        """Return the memory of a long rest at S_dev = ``stress`` (components, n)."""
        still = np.zeros((len(self.shares), *stress.shape))
        return np.concatenate([still, stress[None]])

    def _ramp(self, dt: float) -> np.ndarray:
        share = dt / np.array(self.times)
        return -np.expm1(-share) / share


Structure = TypeVar('Structure', bound='Viscous')


class Overstress(NamedTuple):
    """Viscous second Piola-Kirchhoff stress: ``gain`` times the deviatoric one, plus ``held``.

    ``held`` (components, points) has the components of `Viscous.deviatoric_stress`.
    """

    gain: float
    held: np.ndarray


class Viscous(ABC):
    """What structures remember that are dataclasses with ``viscosity`` and ``overstress``.

    They are `Prony | None` and `Overstress | None`; without the former nothing is remembered.
    """

    @abstractmethod
    def deviatoric_stress(self, position: np.ndarray, v_squared: float) -> np.ndarray:
        """Return S_dev of the long-term elastomer (components, points)."""

    def during(self: Structure, motion: Motion, dt: float, v_squared: float) -> Structure:
        """Return the structure with the overstress of the step that follows ``motion``."""
        if self.viscosity is None:
            return self
        memory = self._memory(motion, v_squared)
        return self._under(Overstress(self.viscosity.instant_gain(dt),
                                      self.viscosity.held(memory, dt)))

    def after(self, motion: Motion, position: np.ndarray, v_squared: float, dt: float,
              ) -> np.ndarray:
        """Return the memory after a step from ``motion`` to ``position``; empty if elastic."""
        if self.viscosity is None:
            return motion.memory
        stress = self.deviatoric_stress(position, v_squared)
        return self.viscosity.remember(self._memory(motion, v_squared), stress, dt)

    def settled(self: Structure, motion: Motion) -> Structure:
        """Return the structure with its present overstress, to observe it."""
        if self.viscosity is None or not motion.memory.size:
            return self
        return self._under(Overstress(0.0, motion.memory[:-1].sum(axis=0)))

    def _under(self: Structure, overstress: Overstress) -> Structure:
        """Return a copy with another overstress, which keeps cached properties."""
        structure = copy(self)
        object.__setattr__(structure, 'overstress', overstress)
        return structure

    def _memory(self, motion: Motion, v_squared: float) -> np.ndarray:
        if motion.memory.size:
            return motion.memory
        return self.viscosity.relaxed(self.deviatoric_stress(motion.position, v_squared))

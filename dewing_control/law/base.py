# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a control law is and declares: one law is one file with one subclass of `Law`.

Camber is measured in passive cambers a_ref and V^2 in V_L^2, its value at the loss of tension;
the wing's identity supplies both.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar, Protocol

from dewing_sim.errors import BadInput
from dewing_sim.identity import Identity
from dewing_sim.parameters import choice, count, real
from dewing_sim.plant import Measurement


@dataclass(frozen=True)
class Reference:
    """What the camber shall follow."""

    output: str = choice('camber fed back', 'camber_mean', 'camber_max')
    target: float = real('-', 'wanted camber as a multiple of the passive one', 0.0, 10.0)
    rate: float = real('1/s', 'largest rate of change of the reference', 1.0e-6, 1.0e6)


@dataclass(frozen=True)
class Command:
    """How V^2 is issued."""

    voltage_limit: float = real('V', 'largest voltage the controller asks for', 0.0, 1.0e5)
    period_steps: int = count('steps of the plant in one control period', 1, 100000)
    delay_steps: int = count(
        'steps of the plant by which V^2 takes effect late, as the design expects it; 0: the '
        'step after the measurement', 0, 1000, default=0)
    hold_steps: int = count(
        'unusable measurements in a row answered with the last V^2, zero afterwards', 0, 1000000)
    subscribers: int = count(
        'listeners to command to wait for before the first answer', 0, 100, default=1)

    @property
    def delay_periods(self) -> int:
        """Return the delay in control periods, the next whole number."""
        return -(-self.delay_steps // self.period_steps)


@dataclass(frozen=True)
class DisturbanceModel:
    """What several laws are told of a periodic disturbance."""

    frequency: float = real('Hz', 'fundamental frequency', 1.0e-3, 1.0e4)
    harmonics: int = count('harmonics cancelled, from the fundamental up', 0, 20)

    def angles(self, dt: float) -> list[float]:
        """Return the angle in rad by which each harmonic turns in the sampling time ``dt`` (s).

        Raises `BadInput` for a harmonic at or above half the sampling rate, where it could not be
        told from a slower one.
        """
        highest = self.harmonics * self.frequency
        if highest >= 0.5 / dt:
            raise BadInput(f'disturbance_model.frequency = {self.frequency:g} Hz with harmonics = '
                           f'{self.harmonics} reaches {highest:g} Hz; it must stay below '
                           f'{0.5 / dt:g} Hz, half the rate at which the controller runs')
        return [2.0 * pi * n * self.frequency * dt for n in range(1, self.harmonics + 1)]


class Settings(Protocol):
    """What a law is told: what is common to all, and its own `Law.sections` by name."""

    kind: str
    model: str
    reference: Reference
    command: Command


class Law(ABC):
    """A pure discrete-time law from a camber in m to V^2; all it remembers is in ``memory``.

    The declarations are class attributes; `of`, `start` and `step` are required.
    """

    kind: ClassVar[str] = ''
    """Name in the settings; a law from outside the package goes by ``package.module:Name``."""
    title: ClassVar[str] = ''
    """A word or two for figures."""
    about: ClassVar[str] = ''
    """One line that says what it is."""
    sections: ClassVar[Mapping[str, type]] = {}
    """Its settings: key in the YAML and frozen dataclass of `real`, `count`, `choice`, `text`."""
    memory: ClassVar[tuple[str, ...]] = ()
    """Settings (dotted) that change the form of the memory: with another value it begins anew."""
    ranges: ClassVar[Mapping[str, tuple[float, float]]] = {}
    """Settings (dotted) that tuning searches, on a logarithmic scale between two bounds."""
    needs_model: ClassVar[bool] = False
    """Whether `of` takes a model, the `Design` in the file ``settings.model``, as third."""
    requires: ClassVar[Mapping[str, str]] = {}
    """Optional modules that it imports, each with what ``pip install`` has to be told."""

    @classmethod
    @abstractmethod
    def of(cls, settings: Settings, identity: Identity, *model: Any) -> 'Law':
        """Return the law that ``settings`` describe for the plant of ``identity``."""

    @abstractmethod
    def start(self, v_squared: float = 0.0) -> Any:
        """Return the memory of a controller that takes over at ``v_squared``."""

    @abstractmethod
    def step(self, memory: Any, measurement: Measurement) -> tuple[Any, float]:
        """Return the next memory and V^2."""

    def compensator(self) -> Any:
        """Return the law without saturation, from r - a to V^2/V_L^2, for tuning.

        It is a `Matrices` or a `control.StateSpace`, without the delay of its output.
        """
        raise BadInput(f'{type(self).__name__} has no compensator, which tuning needs')

    @classmethod
    def dependent(cls, settings: Any) -> dict[str, Any]:
        """Return values (by dotted name) that follow from those that tuning chose."""
        return {}


def ramp(reference: float | None, camber: float, target: float, largest: float) -> float:
    """Return the next reference, at most ``largest`` from the last; the first is ``camber``."""
    if reference is None:
        return camber
    return reference + min(max(target - reference, -largest), largest)

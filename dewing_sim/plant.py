# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What identification, control and the nodes know of a plant, whatever solves its equations."""

import functools
from collections import namedtuple
from dataclasses import dataclass
from typing import Any, Callable, Iterator, Protocol

import numpy as np

from dewing_sim.inputs.base import Inputs
from dewing_sim.quantities import Absent, output, schema


@dataclass(frozen=True, kw_only=True)
class Outputs:
    """Observable quantities at one instant; SI units, loads per unit span.

    ``x, y`` are the membrane nodes in the wing frame (x from the leading edge along the chord,
    y towards the upper side), ``pressure_jump`` the pressure below minus above at these nodes;
    all three have the same shape ``(nodes,)``.

    An output that a plant does not have is None. It is never published and never recorded: the
    measurement has no such name, a `History` no such column, and to ask either for it raises
    `quantities.Absent`, a `BadInput`. No number stands for it, neither zero nor NaN. A plant has
    the same outputs at every instant.

    A plant from outside adds an output by a subclass, a frozen dataclass too, whose new fields
    are declared with `quantities.output`.
    """

    time: float = output('s', 'time since the rest state', required=True)
    camber_mean: float | None = output('m', 'chord average of y', measured=True, topic='camber')
    camber_max: float | None = output('m', 'deflection of largest magnitude', measured=True)
    cl: float | None = output('-', 'lift coefficient', measured=True, topic='cl')
    cd: float | None = output('-', 'drag coefficient', measured=True)
    v_squared: float = output('V^2', 'V^2 held during the step that led here', measured=True,
                              topic='v_squared', required=True)
    cm: float | None = output('-', 'pitching moment coefficient about c/4, nose up')
    camber_max_position: float | None = output('-', 'x/c of the largest deflection')
    tension: float | None = output('N/m', 'chord average of the tension')
    electric_field: float | None = output('V/m', 'largest true field V/h along the chord')
    capacitance: float | None = output('F/m', 'capacitance of the electrodes, per unit span')
    coupling_iterations: int | None = output('-', 'coupling iterations of the step', kind=int)
    clipped: int | None = output('-', 'steps so far whose V^2 was clipped to keep the tension',
                                 kind=int)
    x: np.ndarray | None = output('m', 'membrane nodes along the chord', kind=np.ndarray)
    y: np.ndarray | None = output('m', 'membrane nodes across the chord', kind=np.ndarray)
    pressure_jump: np.ndarray | None = output('Pa', 'pressure below minus above',
                                              kind=np.ndarray)

    @property
    def voltage(self) -> float:
        """V = sqrt(V^2) in volt."""
        return float(np.sqrt(self.v_squared))


SCALARS = schema(Outputs).scalars


def units_of(outputs: Outputs) -> dict[str, str]:
    """Return the units of what a plant with ``outputs`` has that responds to V^2, by name."""
    known = schema(type(outputs))
    names, _ = known.given(outputs, known.scalars)
    return {name: known.units[name] for name in names if name in known.units}


MEANING = """What a controller sees of a plant at one instant (SI); ``v_squared`` led here.

    ``time`` is a whole number of nanoseconds, as in the stamp of a message. A quantity that the
    plant does not have raises `quantities.Absent` when it is asked for.
    """


def instant(time: float) -> float:
    """Return ``time`` (s) as measurements have it, a whole number of nanoseconds."""
    return round(time * 1.0e9) * 1.0e-9


class Seen:
    """What all measurements have, whichever quantities they hold."""

    __slots__ = ()
    _fields: tuple[str, ...]

    @staticmethod
    def of(outputs: Outputs) -> 'Measurement':
        """Return the measured part of ``outputs``, without what the plant does not have."""
        known = schema(type(outputs))
        names, values = known.given(outputs, known.measured)
        return measurement_type(names)(instant(outputs.time), *values)

    def __getattr__(self, name: str) -> Any:
        raise Absent(f'measurement without {name}; it has {", ".join(self._fields[1:])}')

    def __reduce__(self) -> tuple:
        return _again, (self._fields[1:], *self)


@functools.lru_cache(maxsize=64)
def measurement_type(names: tuple[str, ...]) -> type:
    """Return the class of measurements of ``names``; raise ValueError for unusable names."""
    fields = namedtuple('Measurement', ('time', *names))
    return type('Measurement', (Seen, fields), {
        '__slots__': (), '__module__': __name__, '__doc__': MEANING})


def _again(names: tuple[str, ...], *values: float) -> 'Measurement':
    return measurement_type(names)(*values)


Measurement = measurement_type(schema(Outputs).measured)


class Plant(Protocol):
    """A discrete-time system driven by `Inputs`, held over ``dt`` (zero-order hold, D = 0).

    ``state`` is immutable: a step returns a new one, so runs branch from any state for free.
    """

    dt: float                           # s

    def rest(self) -> Any:
        """Return the trimmed state at time 0."""

    def step(self, state: Any, inputs: Inputs) -> Any:
        """Return the state one ``dt`` later with ``inputs`` held."""

    def observe(self, state: Any) -> Outputs:
        """Return the outputs of ``state``."""


class Measuring(Protocol):
    """What a `Plant` may have beside: its measured outputs alone, sooner than by `observe`."""

    def measure(self, state: Any) -> 'Measurement':
        """Return the measurement of ``state``, equal to that of what `Plant.observe` returns."""


def measure(plant: Plant, state: Any) -> 'Measurement':
    """Return what a controller sees of ``state``: what ``plant`` measures, else what it observes.

    A plant measures if it is `Measuring`. The values are not checked, see `LockStep`.
    """
    own = getattr(plant, 'measure', None)
    return Measurement.of(plant.observe(state)) if own is None else own(state)


def rollout(plant: Plant, state: Any, command: Callable[[Outputs], Inputs], steps: int,
            ) -> Iterator[tuple[Any, Outputs]]:
    """Yield (state, outputs) after each step; ``command`` maps outputs to the next inputs."""
    outputs = plant.observe(state)
    for _ in range(steps):
        state = plant.step(state, command(outputs))
        outputs = plant.observe(state)
        yield state, outputs

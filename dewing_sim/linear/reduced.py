# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear model as a plant, behind the same protocol as the wing.

    x[k+1] = A x[k] + B (V^2[k] - V0^2),    y[k] = y0 + C x[k] + w (1 - cos 2 pi f t[k])

with the states x (n,), outputs y (p,) in SI units, and w an optional additive disturbance of the
outputs with frequency f. There is no feed-through.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.files import new_file, read_npz
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear.model import Model
from dewing_sim.plant import Measurement, Outputs
from dewing_sim.quantities import extended, schema
from dewing_sim.schema.numerals import apart, not_above


class State(NamedTuple):
    """Number of steps taken, x (n,) and the V^2 of the last step."""

    step: int
    x: np.ndarray
    v_squared: float


@dataclass(frozen=True, eq=False)
class Reduced:
    """The plant of ``model``, at rest at ``rest_v_squared``, by default at V0^2.

    The outputs of the model are numbers among the `Outputs`, or others whose unit it says: these
    are measured. The plant does not have what the model lacks. Raises `BadInput` for an unknown
    output without a unit or for a model with a feed-through.
    """

    model: Model
    rest_v_squared: float | None = None     # V^2 of the rest state
    disturbance: np.ndarray | None = None   # (p,)
    disturbance_frequency: float = 0.0      # Hz

    def __post_init__(self):
        """Check what a model may have and a plant may not."""
        known = schema(Outputs)
        for name, unit in zip(self.model.output_names, self.model.units):
            if name not in known.units and (unit in ('', 'SI') or name in known.names):
                raise BadInput(f'reduced model: {name!r} is not an output of a plant; '
                               'a model may have others if it says their units')
        if np.any(self.model.d):
            raise BadInput('reduced model: D is not zero; V^2 cannot act at once on a membrane')
        try:
            object.__setattr__(self, '_outputs', extended(
                Outputs, tuple(zip(self.model.output_names, self.model.units))))
        except BadInput as error:
            raise BadInput(f'reduced model: {error}') from None
        rows = (len(self.model.output_names),)
        if self.disturbance is not None and not (
                self.disturbance.shape == rows and np.all(np.isfinite(self.disturbance))):
            raise BadInput(f'reduced model: disturbance must be finite and of shape {rows}, '
                           f'got shape {self.disturbance.shape}')
        if self.disturbance is not None:
            _require_sampled(self.disturbance_frequency, self.dt)

    @property
    def dt(self) -> float:
        """Time step in s."""
        return self.model.dt

    @property
    def v_squared_slack(self) -> float:
        """V^2 at the loss of tension."""
        return self.model.v_squared_slack

    @property
    def v_squared_max(self) -> float:
        """V^2 beyond which the model says nothing."""
        return self.model.v_squared_max

    @cached_property
    def gain(self) -> np.ndarray:
        """B as a vector (n,), for the step at 10 kHz."""
        return self.model.b[:, 0].copy()

    def trim(self, v_squared: float) -> State:
        """Return the steady state at constant ``v_squared``, at time 0."""
        model = self.model
        try:
            x = np.linalg.solve(np.eye(model.order) - model.a,
                                self.gain * (v_squared - model.operating_v_squared))
        except np.linalg.LinAlgError:
            raise BadInput('reduced model: a pole at 1 leaves no steady state') from None
        return State(0, x, v_squared)

    def rest(self) -> State:
        """Return the steady state at ``rest_v_squared``, at time 0."""
        return self.trim(self.model.operating_v_squared if self.rest_v_squared is None
                         else self.rest_v_squared)

    def step(self, state: State, inputs: Inputs) -> State:
        """Return the state one ``dt`` later; raise `Diverged` when it is not finite.

        Raises `BadInput` for an input that the model does not have.
        """
        model, v_squared = self.model, inputs.v_squared
        if inputs.wall_pressure or inputs.inflow:
            raise BadInput('reduced model: it has no input but V^2, neither wall_pressure nor '
                           'inflow')
        with np.errstate(over='ignore', invalid='ignore'):
            x = model.a @ state.x + self.gain * (v_squared - model.operating_v_squared)
        if not math.isfinite(x.sum()):
            raise Diverged(f'reduced model: the state is not finite after step {state.step + 1}; '
                           'the model or the loop is unstable', state)
        return State(state.step + 1, x, v_squared)

    def observe(self, state: State) -> Outputs:
        """Return the outputs of ``state``."""
        y = self.model.operating_outputs + self.model.c @ state.x
        time = state.step * self.model.dt
        if self.disturbance is not None:
            phase = 2.0 * math.pi * self.disturbance_frequency * time
            y = y + self.disturbance * (1.0 - math.cos(phase))
        return self._outputs(time=time, v_squared=state.v_squared,
                             **dict(zip(self.model.output_names, y.tolist())))

    def measure(self, state: State) -> Measurement:
        """Return the measured outputs of ``state``."""
        return Measurement.of(self.observe(state))

    def save(self, path: str | Path, state: State) -> None:
        """Write ``state`` to the npz file ``path``."""
        with new_file(path, overwrite=True) as file:
            np.savez(file, step=state.step, x=state.x, v_squared=state.v_squared)

    def load(self, path: str | Path) -> State:
        """Return a saved state; raise `BadInput` if it is not one of this plant."""
        with read_npz(path, 'a saved state') as arrays:
            state = State(int(arrays['step']), arrays['x'], float(arrays['v_squared']))
        if state.x.shape != (self.model.order,):
            raise BadInput(f'{path}: {state.x.size} states saved, the model has '
                           f'{self.model.order}')
        return state


def save(path: str | Path, plant: Reduced, overwrite: bool = False) -> None:
    """Write ``plant`` to an npz file that both `load` and `Model.load` read."""
    own = {name: value for name, value in vars(plant).items()
           if name in _OWN and value is not None}
    with new_file(path, overwrite) as file:
        np.savez(file, **plant.model.arrays() | own)


def load(path: str | Path) -> Reduced:
    """Read a plant written by `save`, or a model; raise `BadInput` if it is not one."""
    with read_npz(path, 'a linear model') as arrays:
        own = {name: np.asarray(arrays[name], float) if name == 'disturbance'
               else float(arrays[name]) for name in _OWN if name in arrays}
        model = Model.of_arrays(arrays)
    try:
        return Reduced(model, **own)
    except BadInput as error:
        raise BadInput(f'{path}: {error}') from None


def _require_sampled(frequency: float, dt: float) -> None:
    """Raise `BadInput` for a frequency that steps of ``dt`` show as another one."""
    highest = 0.5 / dt
    if not 0.0 <= frequency <= highest:
        raise BadInput(f'reduced model: disturbance_frequency = {apart(frequency, highest)[0]} Hz '
                       f'is out of range: from 0 to {not_above(highest)} Hz, 1/(2 dt), with dt = '
                       f'{dt:.10g} s')


_OWN = ('rest_v_squared', 'disturbance', 'disturbance_frequency')

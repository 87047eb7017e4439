# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear discrete-time plant about an operating point, behind the same protocol as the wing.

    x[k+1] = A x[k] + B (V^2[k] - V0^2),    y[k] = y0 + C x[k] + w (1 - cos 2 pi f t[k])

with the states x (n,), outputs y (p,) in SI units, and w an optional additive disturbance of the
outputs with frequency f. There is no feed-through.
"""

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.files import new_file
from dewing_sim.identity import loss_of_tension
from dewing_sim.plant import SCALARS, Outputs


class State(NamedTuple):
    """Number of steps taken, x (n,) and the V^2 of the last step."""

    step: int
    x: np.ndarray
    v_squared: float


@dataclass(frozen=True)
class Reduced:
    """The plant (A, B, C) with time step ``dt`` about V0^2 = ``operating_v_squared``.

    Rows of C, ``operating_outputs`` and ``disturbance`` belong to ``output_names``, which are
    scalar fields of `Outputs`; those without a row are zero. ``extra`` holds whatever else the
    file said (singular values, fit, case), unused here.
    """

    A: np.ndarray                           # (n, n)
    B: np.ndarray                           # (n,)
    C: np.ndarray                           # (p, n)
    dt: float                               # s
    operating_v_squared: float              # V0^2
    operating_outputs: np.ndarray           # (p,)
    output_names: tuple[str, ...]           # (p,)
    v_squared_slack: float                  # V^2 at the loss of tension
    v_squared_max: float                    # V^2 beyond which the model says nothing
    rest_v_squared: float = 0.0             # V^2 of the rest state
    disturbance: np.ndarray | None = None   # (p,)
    disturbance_frequency: float = 0.0      # Hz
    extra: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        """Raise `BadInput` for shapes that do not fit or values that are not finite.

        The matrices are laid out by rows, as from a file: BLAS rounds by layout.
        """
        for name in ('A', 'B', 'C'):
            object.__setattr__(self, name, np.ascontiguousarray(getattr(self, name), float))
        states, rows = self.B.size, len(self.output_names)
        shapes = {'A': (states, states), 'B': (states,), 'C': (rows, states),
                  'operating_outputs': (rows,)}
        if self.disturbance is not None:
            shapes['disturbance'] = (rows,)
        for name, shape in shapes.items():
            array = getattr(self, name)
            if array.shape != shape or not np.all(np.isfinite(array)):
                raise BadInput(f'reduced model: {name} must be finite and of shape {shape}, '
                               f'got shape {array.shape}')
        for name in self.output_names:
            if name not in SCALARS or name in ('time', 'v_squared'):
                raise BadInput(f'reduced model: {name!r} is not an output of a plant')
        for name in ('dt', 'v_squared_slack', 'v_squared_max'):
            if not 0.0 < getattr(self, name) < math.inf:
                raise BadInput(f'reduced model: {name} = {getattr(self, name)} is not positive')

    def trim(self, v_squared: float) -> State:
        """Return the steady state at constant ``v_squared``, at time 0."""
        identity = np.eye(self.B.size)
        try:
            x = np.linalg.solve(identity - self.A, self.B * (v_squared - self.operating_v_squared))
        except np.linalg.LinAlgError:
            raise BadInput('reduced model: a pole at 1 leaves no steady state') from None
        return State(0, x, v_squared)

    def rest(self) -> State:
        """Return the steady state at ``rest_v_squared``, at time 0."""
        return self.trim(self.rest_v_squared)

    def step(self, state: State, v_squared: float) -> State:
        """Return the state one ``dt`` later; raise `Diverged` when it is not finite."""
        with np.errstate(over='ignore', invalid='ignore'):
            x = self.A @ state.x + self.B * (v_squared - self.operating_v_squared)
        if not math.isfinite(x.sum()):
            raise Diverged(f'reduced model: the state is not finite after step {state.step + 1}; '
                           'the model or the loop is unstable', state)
        return State(state.step + 1, x, v_squared)

    def observe(self, state: State) -> Outputs:
        """Return the outputs of ``state``."""
        y = self.operating_outputs + self.C @ state.x
        time = state.step * self.dt
        if self.disturbance is not None:
            phase = 2.0 * math.pi * self.disturbance_frequency * time
            y = y + self.disturbance * (1.0 - math.cos(phase))
        values = dict.fromkeys(SCALARS, 0.0)
        values.update(zip(self.output_names, y.tolist()))
        values.update(time=time, v_squared=state.v_squared, coupling_iterations=0)
        return Outputs(**values)

    def save(self, path, state: State):
        """Write ``state`` to the npz file ``path``."""
        with new_file(path, overwrite=True) as file:
            np.savez(file, step=state.step, x=state.x, v_squared=state.v_squared)

    def load(self, path) -> State:
        """Return a saved state; raise `BadInput` if it is not one of this plant."""
        with _arrays(path) as arrays:
            try:
                state = State(int(arrays['step']), arrays['x'], float(arrays['v_squared']))
            except KeyError as error:
                raise BadInput(f'{path}: not a saved state, {error.args[0]}') from None
        if state.x.shape != self.B.shape:
            raise BadInput(f'{path}: {state.x.size} states saved, the model has {self.B.size}')
        return state


_OWN = tuple(item.name for item in dataclasses.fields(Reduced) if item.name != 'extra')
_TEXTS = ('output_names',)
_ARRAYS = ('A', 'B', 'C', 'operating_outputs', 'disturbance')


def save(path, plant: Reduced):
    """Write ``plant`` to the npz file ``path``; `load` returns it."""
    own = {name: getattr(plant, name) for name in _OWN if getattr(plant, name) is not None}
    with open(path, 'wb') as file:
        np.savez(file, D=np.zeros(len(plant.output_names)), **own, **plant.extra)


def load(path) -> Reduced:
    """Read a model written by `save` or by identification; further keys go to ``extra``.

    Limits of V^2 that are not in the file follow from the case in it. Raises `BadInput` if the
    file is not a model, or has a feed-through D.
    """
    with _arrays(path) as arrays:
        values = {name: arrays[name] for name in arrays.files}
    if 'v_squared_slack' not in values and values.get('case_yaml'):
        values = {**_limits(str(values['case_yaml'])), **values}
    if np.any(values.pop('D', 0.0)):
        raise BadInput(f'{path}: D is not zero; V^2 cannot act at once on a membrane')
    required = [item.name for item in dataclasses.fields(Reduced)
                if item.default is dataclasses.MISSING
                and item.default_factory is dataclasses.MISSING]
    missing = [name for name in required if name not in values]
    if missing:
        raise BadInput(f"{path}: not a reduced model, {', '.join(missing)} missing")
    own = {name: _converted(name, values.pop(name)) for name in _OWN if name in values}
    return Reduced(**own, extra=values)


def _limits(case_yaml: str) -> dict[str, float]:
    case = parameters.from_yaml(case_yaml)
    return dict(v_squared_slack=loss_of_tension(case),
                v_squared_max=case.actuation.voltage_limit**2)


def _converted(name: str, value: np.ndarray) -> Any:
    if name in _TEXTS:
        return tuple(str(word) for word in value)
    if name == 'B':
        return np.asarray(value, float).reshape(-1)
    return np.asarray(value, float) if name in _ARRAYS else float(value)


def _arrays(path):
    """Open the npz file ``path``; raise `BadInput` if that fails."""
    try:
        return np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise BadInput(f'{path}: cannot be read as npz ({error})') from None

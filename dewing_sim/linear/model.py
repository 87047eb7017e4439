# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A linear discrete-time model about an operating point: the one holder of its matrices.

    x[k+1] = A x[k] + B u[k],    y[k] = C x[k] + D u[k],
    u = V^2 - V0^2,    y = outputs minus their values at V0^2

Identification finds it, the reduced plant flies it, controllers are designed on it.
`Model.to_control` hands it to python-control, `Model.of_control` takes one back; npz files keep
it, mat files carry it to MATLAB.
"""

import dataclasses
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.files import new_file, read_npz
from dewing_sim.identity import loss_of_tension
from dewing_sim.linear.state_space import Matrices, frequency_response
from dewing_sim.plant import Outputs
from dewing_sim.quantities import schema

if TYPE_CHECKING:
    from control import StateSpace


@dataclass(frozen=True, eq=False)
class Model:
    """The model with units, names, sampling time and operating point beside its matrices.

    The input is V^2 in ``input_unit``, and so are V0^2 and the limits of V^2. ``fit`` maps
    experiment to output name to percent NRMSE; ``case_yaml`` is the case in the format of
    `config/`. Raises `BadInput` for shapes that do not fit or values that are not finite.
    """

    a: np.ndarray                       # (n, n)
    b: np.ndarray                       # (n, 1)
    c: np.ndarray                       # (p, n), in units
    d: np.ndarray                       # (p, 1), in units
    dt: float                           # s
    output_names: tuple[str, ...]       # (p,)
    operating_outputs: np.ndarray       # (p,), in units
    v_squared_slack: float              # V^2 at the loss of tension
    v_squared_max: float                # V^2 beyond which the model says nothing
    operating_v_squared: float = 0.0    # V0^2
    units: tuple[str, ...] = ()         # (p,), those of `Outputs` where nothing is said
    singular_values: np.ndarray = field(default_factory=lambda: np.empty(0))    # Hankel matrix
    case_yaml: str = ''
    fit: dict[str, dict[str, float]] = field(default_factory=dict)
    input_name: str = 'v_squared'
    input_unit: str = 'V^2'

    def __post_init__(self):
        """Check, and lay the matrices out by rows, as from a file: BLAS rounds by layout."""
        rows, states = len(self.output_names), len(self.a)
        if not self.units:
            known = schema(Outputs).units
            object.__setattr__(self, 'units', tuple(known.get(name, 'SI')
                                                    for name in self.output_names))
        shapes = {'a': (states, states), 'b': (states, 1), 'c': (rows, states), 'd': (rows, 1),
                  'operating_outputs': (rows,)}
        for name, shape in shapes.items():
            array = np.ascontiguousarray(getattr(self, name), float)
            object.__setattr__(self, name, array)
            if array.shape != shape or not np.all(np.isfinite(array)):
                raise BadInput(f'linear model: {name.upper() if len(name) == 1 else name} must be '
                               f'finite and of shape {shape}, got shape {array.shape}')
        if len(self.units) != rows:
            raise BadInput(f'linear model: {len(self.units)} units for {rows} outputs')
        for name in ('dt', 'v_squared_slack', 'v_squared_max'):
            if not 0.0 < getattr(self, name) < math.inf:
                raise BadInput(f'linear model: {name} = {getattr(self, name)} is not positive')

    @property
    def matrices(self) -> Matrices:
        """Return A, B, C and D alone."""
        return Matrices(self.a, self.b, self.c, self.d)

    @property
    def order(self) -> int:
        """Return the number of states."""
        return self.a.shape[0]

    @property
    def poles(self) -> np.ndarray:
        """Return the eigenvalues of A."""
        return np.linalg.eigvals(self.a)

    @property
    def spectral_radius(self) -> float:
        """Return the largest modulus of an eigenvalue; below one for a stable model."""
        return float(np.abs(self.poles).max())

    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return natural frequency (Hz) and damping ratio of each pole, pairs once, ascending.

        s = log(z) / dt, f = |s| / 2 pi, zeta = -Re(s) / |s|. Poles whose f is not below the
        Nyquist frequency are no modes and left out: those about z = 0, which are delays, and those
        on the negative real axis, which no s describes.
        """
        poles = self.poles.astype(complex)
        s = np.log(poles[(poles.imag >= 0.0) & (poles != 0.0)]) / self.dt
        s = s[np.abs(s) * self.dt < np.pi]
        modulus = np.abs(s)
        damping = np.divide(-s.real, modulus, out=np.zeros_like(modulus), where=modulus > 0.0)
        ascending = np.argsort(modulus)
        return modulus[ascending] / (2.0 * np.pi), damping[ascending]

    def simulate(self, u: np.ndarray) -> np.ndarray:
        """Return y (outputs, N) for the deviations u (N,), starting at the operating point.

        `control.forced_response` gives the same in three times the time.
        """
        states = np.zeros((len(u), self.order))
        gain = self.b[:, 0]
        for k in range(len(u) - 1):
            states[k + 1] = self.a @ states[k] + gain * u[k]
        return self.c @ states.T + self.d * u

    def frequency_response(self, frequency: np.ndarray) -> np.ndarray:
        """Return C (zI - A)^-1 B + D, complex (outputs, frequencies), at ``frequency`` in Hz."""
        return frequency_response(self.matrices, frequency, self.dt)

    def to_control(self) -> 'StateSpace':
        """Return the `control.StateSpace` from V^2 - V0^2 to the deviations of the outputs."""
        return self.matrices.to_control(self.dt, inputs=[self.input_name],
                                        outputs=list(self.output_names), name='wing')

    @classmethod
    def of_control(cls, system: Any, like: 'Model | None' = None, **beside: Any) -> 'Model':
        """Return the model of a discrete-time ``system`` of python-control with one input.

        ``beside`` gives further fields of `Model` by name; names, units, operating point, limits
        and case that are missing are those of ``like``. Outputs are called by the labels of
        ``system`` where neither names them.
        Raises `BadInput` for a system in continuous time or with several inputs, and if
        operating_outputs, v_squared_slack or v_squared_max are given nowhere.
        """
        from control import ss
        system = ss(system)
        if not system.isdtime(strict=True) or system.dt is True:
            raise BadInput(f'the system has dt = {system.dt}: sample it at the time step of the '
                           'plant, control.sample_system(system, dt)')
        if system.ninputs != 1:
            raise BadInput(f'the system has {system.ninputs} inputs, a model one: V^2')
        found = dict(a=system.A, b=system.B, c=system.C, d=system.D, dt=float(system.dt), **beside)
        if like is not None:
            own = dict(fit={}, singular_values=np.empty(0))     # belong to other matrices
            return dataclasses.replace(like, **{**own, **found})
        missing = {'operating_outputs', 'v_squared_slack', 'v_squared_max'} - beside.keys()
        if missing:
            raise BadInput(f"a model needs {', '.join(sorted(missing))} beside its matrices")
        return cls(**{'output_names': tuple(system.output_labels), **found})

    def arrays(self) -> dict[str, Any]:
        """Return what a file holds, by the names it has there."""
        return dict(A=self.a, B=self.b, C=self.c, D=self.d, dt=self.dt,
                    operating_v_squared=self.operating_v_squared,
                    rest_v_squared=self.operating_v_squared,
                    operating_outputs=self.operating_outputs,
                    output_names=np.array(self.output_names), units=np.array(self.units),
                    v_squared_slack=self.v_squared_slack, v_squared_max=self.v_squared_max,
                    singular_values=self.singular_values, case_yaml=self.case_yaml,
                    fit=json.dumps(self.fit), input_name=self.input_name,
                    input_unit=self.input_unit)

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the npz file that `load` and the reduced plant read."""
        with new_file(path, overwrite) as file:
            np.savez(file, **self.arrays())

    def save_mat(self, path: str | Path, overwrite: bool = False) -> None:
        """Write a mat file (version 5) for MATLAB; names and units are cell arrays."""
        from scipy.io import savemat
        cells = {name: np.array(getattr(self, name), object) for name in ('output_names', 'units')}
        with new_file(path, overwrite) as file:
            savemat(file, self.arrays() | cells, oned_as='column')

    @classmethod
    def load(cls, path: str | Path) -> 'Model':
        """Read a model; raise `BadInput` if the file is missing or is not a model."""
        with read_npz(path, 'a linear model') as arrays:
            return cls.of_arrays(arrays)

    @classmethod
    def of_arrays(cls, arrays: Mapping[str, np.ndarray]) -> 'Model':
        """Return the model in the ``arrays`` of a file; raise `KeyError` if one is missing.

        Limits of V^2 that older files lack follow from the case in them.
        """
        text = str(arrays.get('case_yaml', ''))
        known = _limits(text) | dict(arrays) if text and 'v_squared_slack' not in arrays \
            else dict(arrays)
        outputs = len(known['output_names'])
        return cls(
            known['A'], np.reshape(known['B'], (-1, 1)), known['C'],
            np.reshape(known.get('D', np.zeros(outputs)), (-1, 1)),
            output_names=tuple(map(str, known['output_names'])),
            units=tuple(map(str, known.get('units', ()))),
            operating_outputs=known['operating_outputs'],
            singular_values=known.get('singular_values', np.empty(0)), case_yaml=text,
            fit=json.loads(str(known.get('fit', '{}'))),
            **{name: float(known[name]) for name in _NUMBERS},
            **{name: str(known[name]) for name in ('input_name', 'input_unit') if name in known})


_NUMBERS = ('dt', 'operating_v_squared', 'v_squared_slack', 'v_squared_max')


def _limits(case_yaml: str) -> dict[str, float]:
    case = parameters.from_yaml(case_yaml)
    return dict(v_squared_slack=loss_of_tension(case),
                v_squared_max=case.actuation.voltage_limit**2)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The identified model: matrices, what they refer to, and its npz file."""

import json
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.files import new_file

DELAY = 1.0e-6                          # modulus below which a pole is at z = 0


@dataclass(frozen=True)
class Model:
    """x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k] about an operating point (paper eq. 6).

    u = V^2 - V0^2 (in V^2), y = outputs minus their values at the operating point, in ``units``.
    A (order, order), B (order, 1), C (outputs, order), D (outputs, 1), zero.
    ``fit`` maps experiment to output name to percent NRMSE; ``case_yaml`` is the case in the
    format of `config/`.  The file has the keys of `dewing_sim.reduced`, which runs it as a plant.
    """

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    dt: float                           # s
    operating_v_squared: float          # V^2
    operating_outputs: np.ndarray       # (outputs,), in units
    output_names: tuple[str, ...]
    units: tuple[str, ...]
    v_squared_slack: float              # V^2 at the loss of tension
    v_squared_max: float                # V^2 the case admits
    singular_values: np.ndarray
    case_yaml: str = ''
    fit: dict[str, dict[str, float]] = field(default_factory=dict)

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

        s = log(z) / dt, f = |s| / 2 pi, zeta = -Re(s) / |s|; poles at z = 0 are delays, not modes,
        and left out.
        """
        poles = self.poles.astype(complex)
        s = np.log(poles[(poles.imag >= 0.0) & (np.abs(poles) > DELAY)]) / self.dt
        modulus = np.abs(s)
        damping = np.divide(-s.real, modulus, out=np.zeros_like(modulus), where=modulus > 0.0)
        ascending = np.argsort(modulus)
        return modulus[ascending] / (2.0 * np.pi), damping[ascending]

    def simulate(self, u: np.ndarray) -> np.ndarray:
        """Return y (outputs, N) for the deviations u (N,), starting at the operating point."""
        states = np.zeros((len(u), self.order))
        gain = self.b[:, 0]
        for k in range(len(u) - 1):
            states[k + 1] = self.a @ states[k] + gain * u[k]
        return self.c @ states.T + self.d * u

    def frequency_response(self, frequency: np.ndarray) -> np.ndarray:
        """Return C (zI - A)^-1 B + D, complex (outputs, frequencies), at ``frequency`` in Hz."""
        z = np.exp(2j * np.pi * np.asarray(frequency) * self.dt)
        resolvent = np.linalg.solve(z[:, None, None] * np.eye(self.order) - self.a, self.b)
        return (self.c @ resolvent + self.d)[:, :, 0].T

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the npz file that `load` and the reduced plant read."""
        with new_file(path, overwrite) as file:
            np.savez(file, A=self.a, B=self.b, C=self.c, D=self.d, dt=self.dt,
                     operating_v_squared=self.operating_v_squared,
                     rest_v_squared=self.operating_v_squared,
                     operating_outputs=self.operating_outputs,
                     output_names=np.array(self.output_names), units=np.array(self.units),
                     v_squared_slack=self.v_squared_slack, v_squared_max=self.v_squared_max,
                     singular_values=self.singular_values, case_yaml=self.case_yaml,
                     fit=json.dumps(self.fit))

    @classmethod
    def load(cls, path: str | Path) -> 'Model':
        """Read a model; raise `BadInput` if the file is missing or is not a model."""
        try:
            with np.load(path, allow_pickle=False) as file:
                return cls(
                    a=file['A'], b=file['B'], c=file['C'], d=file['D'], dt=float(file['dt']),
                    operating_v_squared=float(file['operating_v_squared']),
                    operating_outputs=file['operating_outputs'],
                    output_names=tuple(file['output_names'].tolist()),
                    units=tuple(file['units'].tolist()),
                    v_squared_slack=float(file['v_squared_slack']),
                    v_squared_max=float(file['v_squared_max']),
                    singular_values=file['singular_values'],
                    case_yaml=str(file['case_yaml']), fit=json.loads(str(file['fit'])))
        except OSError:
            raise BadInput(f'{path}: no such model file') from None
        except (KeyError, ValueError, zipfile.BadZipFile) as error:
            raise BadInput(f'{path}: not a model file ({error})') from None


def nrmse_fit(measured: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Return 100 (1 - |y - yhat| / |y - mean(y)|) percent of each row; 100 is perfect."""
    error = np.linalg.norm(measured - predicted, axis=1)
    spread = np.linalg.norm(measured - measured.mean(axis=1, keepdims=True), axis=1)
    if not spread.all():
        raise BadInput(f'output {int(np.argmin(spread))} is constant: the fit is not defined')
    return 100.0 * (1.0 - error / spread)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The normalised linear model that controllers are designed on.

With a = camber/a_ref, u = V^2/V_L^2 and the rest state (u0, 1),

    x[k+1] = A x[k] + B (w[k] - u0),    a[k] = 1 + C x[k],    w = u a.

A membrane under tension T0 (1 - u) feels V^2 as a load proportional to u times its curvature, so
w = u a is the input in which the camber is linear: a string under a uniform load has a = 1 + w
exactly, while in u it is a = 1/(1 - u). Near the rest state w and u agree to first order, and the
model identified from V^2 serves both.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import linalg

from dewing_sim.errors import BadInput
from dewing_sim.identity import require_reference
from dewing_sim.linear.model import Model
from dewing_sim.parameters import from_yaml

if TYPE_CHECKING:
    from control import StateSpace


@dataclass(frozen=True, eq=False)
class Design:
    """The ``model`` from w to one camber, w in V_L^2 and the camber in that at rest.

    `Design.model` is a `Model` like any other: hand `Design.to_control` to python-control.
    """

    model: Model

    @classmethod
    def of(cls, model: Model, output: str, steps: int = 1) -> 'Design':
        """Return the model of ``output``, held and sampled every ``steps`` of its time steps.

        Raises `BadInput` if the model lacks the output, has no camber at rest, no static gain that
        increases it, or is
        unstable: it could not be told what V^2 a camber needs.
        """
        if output not in model.output_names:
            raise BadInput(f'the model has no output {output}, only '
                           f"{', '.join(model.output_names)}")
        row = model.output_names.index(output)
        camber = require_reference(f'{output} of the model', float(model.operating_outputs[row]),
                                   from_yaml(model.case_yaml) if model.case_yaml else None)
        a, b = _every(model.a, model.b[:, 0], steps)
        slack = model.v_squared_slack
        design = cls.normalised(a, b * slack, model.c[row] / camber, steps * model.dt,
                                model.operating_v_squared / slack, model.v_squared_max / slack)
        radius = design.model.spectral_radius
        if radius >= 1.0:
            raise BadInput(f'the model is unstable (spectral radius {radius:.6f}); identify it '
                           'again with realisation.unstable_poles = reflect or a longer window')
        if not design.static_gain > 0.0:
            raise BadInput(f'the model says that camber falls with V^2 (gain '
                           f'{design.static_gain:.3g}); identify it again')
        return design

    @classmethod
    def normalised(cls, a: np.ndarray, b: np.ndarray, c: np.ndarray, dt: float,
                   operating_input: float, largest: float = 1.0) -> 'Design':
        """Return the model of A (n, n), B (n,), C (n,), time step (s), u0 and largest u."""
        return cls(Model(
            a, b[:, None], c[None], np.zeros((1, 1)), dt, ('camber',), np.ones(1), 1.0,
            v_squared_max=largest, operating_v_squared=operating_input, units=('a_ref',),
            input_name='w', input_unit='V_L^2'))

    def with_matrices(self, a: np.ndarray, b: np.ndarray, c: np.ndarray | None = None) -> 'Design':
        """Return the same about other matrices, with the same C by default."""
        c = self.c if c is None else c
        return Design(replace(self.model, a=a, b=b[:, None], c=c[None]))

    @cached_property
    def a(self) -> np.ndarray:
        """A (n, n)."""
        return self.model.a

    @cached_property
    def b(self) -> np.ndarray:
        """B as a vector (n,)."""
        return self.model.b[:, 0].copy()

    @cached_property
    def c(self) -> np.ndarray:
        """C as a vector (n,)."""
        return self.model.c[0]

    @cached_property
    def dt(self) -> float:
        """Sampling time in s."""
        return self.model.dt

    @cached_property
    def operating_input(self) -> float:
        """Return u0, V^2/V_L^2 at the operating point."""
        return self.model.operating_v_squared

    @property
    def order(self) -> int:
        """Return the number of states."""
        return self.model.order

    @cached_property
    def steady(self) -> np.ndarray:
        """The steady state (n,) for each unit of w - u0: (I - A)^-1 B."""
        return np.linalg.solve(np.eye(self.order) - self.a, self.b)

    @cached_property
    def static_gain(self) -> float:
        """G0 = C (I - A)^-1 B."""
        return float(self.c @ self.steady)

    def at_tension(self, ratio: float) -> 'Design':
        """Return the model of the membrane under ``ratio`` times the tension at rest.

        Poles exp(s T) move to exp(sqrt(ratio) s T), as the frequencies of a string do; the static
        gain from w stays. Poles on the negative real axis, which no s describes, stay as well.
        """
        poles, modes = np.linalg.eig(self.a.astype(complex))
        waves = ~((np.abs(poles.imag) < 1.0e-12) & (poles.real <= 0.0))
        moved = poles.copy()
        moved[waves] = np.exp(np.sqrt(ratio) * np.log(poles[waves]))
        inlet = np.linalg.solve(modes, self.b) * (1.0 - moved) / (1.0 - poles)
        return self.with_matrices(((modes * moved) @ np.linalg.inv(modes)).real,
                                  (modes @ inlet).real)

    def fundamental(self) -> 'Design':
        """Return the oscillator with frequency and damping of the main pole and the same G0.

        The main pole has the largest share of the static gain. Regulators designed on more than
        that invert the lightly damped higher modes, whose frequencies move with the tension, and
        fail at other voltages.
        """
        poles, modes = np.linalg.eig(self.a.astype(complex))
        share = np.abs((self.c @ modes) * np.linalg.solve(modes, self.b) / (1.0 - poles))
        share[poles.imag <= 0.0] = 0.0
        if not share.any():
            raise BadInput('the model has no oscillating mode; identify it again')
        rate = complex(np.log(poles[np.argmax(share)])) / self.dt
        stiffness = abs(rate)**2
        transition = linalg.expm(self.dt * np.array(
            [[0.0, 1.0, 0.0], [-stiffness, 2.0 * rate.real, stiffness], [0.0, 0.0, 0.0]]))
        return self.with_matrices(transition[:2, :2], transition[:2, 2],
                                  np.array([self.static_gain, 0.0]))

    @cached_property
    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (Hz) to Nyquist, fine about the modes, and the response there."""
        frequency = _frequencies(self)
        return frequency, self.response(frequency)

    def response(self, frequency: np.ndarray) -> np.ndarray:
        """Return C (zI - A)^-1 B at ``frequency`` (Hz, shape (m,)), complex (m,)."""
        return self.model.frequency_response(frequency)[0]

    def to_control(self) -> 'StateSpace':
        """Return the `control.StateSpace` from w - u0 to the camber minus one."""
        return self.model.to_control()


def load(path: str, output: str, period: float) -> Design:
    """Return the design model in the npz file ``path`` for a control period in s.

    Raises `BadInput` as `Design.of`, and if the model does not step into the period.
    """
    if not path:
        raise BadInput('model is empty: this kind of controller needs the npz file of an '
                       'identified model, as written by dewing identify and dewing tune')
    model = Model.load(path)
    steps = round(period / model.dt)
    if steps < 1 or not math.isclose(steps * model.dt, period, rel_tol=1.0e-6):
        raise BadInput(f'{path}: the model steps by {model.dt:g} s, of which the control period, '
                       f'{period:g} s, is no multiple; identify the wing at its own time step, '
                       'or change command.period_steps')
    return Design.of(model, output, steps)


def _every(a: np.ndarray, b: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Return A^n and (A^(n-1) + ... + I) B: the input is held over n steps."""
    total, power = np.zeros_like(b), np.eye(len(b))
    for _ in range(steps):
        total += power @ b
        power = a @ power
    return power, total


def _frequencies(design: Design) -> np.ndarray:
    nyquist = 0.5 / design.dt
    poles = np.linalg.eigvals(design.a)
    modes = np.abs(np.log(poles[poles.imag > 0.0])) / (2.0 * np.pi * design.dt)
    spread = np.geomspace(1.0e-4, 0.3, 25)
    local = [mode * (1.0 + sign * spread) for mode in modes for sign in (-1.0, 1.0)]
    grid = np.concatenate([np.geomspace(0.1, nyquist, 500), *local])
    return np.unique(grid[(grid > 0.0) & (grid <= nyquist)])

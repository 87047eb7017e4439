# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bare matrices of a state-space system, x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k]."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from control import StateSpace


class Matrices(NamedTuple):
    """Bare matrices of a state-space system; units and names are the caller's.

    Steps at 10 kHz, and a search that judges thousands of loops, take these: a StateSpace costs
    1.2 s of import, and 6 ms for the frequency response that `frequency_response` has in 0.2 ms.
    """

    a: np.ndarray                       # (n, n)
    b: np.ndarray                       # (n, inputs)
    c: np.ndarray                       # (outputs, n)
    d: np.ndarray                       # (outputs, inputs)

    @property
    def order(self) -> int:
        """Return the number of states."""
        return self.a.shape[0]

    @classmethod
    def siso(cls, a: np.ndarray, b: np.ndarray, c: np.ndarray, d: float) -> 'Matrices':
        """Return the matrices for vectors ``b``, ``c`` (n,) and a number ``d``."""
        return cls(a, np.reshape(b, (-1, 1)), np.reshape(c, (1, -1)), np.array([[float(d)]]))

    @classmethod
    def of(cls, system: 'Matrices | StateSpace') -> 'Matrices':
        """Return those of ``system``, which may be a `control.StateSpace`."""
        return system if isinstance(system, cls) else cls(system.A, system.B, system.C, system.D)

    def delayed(self, steps: int) -> 'Matrices':
        """Return the system of one input and output whose output comes ``steps`` later."""
        if not steps:
            return self
        order = self.order
        a, b = np.zeros((order + steps,) * 2), np.zeros((order + steps, 1))
        a[:order, :order], b[:order] = self.a, self.b
        a[order, :order], b[order] = self.c, self.d     # the line that outputs pass along
        a[order + 1:, order:-1] = np.eye(steps - 1)
        return Matrices(a, b, np.eye(order + steps)[-1:], np.zeros((1, 1)))

    def to_control(self, dt: float, **names: Any) -> 'StateSpace':
        """Return a `control.StateSpace`; ``names`` as there: inputs, outputs, name."""
        from control import StateSpace
        return StateSpace(*self, dt, remove_useless_states=False, **names)


def frequency_response(system: Matrices, frequency: np.ndarray, dt: float) -> np.ndarray:
    """Return C (zI - A)^-1 B + D for z = exp(2 pi i f dt), complex (outputs, m), of one input.

    ``frequency`` is in Hz, of shape (m,).
    """
    z = np.exp(2j * np.pi * np.asarray(frequency) * dt)
    resolvent = np.linalg.solve(z[:, None, None] * np.eye(system.order) - system.a, system.b)
    return np.array([(row @ resolvent)[:, 0] + direct
                     for row, direct in zip(system.c, system.d[:, 0])])

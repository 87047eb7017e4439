# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A state of the coupled wing as one vector, and back: what perturbations are made of.

The entries are those of flow, motion and jump history that act on the next step, in the units of
the state, those of the motion times a weight; complex ones count as two. What a flow state only
reports, its `reports`, is left out.
"""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from dewing_sim.state import State


@dataclass(frozen=True, eq=False)
class Coordinates:
    """The vectors about ``base``: `vector` and `state` undo each other.

    A norm of vectors adds flow and membrane, whose numbers differ by orders of magnitude, hence
    the ``weight`` of the membrane's.
    """

    base: State
    weight: float = 1.0

    def vector(self, state: State) -> np.ndarray:
        """Return the entries (n,) of a ``state`` of the form of the base."""
        return np.concatenate([self._weight(owner) * _real(value)
                               for owner, _name, value in _entries(state)])

    def state(self, vector: np.ndarray) -> State:
        """Return the base with the entries of ``vector`` (n,)."""
        changed: dict[str, dict[str, Any]] = {'flow': {}, 'motion': {}, '': {}}
        first = 0
        for owner, name, value in _entries(self.base):
            stop = first + _real(value).size
            changed[owner][name] = _like(value, vector[first:stop] / self._weight(owner))
            first = stop
        return replace(self.base, flow=replace(self.base.flow, **changed['flow']),
                       motion=replace(self.base.motion, **changed['motion']), **changed[''])

    def balanced(self, vector: np.ndarray) -> 'Coordinates':
        """Return the coordinates in which flow and motion of ``vector`` (n,) are equally large."""
        moves = np.concatenate([np.full(_real(value).size, owner == 'motion')
                                for owner, _name, value in _entries(self.base)])
        ratio = np.linalg.norm(vector[~moves]) / np.linalg.norm(vector[moves])
        return replace(self, weight=self.weight * float(ratio))

    def _weight(self, owner: str) -> float:
        return self.weight if owner == 'motion' else 1.0


def _entries(state: State) -> list[tuple[str, str, Any]]:
    """Return owner, name and value of all that acts on the next step."""
    reported = getattr(state.flow, 'reports', ())
    found = [('flow', field.name, getattr(state.flow, field.name))
             for field in fields(state.flow) if field.name not in reported]
    found += [('motion', field.name, getattr(state.motion, field.name))
              for field in fields(state.motion)]
    return [*found, ('', 'jump_history', state.jump_history)]


def _real(value: Any) -> np.ndarray:
    """Return the real numbers (m,) of an array or a number."""
    array = np.ascontiguousarray(value).ravel()
    return array.view(float) if np.iscomplexobj(array) else array.astype(float)


def _like(value: Any, numbers: np.ndarray) -> Any:
    """Return ``numbers`` (m,) in the form of ``value``."""
    if np.ndim(value) == 0:
        return complex(*numbers) if isinstance(value, complex) else float(numbers[0])
    array = np.array(numbers)       # a copy: states do not share what they are made of
    return (array.view(complex) if np.iscomplexobj(value) else array).reshape(np.shape(value))

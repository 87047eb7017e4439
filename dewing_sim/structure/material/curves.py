# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The curves that describe an elastomer and the membrane made of it, in SI units."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from dewing_sim import parameters
from dewing_sim.errors import DewingError
from dewing_sim.roots import bracketed
from dewing_sim.structure import elements
from dewing_sim.structure.material import limits
from dewing_sim.structure.material.elastomer import Elastomer, diagonal
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.sheet import Sheet
from dewing_sim.structure.solid.pins import LOWER, MIDDLE
from dewing_sim.structure.solid.solid import Solid

POINTS = 200
VOLTAGES = 11
STRUCTURES = {'membrane': {'element': 'membrane'},
              'solid': {'element': 'solid', 'support': LOWER},
              'solid_middle': {'element': 'solid', 'support': MIDDLE}}


@dataclass(frozen=True)
class Curves:
    """What `of_section` found; arrays of equal length belong together, what failed is None."""

    stretch: np.ndarray
    stress: dict[str, np.ndarray] | None    # mode -> passive Cauchy stress along the stretch, Pa
    voltage: np.ndarray                 # V, up to the loss of tension, or else to the limit
    tension: np.ndarray | None          # N/m, of the flat membrane
    slack_voltage: float | None
    free_stretch: np.ndarray            # equal biaxial, no load
    free_voltage: np.ndarray | None
    pull_in: limits.PullIn | None       # None if the law locks up first
    thickness: float                    # before prestretch, m
    camber_voltage: np.ndarray
    camber: dict[str, np.ndarray]       # structure -> largest static deflection in chords
    failures: dict[str, str]            # curve -> why there is none

    def metrics(self) -> dict[str, float]:
        """Return the numbers of the curves; those of a pull-in only if there is one."""
        found = {}
        if self.tension is not None:
            found['tension'] = float(self.tension[0])
        if self.slack_voltage is not None:
            found['slack_voltage'] = self.slack_voltage
        if self.pull_in:
            found |= {'pull_in_stretch': self.pull_in.stretch,
                      'pull_in_voltage': self.pull_in.field * self.thickness}
            if np.isfinite(self.pull_in.snapped_stretch):
                found['snapped_stretch'] = self.pull_in.snapped_stretch
        for name, camber in self.camber.items():
            found[f'camber_{name}_passive'] = float(camber[0])
            found[f'camber_{name}_highest'] = float(camber[-1])
        found['highest_voltage'] = float(self.camber_voltage[-1])
        thin = self.camber.get('membrane', np.zeros(1))
        for name in ('solid', 'solid_middle'):
            if name in self.camber and thin.all():      # none without a load
                difference = self.camber[name] / thin - 1.0
                found[f'largest_difference_{name}'] = float(np.abs(difference).max())
        return found


def of_section(section: parameters.Membrane, pressure: float, voltage_limit: float) -> Curves:
    """Return the curves of a membrane under a uniform ``pressure`` (Pa) up to ``voltage_limit``.

    The viscous branch, which statics do not see, is left out. A curve that cannot be computed is
    among the ``failures``, and the others are there.
    """
    section = parameters.replace(section, {'viscous_share': 0.0})
    sheet, failures = Sheet.from_parameters(section), {}
    elastomer, prestretch = sheet.elastomer, section.prestretch

    def attempt(curve: str, compute: Callable[[], Any]) -> Any:
        try:
            return compute()
        except DewingError as error:
            failures[curve] = str(error)
            return None

    slack = attempt('loss of tension', lambda: float(np.sqrt(
        sheet.loss_of_tension_v_squared(prestretch))))
    voltage = np.linspace(0.0, voltage_limit if slack is None else slack, POINTS)
    stretch = np.linspace(1.0, 0.95 * min(_reach(elastomer, limits.equibiaxial),
                                          _reach(elastomer, limits.plane_strain)), POINTS)
    free = np.geomspace(1.0, 0.999 * _reach(elastomer, limits.equibiaxial), POINTS)
    highest = voltage_limit if slack is None else min(voltage_limit, 0.95 * slack)
    camber_voltage = np.linspace(0.0, highest, VOLTAGES)
    camber = {name: attempt(f'camber of {name}', partial(
        _cambers_of, section, changes, pressure, camber_voltage))
        for name, changes in STRUCTURES.items()}
    return Curves(
        stretch=stretch, stress=attempt('stress', lambda: _stresses(elastomer, stretch)),
        voltage=voltage,
        tension=attempt('tension', lambda: np.array(
            [sheet.respond([prestretch], v * v).tension[0] for v in voltage])),
        slack_voltage=slack, free_stretch=free,
        free_voltage=attempt('free sheet', lambda: (
            limits.equibiaxial_field(elastomer, free) * section.initial_thickness)),
        pull_in=_pull_in(elastomer), thickness=section.initial_thickness,
        camber_voltage=camber_voltage,
        camber={name: curve for name, curve in camber.items() if curve is not None},
        failures=failures)


def _cambers_of(section: parameters.Membrane, changes: dict[str, Any], pressure: float,
                voltage: np.ndarray) -> np.ndarray:
    structure = elements.make(parameters.replace(section, changes))
    return cambers(structure, pressure, voltage)


def cambers(structure: Membrane | Solid, pressure: float, voltage: np.ndarray) -> np.ndarray:
    """Return the largest static deflections in chords at the voltages (n,)."""
    heights = [structure.surface(structure.equilibrium(pressure, v * v))[:, 1].max()
               for v in voltage]
    return np.array(heights) / structure.chord


def _pull_in(elastomer: Elastomer) -> limits.PullIn | None:
    try:
        return limits.equibiaxial_pull_in(elastomer)
    except limits.BadInput:
        return None


def _reach(elastomer: Elastomer, invariants) -> float:
    """Return the stretch at which the law locks up, or to which it is shown if it never does."""
    locking = limits.locking_stretch(elastomer.law, invariants)
    return locking if np.isfinite(locking) else limits.FARTHEST


def _stresses(elastomer: Elastomer, stretch: np.ndarray) -> dict[str, np.ndarray]:
    """Return stresses along the stretch of sheets with free faces, by mode."""
    lateral = {'uniaxial': stretch ** -0.5, 'plane strain': np.ones_like(stretch),
               'equibiaxial': stretch}
    return {mode: np.array([_stress(elastomer, l1, l2) for l1, l2 in zip(stretch, across)])
            for mode, across in lateral.items()}


def _stress(elastomer: Elastomer, l1: float, l2: float) -> float:
    def principal(l3):
        return np.diag(elastomer.cauchy_stress(diagonal((l1, l2, l3))))
    volume = l1 * l2
    low, high = (1.0 - 1.0e-9) / volume, 1.5 / volume       # tension lets it swell
    if principal(low)[2] > 0.0:
        low = 0.5 / volume          # an unstable law that pushes
    l3 = bracketed(lambda thickness: principal(thickness)[2], low, high, xtol=1e-15)
    return float(principal(l3)[0])

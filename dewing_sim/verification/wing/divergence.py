# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Static divergence of a slack-tensioned membrane, in the trend towards ideal flow."""

from dataclasses import dataclass, replace

import numpy as np

from dewing_sim import parameters
from dewing_sim.fluid.plate import adapt_circulation
from dewing_sim.inputs.base import Inputs
from dewing_sim.rest import trim
from dewing_sim.verification.closed_forms import TRIPLE_DECK, sail_deflection, sail_divergence
from dewing_sim.verification.fluid.rigid_flow import step_cost
from dewing_sim.verification.signals import limit
from dewing_sim.verification.study import Check, Study
from dewing_sim.wing import Wing

ALPHA = 0.5                         # deg, so that the tension hardly rises
TENSIONS = (3.5, 5.0)               # C_T = T / (q c)
REYNOLDS = (1000.0, 2500.0, 5000.0)
SAIL = 'sail theory, ideal flow'


@dataclass(frozen=True)
class SailRun:
    """A membrane of the `paper` case with C_T = ``tension``; returns y_max / (c alpha)."""

    engine: str
    grid: str
    reynolds: float
    tension: float
    duration: float = 25.0          # c/U

    @property
    def cost(self) -> float:
        """Expected milliseconds."""
        return 2.0 * step_cost(self.engine, self.grid) * self.duration / 0.004

    def __call__(self) -> float:
        """March to the static shape."""
        case = parameters.load('paper')
        wing = Wing(parameters.replace(case, {
            'flow.kinematic_viscosity': case.flow.speed * case.membrane.chord / self.reynolds,
            'flow.angle_of_attack_deg': ALPHA,
            'membrane.shear_modulus': self._shear_modulus(case),
            'actuation.voltage_limit': 0.0,
            'numerics.engine': self.engine, 'numerics.grid': self.grid}))
        return static_deflection(wing, self.duration) / np.radians(ALPHA)

    def _shear_modulus(self, case: parameters.Case) -> float:
        """Return mu for the tension, to which it is proportional."""
        wing = Wing(parameters.replace(case, {'numerics.grid': 'fast'}))
        membrane = wing.membrane
        present = 2.0 * float(membrane.tension(membrane.rest_position, 0.0)[0])
        return case.membrane.shear_modulus * self.tension / present


def static_deflection(wing: Wing, duration: float) -> float:
    """Return the largest deflection (c) that an overdamped membrane creeps to in ``duration``."""
    coupling = wing.coupling(damping=2.0 * trim.first_frequency(wing))
    state = trim.start(wing)
    for _ in range(round(duration * wing.scales.time / wing.dt)):
        state = wing.couple(state, Inputs(0.0), coupling)
        state = replace(state, step=0, flow=adapt_circulation(
            wing.fluid, state.flow, wing.fluid.dt))
    return wing.observe(state).camber_max / wing.scales.length


def runs(engine: str, quick: bool) -> dict[str, SailRun]:
    """Return two tensions at three Reynolds numbers."""
    if quick:
        return {}
    return {f'{reynolds:g}, {tension:g}': SailRun(engine, 'standard', reynolds, tension)
            for reynolds in REYNOLDS for tension in TENSIONS}


def southwell(tensions, deflections) -> float:
    """Return the C_T at which 1 / y, linear in C_T near divergence, vanishes."""
    inverse = 1.0 / np.asarray(deflections)
    slope, offset = np.polyfit(tensions, inverse, 1)
    return float(-offset / slope)


def checks(engine: str, results: dict[str, float]) -> list[Check]:
    """Judge the limit of infinite Reynolds number."""
    if not results:
        return []
    deflections = np.array([[results[f'{reynolds:g}, {tension:g}'] for tension in TENSIONS]
                            for reynolds in REYNOLDS])
    parameter = np.array(REYNOLDS)**TRIPLE_DECK
    exact = sail_divergence()
    bias = southwell(TENSIONS, [sail_deflection(tension)[0] for tension in TENSIONS]) - exact
    found = [Check(f'divergence, Re {reynolds:g}: C_T', engine, southwell(TENSIONS, row) - bias,
                   exact, SAIL)
             for reynolds, row in zip(REYNOLDS, deflections)]
    towards = [1.0 / limit(parameter, 1.0 / column) for column in deflections.T]
    found += [Check(f'sail of C_T {tension:g}, Re to infinity: y / (c alpha)', engine, value,
                    sail_deflection(tension)[0], SAIL)
              for tension, value in zip(TENSIONS, towards)]
    return found + [Check('divergence, Re to infinity: C_T', engine,
                          southwell(TENSIONS, towards) - bias, exact, SAIL, 0.10)]


def draw(figure, results: dict[str, dict[str, float]]) -> None:
    """Draw Southwell's plot."""
    axes = figure.subplots()
    tension = np.linspace(1.73, 4.0, 60)
    axes.plot(tension, [1.0 / sail_deflection(value)[0] for value in tension], 'k--', lw=1,
              label=SAIL)
    for engine, found in results.items():
        for reynolds in REYNOLDS:
            inverse = [1.0 / found[f'{reynolds:g}, {value:g}'] for value in TENSIONS]
            axes.plot(TENSIONS, inverse, 'o-', label=f'{engine}, Re = {reynolds:g}')
    axes.axhline(0.0, color='0.7', lw=1)
    axes.set(xlabel='T / (q c)', ylabel=r'c $\alpha$ / y')
    axes.legend()


STUDY = Study(
    'divergence', 'Divergence',
    'A flat membrane in ideal flow diverges below T / (q c) = 1.727. In a plot after Southwell '
    'the inverse deflection of a taut membrane falls almost linearly to zero there; what the '
    'straight line errs by in sail theory, -0.08, is taken off. Viscosity weakens the feedback of '
    'camber on lift, so the membrane diverges later. A parabola in Re^-3/8 leads to ideal flow.',
    runs, checks, draw)

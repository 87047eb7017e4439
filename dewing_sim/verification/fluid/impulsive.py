# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""An impulsive start against Wagner's function, in the trend towards ideal flow."""

import numpy as np

from dewing_sim.verification.closed_forms import TRIPLE_DECK, WAGNER, wagner
from dewing_sim.verification.fluid.rigid_flow import PlateResult, PlateRun
from dewing_sim.verification.signals import limit
from dewing_sim.verification.study import Check, Study

ALPHA = 1.0                         # deg, small enough for an attached flow
REYNOLDS = (1000.0, 2500.0, 5000.0)


def runs(engine: str, quick: bool) -> dict[str, PlateRun]:
    """Return impulsive starts at rising Reynolds numbers."""
    if quick:
        return {}
    return {f'{reynolds:g}': PlateRun(engine, 'standard', ALPHA, 6.0, reynolds=reynolds,
                                      dt=0.002, lift=0.0) for reynolds in REYNOLDS}


def _ratio(result: PlateResult, s: float) -> float:
    """Return Cl / 2 pi alpha at ``s`` semichords."""
    return float(np.interp(0.5 * s, result.time, result.cl) / (2.0 * np.pi * np.radians(ALPHA)))


def checks(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    """Judge the limit of infinite Reynolds number."""
    if not results:
        return []
    parameter = np.array(REYNOLDS)**TRIPLE_DECK
    return [Check(f'impulsive start, Re to infinity: Cl / 2 pi alpha after {s:g} semichords',
                  engine, limit(parameter, np.array([_ratio(results[f'{r:g}'], s)
                                                     for r in REYNOLDS])),
                  exact, "Wagner's function", 0.05) for s, exact in WAGNER.items()]


def draw(figure, results: dict[str, dict[str, PlateResult]]) -> None:
    """Draw the lift over the distance travelled."""
    axes = figure.subplots()
    s = np.linspace(0.2, 12.0, 200)
    axes.plot(s, wagner(s), 'k--', lw=1, label="Wagner's function")
    for found in results.values():
        for reynolds in REYNOLDS:
            result = found[f'{reynolds:g}']
            late = result.time > 0.1
            axes.plot(2.0 * result.time[late],
                      result.cl[late] / (2.0 * np.pi * np.radians(ALPHA)),
                      label=f'Re = {reynolds:g}')
        break
    axes.set(xlabel='semichords travelled', ylabel=r'Cl / 2 $\pi \alpha$', ylim=(0.0, 1.0))
    axes.legend()


STUDY = Study(
    'impulsive', 'Impulsive start',
    "A plate at 1 degree starts from rest without circulation. Wagner's function is the lift in "
    'ideal flow. The viscous trailing edge takes lift away in proportion to Re^-3/8 (Brown and '
    'Stewartson 1970), so a parabola in Re^-3/8 leads to the limit. Beyond Re = 5000 the wake of '
    'the thin plate rolls up within a chord.',
    runs, checks, draw)

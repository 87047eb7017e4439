# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid plates bent or turned by the moving grid."""

import numpy as np

from dewing_sim.fluid import engines
from dewing_sim.verification.closed_forms import TRIPLE_DECK
from dewing_sim.verification.fluid.rigid_flow import PlateResult, PlateRun
from dewing_sim.verification.signals import limit
from dewing_sim.verification.study import Check, Study

SMALL = 0.005                       # camber of the slope
REYNOLDS = {1000.0: 0.41, 2500.0: 0.52, 5000.0: 0.60}    # and the expected slopes over 4 pi
IDEAL = 'thin-aerofoil theory, 4 pi f'


def runs(engine: str, quick: bool) -> dict[str, PlateRun]:
    """Return turned plates, a slightly and a strongly cambered one."""
    chosen = {'turned 0': PlateRun(engine, 'standard', 4.0, 20.0)}
    if engines.find(engine).free_edges:
        chosen['turned 1'] = PlateRun(engine, 'standard', 3.0, 20.0, rotation=1.0)
        if not quick:
            chosen['turned -1'] = PlateRun(engine, 'standard', 5.0, 20.0, rotation=-1.0)
    if quick:
        return chosen
    chosen |= {
        'camber 2 %': PlateRun(engine, 'standard', 4.0, 20.0, camber=0.02),
        'camber 10 %': PlateRun(engine, 'standard', 4.0, 30.0, camber=0.10, dt=0.002, lift=0.9),
        'camber 10 %, fine': PlateRun(engine, 'fine', 4.0, 30.0, camber=0.10, dt=0.002,
                                      lift=0.9),
    }
    return chosen | {f'slope {reynolds:g}': PlateRun(
        engine, 'standard', 0.0, 20.0, reynolds=reynolds, camber=SMALL,
        lift=4.0 * np.pi * SMALL * slope) for reynolds, slope in REYNOLDS.items()}


def checks(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    """Judge invariance under rotation, the trend of the camber lift and strong camber."""
    found = _turned(engine, results) if 'turned 0' in results else []
    if 'camber 2 %' not in results:
        return found
    return [*found, *_slope(engine, results), *_strong(engine, results)]


def _turned(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    straight = results['turned 0']
    return [Check(f'plate at 4 deg, {name[7:]} deg of it by the map: {quantity.capitalize()}',
                  engine, getattr(result, quantity)[-1], getattr(straight, quantity)[-1],
                  'the same plate in a turned stream', gate)
            for name, result in results.items()
            if name.startswith('turned ') and result is not straight
            for quantity, gate in (('cl', 0.005), ('cd', 0.015))]


def _slope(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    slopes = np.array([results[f'slope {reynolds:g}'].cl[-1] / (4.0 * np.pi * SMALL)
                       for reynolds in REYNOLDS])
    found = [Check(f'camber lift at 0 deg over 4 pi f, Re {reynolds:g}', engine, slope, 1.0, IDEAL)
             for reynolds, slope in zip(REYNOLDS, slopes)]
    return found + [
        Check('camber lift at 0 deg over 4 pi f, Re to infinity', engine,
              limit(np.array(list(REYNOLDS))**TRIPLE_DECK, slopes), 1.0, IDEAL),
        Check('plate 4 deg, camber 2 %: Cl', engine, results['camber 2 %'].cl[-1], None,
              'reported'),
        Check('plate 4 deg, camber 2 %: Cd', engine, results['camber 2 %'].cd[-1], None,
              'reported')]


def _strong(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    ours, fine = results['camber 10 %'], results['camber 10 %, fine']
    return [Check(f'plate 4 deg, camber 10 %: mean {quantity.capitalize()}', engine,
                  getattr(ours, quantity)[ours.late].mean(),
                  getattr(fine, quantity)[fine.late].mean(), 'fine grid', 0.02)
            for quantity in ('cl', 'cd')]


STUDY = Study(
    'camber', 'Plates bent and turned by the grid',
    'A plate turned by the moving grid must feel the same stream as one that the stream meets at '
    'the same angle. The lift of a small camber is far below thin-aerofoil theory at Re = 2500, '
    'where the boundary layers and the wake straighten the flow, and approaches it as Re grows. '
    'A parabola of 10 % camber tests the grid far from flat.',
    runs, checks)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Chord and thickness, which the paper leaves open, against the facts that it states."""

import math

import numpy as np

from dewing_cli.paper.plan import Plan, Scan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table
from dewing_cli.paper.runs.quantities import average, peak, shedding

RISE = 0.10                 # of the camber
FACTS = {'Cl, 4 deg': 0.396, 'y*, 4 deg': 0.33, 'x/c, 4 deg': 0.40, 'mean Cl, 8 deg': 0.83,
         'mean y*, 8 deg': 0.85, 'x/c, 8 deg': 0.31, 'shedding [Hz]': 26.0}
TOLERANCES = {'Cl, 4 deg': 0.02, 'y*, 4 deg': 0.05, 'x/c, 4 deg': 0.05, 'mean Cl, 8 deg': 0.02,
              'mean y*, 8 deg': 0.05, 'x/c, 8 deg': 0.05, 'shedding [Hz]': 0.05}


def section(plan: Plan, found: Found) -> Section:
    """Return every choice beside the paper's facts; those met are marked."""
    measured = {scan: _measure(found, scan) for scan in plan.scans
                if scan.rest in found and scan.shed in found}
    rows = [('paper', *(f'{value:g}' for value in FACTS.values()), '-')]
    for scan, values in measured.items():
        rows.append((scan.label, *(_marked(name, values[name]) for name in FACTS),
                     f'{values["voltage"]:.0f}'))
    made = Section('scans', 'Chord and thickness scans', _text(measured), [_figure(measured)], [
        Table('Chord and initial thickness against the facts of the paper; * marks those met', (
            'chord, thickness', *FACTS, 'V for +10 % camber'), rows)])
    made.series['scans'] = {
        'chord [m]': np.array([scan.chord for scan in measured]),
        'thickness [m]': np.array([scan.thickness for scan in measured]),
        **{name: np.array([values[name] for values in measured.values()])
           for name in (*FACTS, 'voltage')}}
    return made


def _measure(found: Found, scan: Scan) -> dict[str, float]:
    rest, shed = found[scan.rest], found[scan.shed]
    low, high = peak(rest), peak(shed)
    return {'Cl, 4 deg': average(rest, 'cl').value, 'y*, 4 deg': low.height.value,
            'x/c, 4 deg': low.place.value, 'mean Cl, 8 deg': average(shed, 'cl').value,
            'mean y*, 8 deg': high.height.value, 'x/c, 8 deg': high.place.value,
            'shedding [Hz]': shedding(shed),
            'voltage': rest.values['v_slack'] * math.sqrt(RISE / (1.0 + RISE))}


def _marked(name: str, value: float) -> str:
    return f'{value:.4g}{" *" if _near(name, value) else ""}'


def _near(name: str, value: float) -> bool:
    return math.isclose(value, FACTS[name], rel_tol=TOLERANCES[name])


def _text(measured: dict[Scan, dict[str, float]]) -> list[str]:
    lifts = [values['mean Cl, 8 deg'] for values in measured.values()]
    places = [values['x/c, 8 deg'] for values in measured.values()]
    return [
        'The paper gives no chord. At a fixed Reynolds number q c² is fixed, so that y_ref and '
        'all statics at 4 degrees do not depend on it, while every frequency falls as 1/c². '
        '0.05 mm is the printed thickness; 5 kV, of which the authors write elsewhere, would '
        'need 0.5 mm. The last column is a closed form, V_L sqrt(0.1/1.1).',
        'All of these runs are on the coarse grid of the conformal engine, with the same time '
        'step in c/U, so that differences between them are those of the choice.',
        f'The mean lift at 8 degrees lies between {min(lifts):.3f} and {max(lifts):.3f} and the '
        f'maximum between x/c = {min(places):.2f} and {max(places):.2f}, whatever the choice. '
        + _met(measured)]


def _met(measured: dict[Scan, dict[str, float]]) -> str:
    """Say which facts no choice meets, and which chords have the shedding frequency."""
    never = [name for name in FACTS if not any(_near(name, values[name])
                                               for values in measured.values())]
    chords = sorted({f'{1.0e3 * scan.chord:g}' for scan, values in measured.items()
                     if _near('shedding [Hz]', values['shedding [Hz]'])})
    sentence = f'Met by no choice: {"; ".join(never)}. ' if never else ''
    return sentence + (f'The shedding frequency asks for a chord of {", ".join(chords)} mm.'
                       if chords else 'No chord has the shedding frequency.')


def _figure(measured: dict[Scan, dict[str, float]]) -> Figure:
    names = ('mean Cl, 8 deg', 'mean y*, 8 deg', 'x/c, 8 deg', 'shedding [Hz]')
    figure, axes = drawing.axes(2, 2, 2.3)
    thin = min(scan.thickness for scan in measured)
    for axis, name in zip(axes.flat, names):
        for scan, values in measured.items():
            printed = scan.thickness == thin
            axis.plot(1.0e3 * scan.chord, values[name], 'o' if printed else 's', ms=6,
                      color=drawing.BLUE if printed else drawing.ORANGE)
        axis.axhline(FACTS[name], color=drawing.BLACK, lw=0.9, ls='--')
        axis.set(ylabel=name)
    for axis in axes[1]:
        axis.set_xlabel('chord [mm]')
    return Figure('scans', 'Four facts of the paper at 8 degrees (dashed) against the chord. Blue '
                  'circles: 0.05 mm; orange square: 0.5 mm.', drawing.png(figure))

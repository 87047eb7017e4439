# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid flat plates at 0, 4 and 8 degrees, the flow solver's basic test."""

from functools import cache
from pathlib import Path

import numpy as np

from dewing_sim.verification.closed_forms import plate_drag
from dewing_sim.verification.fluid.rigid_flow import PlateResult, PlateRun
from dewing_sim.verification.signals import harmonics, whole_periods
from dewing_sim.verification.study import Check, Study

REFERENCE = Path(__file__).parents[3] / 'test/reference/flat_plate_re2500_alpha4_dcp.csv'
THEORY = 'Blasius and triple deck, 2.656 Re^-1/2 + 5.34 Re^-7/8'
HDG = 'NGSolve, HDG of order 3'
BEST = 'NGSolve at 50 c and 100 c, OpenFOAM'


def runs(engine: str, quick: bool) -> dict[str, PlateRun]:
    """Return the plates; the quick suite averages over fewer shedding periods."""
    chosen = {
        '0 deg': PlateRun(engine, 'standard', 0.0, 8.0 if quick else 16.0),
        '4 deg': PlateRun(engine, 'standard', 4.0, 20.0 if quick else 40.0),
        '8 deg': PlateRun(engine, 'standard', 8.0, 30.0 if quick else 80.0),
    }
    if not quick:
        chosen['0 deg, Re 1000'] = PlateRun(engine, 'standard', 0.0, 16.0, reynolds=1000.0)
    return chosen


def checks(engine: str, results: dict[str, PlateResult]) -> list[Check]:
    """Judge drag, lift, pressure and shedding."""
    found = [Check(f'plate {name}: Cd', engine, result.cd[-1], plate_drag(reynolds), THEORY, 0.01)
             for name, reynolds in (('0 deg', 2500.0), ('0 deg, Re 1000', 1000.0))
             if (result := results.get(name))]
    return found + _attached(engine, results['4 deg']) + _shedding(engine, results['8 deg'])


def _attached(engine: str, result: PlateResult) -> list[Check]:
    found = [
        Check('plate 4 deg: Cl', engine, result.cl[-1], 0.3933, BEST, 0.005),
        Check('plate 4 deg: Cd', engine, result.cd[-1], 0.0636, BEST, 0.015),
        Check('plate 4 deg: centre of pressure x/c', engine, result.centre_of_pressure, 0.255,
              HDG, 0.005, 1.0),
    ]
    if result.reattachment is not None:
        found.append(Check('plate 4 deg: reattachment x/c', engine, result.reattachment, 0.20,
                           HDG, 0.02, 1.0))
    if REFERENCE.is_file():
        found.append(Check('plate 4 deg: pressure jump, L1 distance over Cl', engine,
                           pressure_distance(result) / result.cl[-1], 0.0, HDG, 0.02, 1.0))
    return found


def _shedding(engine: str, result: PlateResult) -> list[Check]:
    lines = harmonics(result.cl[result.late], result.dt)
    cl, cd = (whole_periods(signal[result.late], result.dt, lines.frequency)
              for signal in (result.cl, result.cd))
    power = (lines.amplitude / lines.amplitude[0])**2
    return [
        Check('plate 8 deg: mean Cl', engine, cl.mean(), 0.94, f'{HDG}, +- 0.01', 0.02),
        Check('plate 8 deg: rms of Cl', engine, cl.std(), 0.134, HDG, 0.05),
        Check('plate 8 deg: mean Cd', engine, cd.mean(), 0.155, HDG, 0.015),
        Check('plate 8 deg: Strouhal number', engine, lines.frequency, 0.683, HDG, 0.01),
        Check('plate 8 deg: power of Cl at 2 St over St', engine, power[1], 0.27, HDG, 0.10),
        Check('plate 8 deg: power of Cl at 3 St over St', engine, power[2], 0.04, HDG, 0.25),
    ]


@cache
def _reference() -> np.ndarray:
    """Return x and dcp of the reference (2, points)."""
    return np.loadtxt(REFERENCE, delimiter=',', skiprows=4, usecols=(0, 3)).T


def pressure_distance(result: PlateResult) -> float:
    """Return the integral over the chord of |dcp - reference|, both averaged over columns.

    Between its points dcp sqrt(x) of the reference is linear in sqrt(x), which honours the
    square-root singularity at the leading edge.
    """
    x, dcp = _reference()
    r = np.linspace(0.0, 1.0, 40_001)                       # sqrt(x)
    density = 2.0 * np.interp(r, np.sqrt(x), dcp * np.sqrt(x))      # dcp dx = density dr
    integral = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * r[1])))
    reference = np.diff(np.interp(np.sqrt(result.columns), r, integral))
    return float(np.abs(result.dcp * np.diff(result.columns) - reference).sum())


def draw(figure, results: dict[str, dict[str, PlateResult]]) -> None:
    """Draw the pressure jump at 4 degrees and the lift at 8 degrees."""
    pressure, lift = figure.subplots(1, 2)
    for engine, found in results.items():
        result = found['4 deg']
        centres = 0.5 * (result.columns[1:] + result.columns[:-1])
        pressure.semilogx(centres, result.dcp, label=engine)
        shedding = found['8 deg']
        late = shedding.time > shedding.time[-1] - 8.0
        lift.plot(shedding.time[late], shedding.cl[late], label=engine)
    if REFERENCE.is_file():
        pressure.semilogx(*_reference(), 'k--', lw=1, label=HDG)
    pressure.set(xlabel='x/c', ylabel='pressure jump / q', xlim=(1.0e-4, 1.0), title='4 deg')
    lift.set(xlabel='t U / c', ylabel='Cl', title='8 deg')
    pressure.legend()


STUDY = Study(
    'rigid_plate', 'Rigid flat plates at Re = 2500',
    'Along the stream the drag has a closed form. At 4 degrees the flow separates at the leading '
    'edge, reattaches near x/c = 0.2 and is steady; at 8 degrees it sheds vortices. References '
    'are converged solutions of an independent discontinuous-Galerkin code. Power ratios are of '
    'the squared amplitudes of the harmonics of Cl.',
    runs, checks, draw)

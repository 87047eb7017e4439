# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Beyond the paper: V² on the self-excited wing at 8 degrees."""

from typing import Any

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table
from dewing_cli.paper.runs.quantities import average, shedding
from dewing_cli.paper.runs.result import Result
from dewing_sim.verification.signals import block_mean

CAUGHT = 0.05               # of the target


def section(plan: Plan, found: Found) -> Section:
    """Return what steady, swinging and fed back V² do to lift and oscillation."""
    passive = found['shed']
    rows = [_described('passive', passive, passive)]
    for share in plan.extent.shares:
        rows.append(_described(f'steady, {share:g} V_L', found[f'alpha8/steady {share:g}'],
                               passive))
    for ratio in plan.extent.swings:
        rows.append(_described(f'swing of 100 % at {ratio:g} x shedding',
                               found[f'alpha8/swing {ratio:g}'], passive))
    for target in plan.extent.held:
        rows.append(_held(f'camber held at {target:g}', found[f'alpha8/held {target:g}'],
                          passive))
    made = Section('alpha8', 'The self-excited wing at 8 degrees under V²', _text(rows),
                   values={row['label']: {name: value for name, value in row.items()
                                          if name != 'label'} for row in rows})
    made.tables.append(Table('After a fifth of each run (camber in units of its passive mean)', (
        'V²', 'rms V', 'mean Cl', 'rms of Cl', 'mean Cl / Cd', 'mean camber', 'rms of camber',
        'shedding [Hz]'), [_cells(row) for row in rows]))
    made.figures.append(_figure(plan, found, made))
    return made


def _described(label: str, flight: Result, passive: Result) -> dict[str, Any]:
    late = slice(len(flight['time']) // 5, None)
    camber = flight['camber_mean'][late] / passive['camber_mean'].mean()
    cl = average(Result({}, {'cl': flight['cl'][late]}), 'cl')
    return {'label': label, 'v_rms': float(np.sqrt(flight['v_squared'][late].mean())),
            'cl': cl.value, 'cl_error': cl.error, 'cl_rms': float(flight['cl'][late].std()),
            'glide': cl.value / float(flight['cd'][late].mean()),
            'camber': float(camber.mean()), 'camber_rms': float(camber.std()),
            'line': shedding(flight)}


def _held(label: str, loop: Result, passive: Result) -> dict[str, Any]:
    late = loop['time'] > loop['time'][-1] - loop.values['averaged']
    cl = block_mean(loop['cl'][late])
    shown = Result({'sample': loop.values['dt'],
                    'convective_time': passive.values['convective_time']},
                   {'cl': loop['cl'][late]})
    return {'label': label, 'v_rms': loop.values['v_rms'], 'cl': cl.value, 'cl_error': cl.error,
            'cl_rms': float(loop['cl'][late].std()),
            'glide': cl.value / float(loop['cd'][late].mean()),
            'camber': float(loop['camber'][late].mean()),
            'camber_rms': float(loop['camber'][late].std()),
            'line': shedding(shown),
            'saturation': loop.values['saturation_share']}


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    return (row['label'], f'{row["v_rms"]:.0f}', f'{row["cl"]:.4f} ± {row["cl_error"]:.1g}',
            f'{row["cl_rms"]:.4f}', f'{row["glide"]:.3f}', f'{row["camber"]:.3f}',
            f'{row["camber_rms"]:.4f}', f'{row["line"]:.1f}')


def _text(rows: list[dict[str, Any]]) -> list[str]:
    passive, held = rows[0], rows[-1]
    most = max(rows, key=lambda row: row['cl'])
    best = max(rows, key=lambda row: row['glide'])
    least = min(rows, key=lambda row: row['cl'])
    return [
        'Can V² suppress the self-excited oscillation? That of the membrane, yes: held at '
        f'{held["camber"]:.2f} of the passive mean, the camber swings by '
        f'{100.0 * held["camber_rms"] / held["camber"]:.2f} % rms in place of '
        f'{100.0 * passive["camber_rms"] / passive["camber"]:.0f} %. That of the lift, only in '
        f'part: its rms goes from {passive["cl_rms"]:.3f} to {held["cl_rms"]:.3f}, and the '
        f'shedding from {passive["line"]:.1f} to {held["line"]:.1f} Hz. Both move towards the '
        'rigid plate (0.13 and 27.8 Hz): a membrane that stands still sheds like a plate, and '
        'what V² takes away is the resonance of the membrane with the third harmonic, to which '
        'the shedding of the passive wing is drawn. A camber below the peaks of the passive one '
        'cannot be held, because V² is never negative.',
        f'Can it exploit the oscillation? The largest mean lift is {most["cl"]:.3f} '
        f'± {most["cl_error"]:.1g} ({most["label"]}), '
        f'{100.0 * (most["cl"] / passive["cl"] - 1.0):+.1f} % against the passive wing '
        f'({passive["cl"]:.3f} ± {passive["cl_error"]:.1g}), the smallest {least["cl"]:.3f} '
        f'± {least["cl_error"]:.1g} ({least["label"]}); the largest Cl/Cd is '
        f'{best["glide"]:.2f} ({best["label"]}), {passive["glide"]:.2f} passive. Changes of a few '
        'percent are no larger than the step between shedding with and without doubled period '
        '(see the grid study), and prove little.']


def _figure(plan: Plan, found: Found, made: Section) -> Figure:
    target = plan.extent.held[-1]
    held = found[f'alpha8/held {target:g}']
    passive = found['shed']
    figure, axes = drawing.axes(3, 1, 1.8, sharex=True)
    shown = held['time'][-1]
    early = passive['time'] <= shown
    camber = passive['camber_mean'][early] / passive['camber_mean'].mean()
    for axis, open_loop, closed in (
            (axes[0, 0], camber, held['camber']), (axes[1, 0], passive['cl'][early], held['cl']),
            (axes[2, 0], np.sqrt(passive['v_squared'][early]), np.sqrt(held['v_squared']))):
        axis.plot(1.0e3 * passive['time'][early], open_loop, color=drawing.BLUE, lw=0.9,
                  label='passive')
        axis.plot(1.0e3 * held['time'], closed, color=drawing.ORANGE, lw=0.9,
                  label=f'camber held at {target:g}')
    for axis, label in zip(axes[:, 0], ('camber / passive mean', 'Cl', 'V [V]')):
        axis.set_ylabel(label)
    drawing.legend(figure, axes[0, 0])
    axes[2, 0].set_xlabel('t [ms]')
    made.series['alpha8_held'] = {
        't [s]': held['time'], 'camber [passive mean]': held['camber'], 'Cl': held['cl'],
        'Cd': held['cd'], 'V [V]': np.sqrt(held['v_squared'])}
    error = np.abs(held['camber'] - target) > CAUGHT * target
    caught = held['time'][np.flatnonzero(error)[-1]] if error.any() else 0.0
    return Figure('alpha8', 'The wing at 8 degrees, passive and with its mean camber held by the '
                  'PID: the membrane stands still, the lift does not. From '
                  f'{1.0e3 * caught:.0f} ms on the camber stays within {100.0 * CAUGHT:g} % of '
                  'the target.', drawing.png(figure))

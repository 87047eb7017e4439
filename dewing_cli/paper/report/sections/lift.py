# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 3a: lift at 8 degrees in time, and its lines."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Row, Section, Table
from dewing_cli.paper.runs.quantities import FIRST_MODE, average, lines, shedding
from dewing_sim.records import spectrum

SHOWN = 0.3                 # s
HIGHEST = 150.0             # Hz
PRINTED = (26.0, 51.0)
WHY = ('The chord is ours: 30 mm. At this Reynolds number frequencies scale as 1/c², so a chord '
       'of {chord:.1f} mm would meet this line exactly.')


def section(plan: Plan, found: Found) -> Section:
    """Return history and spectrum of the lift."""
    made = Section('lift', 'Lift at 8 degrees in time (Fig. 3a)')
    figure, axes = drawing.axes(1, 2, 3.1, width_ratios=(1.5, 1.0))
    history, power = axes[0]
    rows = []
    for run, style, colour in (('shed', '-', drawing.BLUE), ('shed other', '--', drawing.ORANGE)):
        if run not in found:
            continue
        flight = found[run]
        engine = flight.values['engine'].replace('_', '-')
        time, cl = flight['time'], flight['cl']
        late = time > time[-1] - SHOWN
        history.plot(1.0e3 * (time[late] - time[late][0]), cl[late], style, color=colour,
                     label=engine, lw=1.1)
        frequency, strength = spectrum.power_spectrum(cl, flight.values['sample'])
        low = (frequency > 2.0) & (frequency < HIGHEST)
        power.semilogy(frequency[low], strength[low], style, color=colour, lw=1.0)
        made.series[f'lift_{engine}'] = {
            't [s]': time, 'Cl': cl, 'Cd': flight['cd'],
            'camber_mean [m]': flight['camber_mean'], 'camber_max [m]': flight['camber_max']}
        made.series[f'lift_spectrum_{engine}'] = {'f [Hz]': frequency[low],
                                                  'power of Cl': strength[low]}
        rows.append(_row(engine, flight))
    for line in PRINTED:
        power.axvline(line, color='0.5', lw=0.8, ls=':')
    power.set(xlabel='f [Hz]', ylabel='power of Cl', xlim=(0.0, HIGHEST), ylim=(1.0e-9, 1.0e-1))
    history.set(xlabel='t [ms]', ylabel='Cl')
    drawing.legend(figure, history)
    made.figures.append(Figure('lift', 'Lift of the last part of the record, and its spectrum; '
                               'dotted: 26 and 51 Hz as printed.', drawing.png(figure)))
    made.tables.append(Table('Lift and its lines', (
        'engine', 'mean Cl', 'rms of Cl', 'mean Cd', 'lines of Cl [Hz], strongest first',
        'lines of the mean camber [Hz]'), rows))
    made.rows = _line_rows(found)
    made.text = [_text(found)]
    return made


def _text(found: Found) -> str:
    flight = found['shed']
    listed = ', '.join(f'{line:.1f}' for line in sorted(lines(flight)))
    return ('The wing is not disturbed: it oscillates by itself, with the vortices that leave the '
            f'leading edge. Lines of the lift above a thousandth of the strongest: {listed} Hz. '
            f'The strongest is at {lines(flight, most=1)[0]:.1f} Hz. The first frequency of the '
            f'membrane in still air is {FIRST_MODE} Hz, close to three times the shedding '
            f'frequency of {shedding(flight):.1f} Hz, so the third harmonic of the shedding is '
            'amplified.')


def _row(engine: str, flight) -> tuple[str, ...]:
    cl, cd = average(flight, 'cl'), average(flight, 'cd')
    return (engine, f'{cl.value:.4f} ± {cl.error:.1g}', f'{flight["cl"].std():.4f}',
            f'{cd.value:.4f} ± {cd.error:.1g}',
            ', '.join(f'{line:.1f}' for line in lines(flight)),
            ', '.join(f'{line:.1f}' for line in lines(flight, 'camber_mean')))


def _line_rows(found: Found) -> list[Row]:
    flight = found['shed']
    measured, fundamental = np.array(lines(flight)), shedding(flight)
    if not fundamental:
        return []
    resolution = 0.5 / (len(flight['time']) * flight.values['sample'])
    rows = []
    for number, printed in enumerate(PRINTED, 1):
        near = measured[np.argmin(np.abs(measured - number * fundamental))]
        chord = 1.0e3 * flight.values['chord'] * np.sqrt(near / printed)
        label = 'shedding frequency' if number == 1 else 'its first harmonic'
        rows.append(Row(f'8 deg: {label}', printed, float(near), 'Hz', resolution, None,
                        WHY.format(chord=chord)))
    return rows

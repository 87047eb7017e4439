# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 2: mean shapes of the membrane at 4 and 8 degrees."""

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Row, Section
from dewing_cli.paper.report.sections.resolution import spread
from dewing_cli.paper.runs.quantities import STATIONS, average, peak, shapes

PRINTED = {4: (0.396, 0.33, 0.40), 8: (0.83, 0.85, 0.31)}
WHY_LIFT = ('Met by neither engine, on no grid, with no time step, chord or thickness (see the '
            'scans). A rigid plate alone has 0.92 to 0.94 in three independent codes.')
WHY_HEIGHT = ('Follows the lift: y* over Cl is {ratio:.2f} here, {printed:.2f} in the paper.')
WHY_PLACE = ('The paper says that the maximum moves downstream, but prints 0.40 and then 0.31, '
             'upstream. Both engines move it downstream, as its text says.')


def section(plan: Plan, found: Found) -> Section:
    """Return the mean shapes and the rows of the static and the shedding wing."""
    made = Section('shapes', 'Mean shapes (Fig. 2)')
    figure, ((axis,),) = drawing.axes(1, 1, 3.9)
    columns = {'x/c': STATIONS}
    for degrees, colour in ((4, drawing.BLUE), (8, drawing.ORANGE)):
        name = 'rest' if degrees == 4 else 'shed'
        made.rows += _rows(plan, found, degrees, name)
        for run, style in ((name, '-'), (f'{name} other', '--')):
            if run in found:
                engine = found[run].values['engine'].replace('_', '-')
                drawn = shapes(found[run])
                mean, swing = drawn.mean(axis=0), drawn.std(axis=0)
                axis.plot(STATIONS, mean, style, color=colour, label=f'{degrees} deg, {engine}')
                columns |= {f'y* {degrees} deg {engine}': mean,
                            f'rms of y* {degrees} deg {engine}': swing}
                if run == 'shed':
                    axis.fill_between(STATIONS, mean - swing, mean + swing, color=colour,
                                      alpha=0.15, lw=0.0, label='8 deg, mean ± rms')
        _, height, place = PRINTED[degrees]
        axis.plot(place, height, 'x', color=colour, ms=8, mew=2, label=f'{degrees} deg, paper')
    axis.set(xlabel='x/c', ylabel='y* = 8 T0 y / (q c²)', xlim=(0.0, 1.0))
    drawing.legend(figure, axis)
    made.figures.append(Figure('shapes', 'Mean deflection in units of that of a string under the '
                               'dynamic pressure. Crosses: the maxima printed in the paper. Band: '
                               'root mean square of the oscillation.', drawing.png(figure)))
    made.series['mean_shapes'] = columns
    made.text = [_text(found)]
    return made


def _text(found: Found) -> str:
    flight = found['rest']
    return (f'Deflections are divided by y_ref = q c²/(8 T0) = '
            f'{1.0e6 * flight.values["y_ref"]:.1f} µm, which depends on the Reynolds number '
            'and on the prestretched elastomer, but not on the chord. At 4 degrees the wing '
            'rests; at 8 degrees it oscillates by itself and the shapes are means in time.')


def _rows(plan: Plan, found: Found, degrees: int, name: str) -> list[Row]:
    flight = found[name]
    high, lift = peak(flight), average(flight, 'cl')
    printed = PRINTED[degrees]
    why = ('', '', '')
    if degrees == 8:
        why = (WHY_LIFT, WHY_HEIGHT.format(ratio=high.height.value / lift.value,
                                           printed=printed[1] / printed[0]), WHY_PLACE)
    mean = 'mean ' if degrees == 8 else ''
    values = ((f'{mean}Cl', 'cl', lift), (f'largest {mean}y*', 'y_star', high.height),
              (f'x/c of the largest {mean}y*', 'place', high.place))
    return [Row(f'{degrees} deg: {label}', paper, value.value, '', value.error,
                spread(plan, found, float(degrees), key), reason)
            for (label, key, value), paper, reason in zip(values, printed, why)]

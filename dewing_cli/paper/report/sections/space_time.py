# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 3c: displacement of the membrane in space and time."""

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section
from dewing_cli.paper.runs.quantities import STATIONS, shapes

SHOWN = 0.2                 # s


def section(plan: Plan, found: Found) -> Section:
    """Return the map of y* at 8 degrees, and of its deviation from the mean."""
    flight = found['shed']
    time, drawn = flight['shape_time'], shapes(flight)
    late = time > time[-1] - SHOWN
    milliseconds = 1.0e3 * (time[late] - time[late][0])
    figure, axes = drawing.axes(1, 2, 3.4, sharey=True)
    whole, deviation = drawn[late], drawn[late] - drawn.mean(axis=0)
    bound = abs(deviation).max()
    for axis, values, settings, label in (
            (axes[0, 0], whole, {'cmap': 'cividis'}, 'y*'),
            (axes[0, 1], deviation, {'cmap': 'RdBu_r', 'vmin': -bound, 'vmax': bound},
             'y* less its mean')):
        mesh = axis.pcolormesh(STATIONS, milliseconds, values, shading='gouraud',
                               rasterized=True, **settings)
        figure.colorbar(mesh, label=label)
        axis.set(xlabel='x/c')
        axis.grid(False)
    axes[0, 0].set_ylabel('t [ms]')
    columns = {'t [s]': time, **{f'y* at x/c = {STATIONS[k]:.2f}': drawn[:, k]
                                 for k in range(0, len(STATIONS), 5)}}
    return Section(
        'space_time', 'Displacement in space and time (Fig. 3c)',
        ['Level stripes are standing waves, leaning ones would travel along the membrane. The '
         'motion is a standing half wave, whose centre shifts a little as a vortex passes above: '
         'the share of the second and third mode.'],
        [Figure('space_time', 'Displacement of the membrane at 8 degrees, whole (left) and '
                'without the mean shape (right).', drawing.png(figure))],
        series={'displacement': columns})

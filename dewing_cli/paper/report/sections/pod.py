# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 3b: proper orthogonal modes of the oscillating membrane, and their energies."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table
from dewing_cli.paper.runs.quantities import STATIONS, modes, shapes
from dewing_sim.records import spectrum

SHOWN = 4


def section(plan: Plan, found: Found) -> Section:
    """Return the modes of the main engine's flight at 8 degrees."""
    flight = found['shed']
    drawn = modes(shapes(flight))
    interval = flight['shape_time'][1] - flight['shape_time'][0]
    figure, axes = drawing.axes(1, 2, 3.2, width_ratios=(1.4, 1.0))
    forms, energies = axes[0]
    rows, columns = [], {'x/c': STATIONS}
    for number in range(min(SHOWN, len(drawn.energy))):
        share = 100.0 * drawn.energy[number]
        forms.plot(STATIONS, drawn.shape[number], drawing.STYLES[number],
                   color=drawing.COLOURS[number], label=f'mode {number + 1}, {share:.3g} %')
        columns[f'mode {number + 1}'] = drawn.shape[number]
        found_lines = spectrum.peaks(drawn.amplitude[:, number], interval, 3)
        rows.append((str(number + 1), f'{share:.4g} %',
                     f'{drawn.amplitude[:, number].std():.4g}',
                     ', '.join(f'{line:.1f}' for line in found_lines)))
    numbers = np.arange(1, min(10, len(drawn.energy)) + 1)
    energies.semilogy(numbers, 100.0 * drawn.energy[:len(numbers)], 'o-', color=drawing.BLUE)
    forms.set(xlabel='x/c', ylabel='mode, norm 1 over the chord', xlim=(0.0, 1.0))
    energies.set(xlabel='mode', ylabel='energy [%]')
    drawing.legend(figure, forms)
    first = 100.0 * drawn.energy[0]
    return Section(
        'pod', 'Modes of the oscillation (Fig. 3b)',
        ['The fluctuating shape y*(x, t) less its mean is decomposed into orthonormal modes over '
         f'the chord. The first, a half wave, carries {first:.1f} % of the energy. It moves '
         'camber, on which V² acts; the second moves the place of the maximum.'],
        [Figure('pod', 'Modes of the membrane at 8 degrees, and their energies.',
                drawing.png(figure))],
        [Table('Modes', ('mode', 'energy', 'rms amplitude [y*]', 'lines [Hz]'), rows)],
        series={'pod_modes': columns, 'pod_energies': {
            'mode': numbers, 'energy [%]': 100.0 * drawn.energy[:len(numbers)]},
            'pod_amplitudes': {'t [s]': flight['shape_time'], **{
                f'mode {k + 1} [y*]': drawn.amplitude[:, k]
                for k in range(min(SHOWN, len(drawn.energy)))}}},
        values={'energies': drawn.energy[:10].tolist()})

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Beyond the paper: the long-term response of the closed loop."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table

PERIOD = 0.1                # s, of the disturbance


def section(plan: Plan, found: Found) -> Section:
    """Return mean and amplitude of every period of a long run."""
    result = found['long/pid_tuned']
    length = round(PERIOD / result.values['dt'])
    periods = len(result['camber']) // length
    camber = result['camber'][:periods * length].reshape(periods, length)
    mean, amplitude = camber.mean(axis=1), 0.5 * np.ptp(camber, axis=1)
    figure, axes = drawing.axes(1, 2, 2.6)
    number = np.arange(1, periods + 1)
    axes[0, 0].semilogy(number, 100.0 * np.maximum(np.abs(mean - result.values['target']), 1.0e-9),
                        'o-', color=drawing.BLUE)
    axes[0, 1].semilogy(number, 100.0 * amplitude, 'o-', color=drawing.ORANGE)
    axes[0, 0].set(xlabel='period of 0.1 s', ylabel='|mean less target| [% of passive]')
    axes[0, 1].set(xlabel='period of 0.1 s', ylabel='amplitude [% of passive]')
    settled = slice(2, None)
    drift = 100.0 * float(np.ptp(mean[settled])) if periods > 3 else 0.0
    rows = [(str(k), f'{m:.6f}', f'{100.0 * a:.4f} %') for k, m, a in zip(number, mean, amplitude)
            if k in (1, 2, 3, 5, 10, 20, periods)]
    return Section(
        'long_run', 'Long-term response in closed loop',
        [f'Fig. 5 continued for {plan.extent.long:g} s, {periods} periods of the disturbance. '
         f'After the second period the mean stays within {drift:.1g} % of the passive camber: '
         'there is no drift, and nothing winds up.'],
        [Figure('long_run', 'Mean and amplitude of the camber, period by period.',
                drawing.png(figure))],
        [Table('Periods', ('period', 'mean camber', 'amplitude'), rows)],
        series={'long_run': {'t [s]': result['time'], 'camber [passive]': result['camber'],
                             'V [V]': np.sqrt(result['v_squared'])}},
        values={'drift_percent': drift})

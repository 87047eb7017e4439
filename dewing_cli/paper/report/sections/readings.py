# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What the paper's text leaves open: readings of the disturbance and of the gains."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Row, Section, Table
from dewing_cli.paper.report.sections.fig5 import percent
from dewing_control.tuning.bounds import Bounds


def section(plan: Plan, found: Found) -> Section:
    """Return both readings of the disturbance, and those of gains and error."""
    made = Section('readings', 'Readings that the text leaves open', [
        'Disturbance. Eq. 11 has P (1 - cos 2 pi f t) with P = 3 % of q. Taken literally the peak '
        'is 6 %, and the open loop swings by twice what Fig. 5 shows; read as the peak, it '
        'fits. Both are kept as --disturbance printed and fig5.',
        'Gains. Ki = 2.3e15 V²/s, Kp = 4.0e11 V² and Kd = 7.5e5 V² s cannot act on an error in '
        'the lift coefficient: 10 % of Cl = 0.396 times Kp is 1.6e10 V², ten thousand times V_L². '
        'They have the size of V² per metre of camber, and were tried so on model and wing.',
        _error_signal(found)])
    mean, amplitude = percent(found['printed/open_loop'])
    made.rows = [
        Row('Disturbance as printed (P = 3 % of q): mean of the camber', -5.0, mean, '%', None,
            None, 'twice Fig. 5: the printed 3 % is the peak, not P'),
        Row('Disturbance as printed (P = 3 % of q): amplitude', 5.0, amplitude, '%', None, None,
            'the same'), _gain_row(found)]
    made.tables = [_disturbances(found), _gains(found)]
    made.figures.append(_figure(found, made))
    return made


def _error_signal(found: Found) -> str:
    mean, largest = found['fig5/pid_tuned'], found['largest/pid_tuned']
    outcome = (f'ends the run after {1.0e3 * largest["time"][-1]:.0f} ms'
               if largest.values['failure'] else f'leaves ± {percent(largest)[1]:.2g} %')
    return ('Error signal. The maximum camber is not collocated with V², and its place moves: '
            f'with the gains that leave ± {percent(mean)[1]:.2g} % of the mean camber, feeding '
            f'the maximum back {outcome}.')


def _gain_row(found: Found) -> Row:
    report = found['design'].values['judged']['as_printed']
    failure = found['gains/as_printed'].values['failure']
    time = found['gains/as_printed']['time'][-1]
    outcome = f'on the wing the run ends after {1.0e3 * time:.0f} ms' if failure else (
        'on the wing V² swings between its bounds')
    return Row('Printed PID gains: spectral radius of the closed loop (stable below 1)', None,
               report.get('spectral_radius', 1.0), '', None, None,
               f'no reading of the units stabilises the loop as printed; {outcome}')


def _disturbances(found: Found) -> Table:
    rows = []
    for name, label in (('fig5/open_loop', '3 % is the peak, open loop'),
                        ('printed/open_loop', '3 % is P, open loop'),
                        ('fig5/pid_tuned', '3 % is the peak, PID on the mean camber'),
                        ('printed/pid_tuned', '3 % is P, PID on the mean camber'),
                        ('largest/pid_tuned', '3 % is the peak, PID on the maximum camber')):
        mean, amplitude = percent(found[name])
        values = found[name].values
        rows.append((label, f'{mean:+.3f} %', f'{amplitude:.3f} %', f'{values["v_max"]:.0f}',
                     values['failure'] or '-'))
    return Table('Mean camber under each reading, of the passive one', (
        'reading', 'mean', 'amplitude', 'largest V', 'failure'), rows)


def _gains(found: Found) -> Table:
    rows = []
    for name, label in (('as_printed', 'as printed'), ('kd_times_3000', 'Kd times 3000')):
        report = found['design'].values['judged'][name]
        result = found[f'gains/{name}']
        mean, amplitude = percent(result)
        verdict = (f'unstable, spectral radius {report["spectral_radius"]:.3f}'
                   if not report['stable'] and not report['stable_at_rest'] else
                   f'stable, Ms {report["ms_at_rest"]:.1f} at rest, {report["ms_peak"]:.0f} at '
                   f'{Bounds.tension:g} tension' if report['stable'] else 'stable at rest only')
        failure = result.values['failure']
        rows.append((label, verdict, f'{1.0e3 * result["time"][-1]:.0f}', f'{mean:+.2f} %',
                     f'{amplitude:.2f} %', failure.partition(':')[0] if failure else '-'))
    return Table('The printed gains per metre of mean camber', (
        'gains', 'on the model', 'flown [ms]', 'mean', 'amplitude', 'stopped at'), rows)


def _figure(found: Found, made: Section) -> Figure:
    figure, axes = drawing.axes(1, 2, 3.0)
    left, right = axes[0]
    for name, label, colour, style in (
            ('fig5/open_loop', '3 % is the peak', drawing.BLUE, '-'),
            ('printed/open_loop', '3 % is P', drawing.ORANGE, '--')):
        result = found[name]
        left.plot(1.0e3 * result['time'], 100.0 * (result['camber'] - 1.0), style, color=colour,
                  label=label)
        made.series[f'reading_{name.replace("/", "_")}'] = {
            't [s]': result['time'], 'camber [passive]': result['camber']}
    for level in (0.0, -10.0):
        left.axhline(level, color='0.5', lw=0.8, ls=':')
    for name, label, colour in (('as_printed', 'as printed', drawing.ORANGE),
                                ('kd_times_3000', 'Kd times 3000', drawing.GREEN)):
        result = found[f'gains/{name}']
        right.plot(1.0e3 * result['time'], 100.0 * (result['camber'] - 1.0), color=colour, lw=0.9,
                   label=label)
        made.series[f'gains_{name}'] = {
            't [s]': result['time'], 'camber [passive]': result['camber'],
            'V [V]': np.sqrt(result['v_squared'])}
    right.set(xlabel='t [ms]', ylabel='mean camber [% of passive]', title='printed gains',
              ylim=(-60.0, 100.0))
    left.set(xlabel='t [ms]', ylabel='mean camber [% of passive]', title='open loop')
    for axis in axes[0]:
        axis.legend(loc='upper left', bbox_to_anchor=(0.0, -0.2), ncols=2)
    return Figure('readings', 'Left: the disturbance read in two ways; dotted: the range of '
                  'Fig. 5. Right: the printed gains on the wing.', drawing.png(figure))

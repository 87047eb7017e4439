# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Controller design on the reduced model, and the printed gains on it."""

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table
from dewing_control.tuning.bounds import Bounds

WORDS = {'shipped': 'shipped (config/controller.yaml)', 'tuned': 'tuned in this run',
         'as_printed': 'printed, read as V² per metre of camber',
         'ki_over_1000': 'printed, Ki divided by 1000',
         'kd_times_3000': 'printed, Kd times 3000'}


def section(plan: Plan, found: Found) -> Section:
    """Return the model's modes, the loop of the shipped gains and all gains judged."""
    result = found['design']
    values = result.values
    modes = ', '.join(f'{f:.0f} Hz ({100.0 * d:.1f} %)' for f, d in zip(
        values['modes_hz'], values['modes_damping']) if f < 600.0)
    text = [
        f'The model that control is designed on has {values["order"]} states and the mean camber '
        f'as output; modes and damping ratios: {modes}. In units of the passive camber and of '
        f'V_L², the V² at which the tension vanishes, its static gain is '
        f'{values["static_gain"]:.3f}; a string under a uniform load has exactly 1.',
        f'A peak of the sensitivity Ms of at most {Bounds.sensitivity:g} is asked for, at rest '
        f'and at {Bounds.tension:g} of the tension, which is what remains at the peaks of V² in '
        'Fig. 5.',
        f'PI control of the lightly damped first mode is stable for ki below '
        f'{values["pi_limit"]:.3g} /s at the printed kp (ki G0 = 2 zeta w (1 + kp G0)); the '
        f'printed gain is {values["printed"]["ki"]:.3g} /s, '
        f'{values["printed"]["ki"] / values["pi_limit"]:.0f} times as much.']
    rows = [_row(WORDS[name], report) for name, report in values['judged'].items()]
    return Section(
        'controller', 'Controller design on the reduced model', text, [_figure(found)],
        [Table('PID gains on the model (normalised)', (
            'gains', 'kp', 'ki [1/s]', 'kd [s]', 'filter [s]', 'verdict', 'gain margin [dB]',
            'phase margin [deg]', 'rejection at 10 Hz'), rows)],
        series={'loop': {
            'f [Hz]': result['rest/frequency'], '|G|': result['rest/plant'],
            '|L|': result['rest/gain'], 'phase of L [deg]': result['rest/phase'],
            '|S|': result['rest/sensitivity']}},
        values=dict(values['judged']))


def _row(label: str, report: dict) -> tuple[str, ...]:
    gains = tuple(f'{report["gains"][name]:.3g}'
                  for name in ('kp', 'ki', 'kd', 'derivative_filter'))
    if not report['stable']:
        verdict = (f'unstable, spectral radius {report["spectral_radius"]:.3f} a step'
                   if not report['stable_at_rest'] else
                   f'stable at rest, unstable at {Bounds.tension:g} tension')
        return (label, *gains, verdict, '-', '-', '-')
    return (label, *gains, f'Ms {report["ms_at_rest"]:.2f} at rest, {report["ms_peak"]:.2f} worst',
            f'{report["gain_margin_db"]:.1f}', f'{report["phase_margin_deg"]:.0f}',
            f'{report["disturbance_rejection_10hz"]:.2g}')


def _figure(found: Found) -> Figure:
    result = found['design']
    figure, axes = drawing.axes(1, 2, 3.1)
    gain, sensitivity = axes[0]
    for label, name, style, colour in (('at rest', 'rest', '-', drawing.BLUE),
                                       (f'{Bounds.tension:g} of the tension', 'strained', '--',
                                        drawing.ORANGE)):
        gain.loglog(result[f'{name}/frequency'], result[f'{name}/gain'], style, color=colour,
                    label=label)
        sensitivity.loglog(result[f'{name}/frequency'], result[f'{name}/sensitivity'], style,
                           color=colour)
    sensitivity.axhline(2.0, color='0.4', lw=0.8, ls=':')
    gain.axhline(1.0, color='0.4', lw=0.8)
    gain.set(xlabel='f [Hz]', ylabel='|L|')
    sensitivity.set(xlabel='f [Hz]', ylabel='|S|')
    drawing.legend(figure, gain)
    return Figure('controller', 'Loop gain and sensitivity of the shipped PID on the identified '
                  'model; dotted: Ms = 2.', drawing.png(figure))

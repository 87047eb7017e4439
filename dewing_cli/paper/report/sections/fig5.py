# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 5: the wing under the 10 Hz disturbance, open and closed loop."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Row, Section, Table
from dewing_cli.paper.runs import experiments
from dewing_cli.paper.runs.designed import design_of, model_of
from dewing_control.settings import ControllerSettings
from dewing_control.tuning.on_wing import on_model
from dewing_sim import parameters
from dewing_sim.inputs.disturbance import DISTURBANCES

PRINTED = 5.0               # %, mean and amplitude of the open loop in Fig. 5
SHARE = DISTURBANCES['fig5']['disturbance.pressure']


def section(plan: Plan, found: Found) -> Section:
    """Return open and closed loop on wing and model."""
    opened, closed = found['fig5/open_loop'], found['fig5/pid_tuned']
    made = Section('fig5', 'Open and closed loop (Fig. 5)', [
        f'The wall pressure P (1 - cos 2 pi f t) with f = 10 Hz presses the camber down; P = '
        f'{100.0 * SHARE:g} % of q, so that its peak is the printed 3 %. The controller is the '
        'shipped PID on the mean camber with a target 10 % above the passive one, approached '
        'along a ramp of 0.05 s.',
        'Controller and wing run in one process here. The same loop closed over ROS 2, between '
        'two processes in lock-step (dewing demo), gives the same numbers bit for bit, which a '
        'test compares.'])
    made.figures.append(_figure(plan, found, made))
    made.tables.append(_table(opened, closed))
    made.rows = _rows(opened, closed)
    return made


def percent(result) -> tuple[float, float]:
    """Return mean and amplitude of the mean camber in % of the passive one."""
    return (100.0 * (result.values['camber_mean'] - 1.0),
            100.0 * result.values['camber_amplitude'])


def _rows(opened, closed) -> list[Row]:
    mean, amplitude = percent(opened)
    reached, left = percent(closed)
    return [
        Row('Fig. 5, open loop: mean of the camber', -PRINTED, mean, '%', None, None,
            'the printed 3 % read as the peak of P (1 - cos)'),
        Row('Fig. 5, open loop: amplitude of the camber', PRINTED, amplitude, '%', None, None,
            'the same'),
        Row('Fig. 5, closed loop: mean of the camber', 10.0, reached, '%', None, None,
            'own gains; the printed ones are unstable on this wing'),
        Row('Fig. 5, closed loop: amplitude of the camber', None, left, '%', None, None,
            'the paper shows a ripple without a number')]


def _figure(plan: Plan, found: Found, made: Section) -> Figure:
    figure, (row, lower) = drawing.axes(2, 1, 2.5, sharex=True)
    camber, voltage = row[0], lower[0]
    columns: dict[str, np.ndarray] = {}
    for name, label, colour, style in (
            ('fig5/open_loop', 'open loop', drawing.BLUE, '-'),
            ('fig5/pid_tuned', 'closed loop', drawing.ORANGE, '-')):
        result = found[name]
        time = 1.0e3 * result['time']
        camber.plot(time, 100.0 * (result['camber'] - 1.0), style, color=colour, label=label)
        voltage.plot(time, np.sqrt(result['v_squared']), style, color=colour)
        columns |= {'t [s]': result['time'], f'camber, {label} [passive]': result['camber'],
                    f'V, {label} [V]': np.sqrt(result['v_squared']),
                    f'Cl, {label}': result['cl']}
    if 'design' in found:
        predicted = _predicted(plan, found)
        camber.plot(1.0e3 * columns['t [s]'][:predicted.size], 100.0 * (predicted - 1.0), ':',
                    color=drawing.BLACK, lw=1.6, label='closed loop on the reduced model')
        columns['camber, closed loop, model [passive]'] = predicted
    camber.axhline(10.0, color='0.5', lw=0.8, ls='--')
    camber.set_ylabel('mean camber [% of passive]')
    drawing.legend(figure, camber)
    voltage.set(xlabel='t [ms]', ylabel='V [V]')
    made.series['fig5'] = {name: column[:min(map(len, columns.values()))]
                           for name, column in columns.items()}
    return Figure('fig5', 'Camber and voltage in open and closed loop on the Navier-Stokes wing, '
                  'and what the reduced model predicts. Dashed: target.', drawing.png(figure))


def _predicted(plan: Plan, found: Found) -> np.ndarray:
    result = found['design']
    run = plan.runs['fig5/pid_tuned']
    settings = parameters.from_yaml(run.settings, ControllerSettings)
    return on_model(settings, experiments.identity(found['experiments']), model_of(result),
                    design_of(result), run.duration)


def _table(opened, closed) -> Table:
    rows = []
    for label, result in (('open loop', opened), ('closed loop', closed)):
        mean, amplitude = percent(result)
        voltage = np.sqrt(result['v_squared'][-round(
            result.values['averaged'] / result.values['dt']):])
        rows.append((label, f'{mean:+.3f} %', f'{amplitude:.3f} %', f'{voltage.min():.0f}',
                     f'{voltage.max():.0f}', '-' if label == 'open loop' else
                     f'{100.0 * result.values["saturation_share"]:.0f} %',
                     f'{result.values["cl_mean"]:.5f}'))
    return Table('The last periods', ('loop', 'mean camber', 'amplitude', 'least V', 'largest V',
                                      'V² at a bound', 'mean Cl'), rows)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 4: the pulse response of the wing against ERA models of orders 2 to 14."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Row, Section, Table
from dewing_cli.paper.runs import experiments
from dewing_cli.paper.runs.quantities import FIRST_MODE
from dewing_control.model.identified import CHANGES
from dewing_sim import parameters
from dewing_sim.linear.model import Model
from dewing_sysid.identify import factorise, nrmse_fit, realise
from dewing_sysid.plan import EXPERIMENT, FRESH, samples, time_scale
from dewing_sysid.settings import Settings

ORDERS = (2, 4, 6, 8, 10, 12, 14)
DRAWN = (2, 6, 10, 14)
WINDOWS = (1.2, 3.6, 9.6)               # c/U: the paper's, and longer ones
OUTPUTS = ('camber_mean', 'cl')
WORST = -100.0                          # percent: fits below it are not told apart


def section(plan: Plan, found: Found) -> Section:
    """Return responses, fits by order and window."""
    result = found['experiments']
    records, identity = experiments.records(result, OUTPUTS), experiments.identity(result)
    window = samples(WINDOWS[0], time_scale(identity), records[EXPERIMENT].dt)
    made = Section('pulse', 'Pulse response and reduced models (Fig. 4)', [
        'V² is raised for a single time step and the undisturbed run subtracted. The eigensystem '
        'realisation algorithm (paper eq. 7 to 9) makes models of any order from one singular '
        'value decomposition. A fit of 100 % is perfect; "fresh" is a binary sequence that the '
        'models have not seen. The paper uses a window of 1.2 c/U and order 10; that window holds '
        'two periods of the first mode, too few for its damping. A spectral radius above 1 is a '
        'growing model: a slow pole of the wake that ERA places outside the unit circle; control '
        'mirrors it.'])
    models = {length: _models(records, identity, length) for length in WINDOWS}
    made.figures.append(_figure(records[EXPERIMENT].head(window), models[WINDOWS[0]], made))
    made.tables = [_table(records, models, length, identity) for length in WINDOWS]
    fits = _fits(records[EXPERIMENT].head(window), models[WINDOWS[0]][10])
    fresh = _fits(records[FRESH], models[WINDOWS[1]][10])
    made.values = {'fit_pulse_order_10': fits, 'fit_fresh_order_10_window_3.6': fresh}
    for name, label in zip(OUTPUTS, ('mean camber', 'Cl')):
        made.rows.append(Row(
            f'ERA of order 10, window 1.2 c/U: fit of the pulse in {label}', None, fits[name],
            '%', None, None, 'the paper shows curves that coincide, without a figure of merit'))
    return made


def _models(records: dict, identity, length: float) -> dict[int, Model]:
    """Return a model of each order from a window of ``length`` c/U."""
    settings = parameters.load('sysid', Settings, {**CHANGES, 'realisation.window': length})
    record = records[EXPERIMENT]
    factors = factorise(record, settings, samples(length, time_scale(identity), record.dt))
    models = {}
    for order in ORDERS:
        made = realise(factors, settings.realisation, order)
        models[order] = Model(
            made.a, made.b, made.c, np.zeros_like(made.d), record.dt, record.names,
            record.baseline.mean(axis=1), 1.0, v_squared_max=1.0, units=('m', '-'),
            singular_values=factors.singular_values)
    return models


def _fits(record, model: Model) -> dict[str, float]:
    with np.errstate(over='ignore', invalid='ignore'):
        fits = nrmse_fit(record.y, model.simulate(record.u))
    return {name: float(max(fit, WORST)) if np.isfinite(fit) else WORST
            for name, fit in zip(record.names, fits)}


def _percent(fit: float) -> str:
    return f'{fit:.1f}' if fit > WORST else f'< {WORST:.0f}'


def _table(records: dict, models: dict, length: float, identity) -> Table:
    rows = []
    for order, model in models[length].items():
        record = records[EXPERIMENT]
        head = record.head(samples(length, time_scale(identity), record.dt))
        fits, fresh = _fits(head, model), _fits(records[FRESH], model)
        frequency, damping = model.modes()
        main = np.argmin(np.abs(frequency - FIRST_MODE)) if len(frequency) else None
        rows.append((str(order), *(_percent(fits[name]) for name in OUTPUTS),
                     *(_percent(fresh[name]) for name in OUTPUTS),
                     '-' if main is None else f'{frequency[main]:.1f}',
                     '-' if main is None else f'{damping[main]:.4f}',
                     f'{model.spectral_radius:.5f}'))
    return Table(f'Fits in % by order, window {length:g} c/U', (
        'order', 'pulse, camber', 'pulse, Cl', 'fresh, camber', 'fresh, Cl', 'first mode [Hz]',
        'its damping', 'spectral radius'), rows)


def _figure(record, models: dict[int, Model], made: Section) -> Figure:
    figure, axes = drawing.axes(2, 1, 2.5, sharex=True)
    time = 1.0e3 * record.dt * np.arange(len(record.u))
    scales, labels = (1.0e9, 1.0e3), ('mean camber [nm]', 'Cl × 1000')
    columns = {'t [s]': 1.0e-3 * time}
    for row, (axis, scale, label) in enumerate(zip(axes[:, 0], scales, labels)):
        axis.plot(time, scale * record.y[row], color='0.6', lw=3.2, label='Navier-Stokes wing')
        columns[f'{OUTPUTS[row]} wing'] = record.y[row]
        for number, order in enumerate(ORDERS):
            predicted = models[order].simulate(record.u)[row]
            columns[f'{OUTPUTS[row]} order {order}'] = predicted
            if order in DRAWN:
                axis.plot(time, scale * predicted, drawing.STYLES[DRAWN.index(order)],
                          color=drawing.COLOURS[number], lw=1.0, label=f'ERA, order {order}')
        axis.set_ylabel(label)
    late = record.y[1][3:]
    axes[1, 0].set_ylim(1.3e3 * late.min(), 1.3e3 * late.max())
    drawing.legend(figure, axes[0, 0], 5)
    axes[1, 0].set(xlabel='t [ms]')
    made.series['pulse_response'] = columns
    return Figure('pulse', 'Response to a pulse of (400 V)² over one step, deviations from the '
                  'undisturbed run, window 1.2 c/U. The first sample of the lift, the reaction '
                  'of the added mass, is some twenty times larger and leaves the axes.',
                  drawing.png(figure))

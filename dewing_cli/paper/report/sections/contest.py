# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Beyond the paper: PID, learnt feed-forward, LQG and MPC on the same wing."""

import numpy as np

from dewing_cli.paper.plan import CONTROLLERS, KIND, Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table
from dewing_control.law.registry import LAWS

WORDS = {'open_loop': 'open loop',
         **{name: LAWS[KIND.get(name, name)].title for name in CONTROLLERS[1:]}}
MEANINGS = {'fig5': 'target 1.10', 'target_1': 'target 1.00',
            'target_097': 'target 0.97: V² would have to be negative'}


def section(plan: Plan, found: Found) -> Section:
    """Return the errors of all controllers in every scenario planned."""
    made = Section('contest', 'Controllers compared', [
        'All controllers see the mean camber only, and V² is never negative. LQG and MPC are '
        'designed on the model identified above and know the frequency of the disturbance, as '
        'does the learnt feed-forward; the PID does not. dewing compare runs more scenarios: '
        'other frequencies, sensor noise, wings that differ from the nominal one.'])
    names = plan.extent.scenarios
    figure, axes = drawing.axes(len(names), 1, 2.2, sharex=True)
    rows = []
    for axis, scenario in zip(axes[:, 0], names):
        columns: dict[str, np.ndarray] = {}
        for number, name in enumerate(CONTROLLERS[1:]):
            if f'{scenario}/{name}' not in found:
                continue
            result = found[f'{scenario}/{name}']
            target = result.values['target']
            axis.semilogy(1.0e3 * result['time'],
                          100.0 * np.maximum(np.abs(result['camber'] - target), 1.0e-8),
                          drawing.STYLES[number], color=drawing.COLOURS[number], lw=1.0,
                          label=WORDS[name])
            rows.append(_row(scenario, name, result.values))
            columns |= {'t [s]': result['time'], f'camber, {name} [passive]': result['camber'],
                        f'V, {name} [V]': np.sqrt(result['v_squared'])}
        axis.set(ylabel='|error| [%]', title=f'{MEANINGS[scenario]}', ylim=(1.0e-5, 30.0))
        made.series[f'controllers_{scenario}'] = columns
    axes[-1, 0].set_xlabel('t [ms]')
    drawing.legend(figure, axes[0, 0])
    made.figures.append(Figure('contest', 'Distance of the mean camber from its target, in % of '
                               'the passive camber.', drawing.png(figure)))
    made.tables.append(Table('The last periods', (
        'scenario', 'controller', 'mean camber', 'amplitude', 'rms error', 'largest V',
        'V² at a bound', 'power without recovery [mW/m]', 'computing time [ms]'), rows))
    return made


def _row(scenario: str, name: str, values: dict) -> tuple[str, ...]:
    failed = f' (stopped: {values["failure"]})' if values['failure'] else ''
    return (MEANINGS[scenario], WORDS[name] + failed, f'{values["camber_mean"]:.4f}',
            f'{100.0 * values["camber_amplitude"]:.4f} %',
            f'{100.0 * values["error_rms"]:.4f} %', f'{values["v_max"]:.0f}',
            f'{100.0 * values["saturation_share"]:.0f} %',
            f'{1.0e3 * values["power_without_recovery_w"]:.3g}', f'{values["compute_ms"]:.3f}')

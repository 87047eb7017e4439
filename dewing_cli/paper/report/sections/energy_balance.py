# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Beyond the paper: what the electrodes take from their source."""

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report import drawing
from dewing_cli.paper.report.section import Figure, Found, Section, Table


def section(plan: Plan, found: Found) -> Section:
    """Return stored energy and powers of the closed loops at 4 degrees."""
    case = plan.case('fig5/pid_tuned')
    flight = found['rest']
    drag = float(flight['cd'].mean()) * case.flow.dynamic_pressure * case.membrane.chord * (
        case.flow.speed)
    names = [name for name in plan.runs if name.startswith(tuple(plan.extent.scenarios))
             and name in found and not name.endswith('open_loop')]
    rows = [_row(name, found[name].values) for name in names]
    main = found['fig5/pid_tuned'].values
    text = [
        'Per metre of span. The electrodes are a capacitor that follows the deformed membrane. '
        'With recovery of charge an ideal source gets back what the membrane gives back; without, '
        'it is lost.',
        f'In Fig. 5 the source pays {1.0e3 * main["power_without_recovery_w"]:.3g} mW/m without '
        f'recovery and {1.0e3 * main["power_w"]:.2g} mW/m with it. The drag of this wing costs '
        f'Cd q c U = {1.0e3 * drag:.3g} mW/m: control without recovery costs '
        f'{main["power_without_recovery_w"] / drag:.1f} times the power of flight.']
    result = found['fig5/pid_tuned']
    stored = 0.5 * result['capacitance'] * result['v_squared']
    figure, ((axis,),) = drawing.axes(1, 1, 2.4)
    axis.plot(1.0e3 * result['time'], 1.0e3 * stored, color=drawing.BLUE)
    axis.set(xlabel='t [ms]', ylabel='C V²/2 [mJ/m]')
    return Section(
        'energy', 'Energy balance', text,
        [Figure('energy', 'Energy in the electrodes in the closed loop of Fig. 5.',
                drawing.png(figure))],
        [Table('Energies and powers', (
            'scenario / controller', 'rms V', 'taken in all [mJ/m]', 'power with recovery [mW/m]',
            'without [mW/m]', 'work on the membrane [mW/m]'), rows)],
        series={'energy': {'t [s]': result['time'], 'C [F/m]': result['capacitance'],
                           'C V^2/2 [J/m]': stored}},
        values={'drag_power_w': drag,
                'control_power_without_recovery_w': main['power_without_recovery_w'],
                'control_power_w': main['power_w'],
                'capacitance_f': float(np.mean(result['capacitance']))})


def _row(name: str, values: dict) -> tuple[str, ...]:
    return (name, f'{values["v_rms"]:.0f}', f'{1.0e3 * values["energy_j"]:.3f}',
            f'{1.0e3 * values["power_w"]:.4f}',
            f'{1.0e3 * values["power_without_recovery_w"]:.3g}',
            f'{1.0e3 * values["work_w"]:.2g}')

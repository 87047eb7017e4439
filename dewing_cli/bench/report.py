# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What `dewing bench --graph` measures in one run, and its table."""

import dataclasses
from typing import Any

from dewing_cli import results
from dewing_cli.bench import graph, timing
from dewing_cli.bench.step import time_step
from dewing_cli.progress import bar
from dewing_control.settings import ControllerSettings
from dewing_sim.parameters import Case

ANGLES = {'alpha4': 4.0, 'alpha8': 8.0}      # degrees
CALLS = 2000                # round trips


def measure(case: Case, settings: ControllerSettings, steps: int, quiet: bool = False,
            ) -> dict[str, Any]:
    """Return floors, the step, and the laps of ``steps`` steps of each loop."""
    from dewing_sim.ros.floor import round_trip
    cases = {name: dataclasses.replace(case, flow=dataclasses.replace(
        case.flow, angle_of_attack_deg=angle)) for name, angle in ANGLES.items()}
    work = {
        'step': lambda: time_step(cases['alpha4'], steps),
        'socket_pair_ms': lambda: timing.socket_time(CALLS),
        'raw_dds_ms': lambda: round_trip(CALLS),
        'composed': lambda: graph.over_ros(cases['alpha4'], settings, steps, True)}
    for name, each in cases.items():
        work[f'offline_{name}'] = lambda each=each: graph.offline(each, settings, steps)
        work[name] = lambda each=each: graph.over_ros(each, settings, steps, False)
    found: dict[str, Any] = {}
    with bar('bench', quiet=quiet) as show:
        for name, act in work.items():
            found[name] = act()
            show(len(found), len(work))
    return _arranged(found, case)


def _arranged(found: dict[str, Any], case: Case) -> dict[str, Any]:
    """Return the figures as docs and scripts know them, with their ratios."""
    offline = {key: found[f'offline_{key}'] for key in ANGLES}
    return {
        'case': {'engine': case.numerics.engine, 'grid': case.numerics.grid,
                 'time_step': case.numerics.time_step},
        'floor': {key: found[key] for key in ('socket_pair_ms', 'raw_dds_ms')},
        'step': found['step'],
        'offline': offline | {f'rtf_{key}': row['rtf'] for key, row in offline.items()},
        'graph': {'two_processes': found['alpha4'], 'two_processes_alpha8': found['alpha8'],
                  'composed': found['composed']},
        'offline_over_graph': {key: offline[key]['rtf'] / found[key]['rtf'] for key in ANGLES}}


def print_report(found: dict[str, Any]) -> None:
    """Print the table."""
    print('step of the wing at 4 degrees')
    results.print_table({f'  {key}': value for key, value in found['step'].items()})
    print('there and back between two processes')
    results.print_table({f'  {key}': value for key, value in found['floor'].items()})
    rows = {'offline, 4 degrees': found['offline']['alpha4'],
            'offline, 8 degrees': found['offline']['alpha8'],
            'one process, 4 degrees': found['graph']['composed'],
            'two processes, 4 degrees': found['graph']['two_processes'],
            'two processes, 8 degrees': found['graph']['two_processes_alpha8']}
    print(f"{'closed loop, ms a lap':26}{'lap':>9}{'plant':>9}{'overhead':>10}{'p99':>9}"
          f"{'real-time factor':>18}")
    for name, row in rows.items():
        print(f'  {name:24}' + ''.join(f'{row[key]:{width}.3f}' for key, width in (
            ('lap_ms_median', 9), ('plant_ms_median', 9), ('overhead_ms_median', 10),
            ('overhead_ms_p99', 9), ('rtf', 18))))
    for key, ratio in found['offline_over_graph'].items():
        print(f"  offline over two processes, {key.removeprefix('alpha')} degrees: {ratio:.3f}")

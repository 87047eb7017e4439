# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compare controllers on the same wing: accuracy, voltage, energy, computing time.

Open loop, the PID with the paper's gains, the tuned PID, LQG, learnt feed-forward, MPC and laws of
your own (package.module:Name) run through disturbances, gusts, targets in and out of reach, sensor
noise and wings that differ from the nominal one. Energies and powers are per metre of span.
"""

import argparse
import json
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim.errors import BadInput
from dewing_sim.files import new_file

MODEL = 'model.npz'     # identified on the way, if none is given
AVERAGED = 0.2          # s at the end: whole periods of 5, 10, 20 and 40 Hz
SHOWN = ('camber_mean', 'camber_amplitude', 'error_rms', 'v_max', 'v_rms', 'saturation_share',
         'power_w', 'power_without_recovery_w', 'cl_mean', 'compute_ms')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    options.add_numerics(parser, 's')
    group = parser.add_argument_group('comparison')
    group.add_argument('--quick', action='store_true', help='four scenarios, shorter runs')
    group.add_argument('--scenarios', metavar='A,B', help='only these scenarios')
    group.add_argument('--controllers', metavar='A,B', help='only these controllers')
    group.add_argument('--settings', default='controller', metavar='NAME|FILE',
                       help='settings of all controllers (default: controller)')
    group.add_argument('--model', metavar='FILE',
                       help='npz of the identified model (default: identify)')
    options.add_workers(parser, '2; 1 gives undisturbed computing times')
    options.add_results(parser, 'folder of table, figure and metrics (default: out/compare)')
    parser.set_defaults(out='out/compare', duration=0.5)


def run(arguments: argparse.Namespace) -> None:
    """Run the comparison, then write table, figure and metrics."""
    from pathlib import Path

    from dewing_control.settings import ControllerSettings
    from dewing_control.trial.scenarios import QUICK, SCENARIOS
    from dewing_sim import parameters
    scenarios = _chosen('--scenarios', arguments.scenarios, SCENARIOS,
                        QUICK if arguments.quick else tuple(SCENARIOS))
    settings = parameters.load(arguments.settings, ControllerSettings)
    names = _controllers(arguments.controllers, settings.kind)
    duration = 0.4 if arguments.quick else options.within(
        '--duration', arguments.duration, 0.02, 100.0, 's')
    workers = options.workers(arguments)
    folder = Path(arguments.out)
    files = ['metrics.json', 'table.md', 'compare.png', *([] if arguments.model else [MODEL])]
    outputs.claim(outputs.within(folder, files) | {'--json': arguments.json}, arguments.force)
    with bar('comparing', 'scenarios', arguments.quiet) as show:
        plan = _plan(arguments, settings, folder, duration)
        collected = _collect(plan, scenarios, names, workers, show)
    _deliver(arguments, folder, collected)


def _chosen(option: str, text: str | None, known: Any, default: tuple) -> tuple:
    if text is None:
        return default
    for name in text.split(','):
        if name not in known:
            raise BadInput(f'{option} {name} is not known; one of {", ".join(known)}')
    return tuple(text.split(','))


def _controllers(text: str | None, kind: str) -> tuple:
    """Return who is compared; laws from outside go by their ``kind``."""
    from dewing_control.law.registry import of_kind
    from dewing_control.trial.comparison import CONTROLLERS
    from dewing_sim.schema.plugins import is_plugin
    outside = tuple(filter(is_plugin, [kind] if text is None else text.split(',')))
    for name in outside:
        of_kind(name)                       # a law that cannot be used stops it here
    return _chosen('--controllers', text, (*CONTROLLERS, *outside), (*CONTROLLERS, *outside))


def _plan(arguments: argparse.Namespace, settings: Any, folder: Any, duration: float) -> Any:
    from dewing_control.model.identified import identify
    from dewing_control.trial.comparison import Plan
    from dewing_sim import parameters
    from dewing_sim.build import build_wing
    case = options.load_case(arguments)
    built = build_wing(case)
    model = arguments.model
    if model is None:
        model = str(folder / MODEL)
        identify(built).save(model, arguments.force)
    settings = parameters.replace(settings, {'model': model})
    return Plan(case, settings, built.identity, duration,
                max(duration - AVERAGED, 0.5 * duration))


def _collect(plan: Any, scenarios: tuple, names: tuple, workers: Any, show: Any) -> dict:
    from dewing_control.trial.comparison import run_all
    collected = {}
    for name, result in run_all(plan, scenarios, names, workers):
        collected[name] = result
        show(len(collected), len(scenarios))
    return collected


def _deliver(arguments: argparse.Namespace, folder: Any, collected: dict) -> None:
    from dewing_control.figures.comparison import draw
    metrics = {scenario: {name: figures for name, (figures, _) in result.items()}
               for scenario, result in collected.items()}
    table = _table(metrics)
    results.write_json(folder / 'metrics.json', metrics, arguments.force)
    if arguments.json:
        results.write_json(arguments.json, metrics, arguments.force)
    with new_file(folder / 'table.md', arguments.force) as file:
        file.write(table.encode())
    with new_file(folder / 'compare.png', arguments.force) as file:
        draw(collected).savefig(file, format='png', dpi=120)
    if not arguments.quiet:
        print(table)


def _table(metrics: dict) -> str:
    from dewing_control.trial.scenarios import SCENARIOS
    lines = []
    for scenario, controllers in metrics.items():
        lines += [f'**{scenario}**: {SCENARIOS[scenario].meaning}', '',
                  '| controller | ' + ' | '.join(SHOWN) + ' |',
                  '|---' * (len(SHOWN) + 1) + '|']
        for name, figures in controllers.items():
            cells = ' | '.join(f'{figures[key]:.4g}' for key in SHOWN)
            note = f' (stopped: {json.dumps(figures["failure"])})' if figures['failure'] else ''
            lines.append(f'| {name}{note} | {cells} |')
        lines.append('')
    return '\n'.join(lines)

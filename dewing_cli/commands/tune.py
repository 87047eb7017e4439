# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Tune a controller on the identified model and try it on the wing.

Minimises the error after a step and under the 10 Hz disturbance, with bounds on the peak
sensitivity Ms, on noise and on saturation. Writes controller.yaml, model.npz, figures and
metrics.json into --out, and judges the gains printed in the paper.
"""

import argparse
from pathlib import Path
from typing import Any, Iterator

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_control.tuning.bounds import Bounds
from dewing_sim.files import new_file

TIMING = {'period': 'period_steps', 'delay': 'delay_steps'}    # options, of the command
FILES = ('controller.yaml', 'model.npz', 'metrics.json', 'bode.png', 'nyquist.png',
         'response.png')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    options.add_numerics(parser, 's')
    group = parser.add_argument_group('tuning')
    group.add_argument('--settings', default='controller', metavar='NAME|FILE',
                       help='settings to start from (default: controller)')
    group.add_argument('--kind', metavar='KIND',
                       help='control law: its kind, or package.module:Name of your own')
    group.add_argument('--model', metavar='FILE',
                       help='npz of the identified model (default: identify)')
    for name, meaning in (('period', 'steps of the plant in one control period'),
                          ('delay', 'steps by which V^2 takes effect late')):
        group.add_argument(f'--{name}', type=int, metavar='STEPS',
                           help=f'{meaning} (default: as in the settings)')
    group.add_argument('--generations', type=int, default=25, metavar='N',
                       help='length of the search (default: 25)')
    for name, default, help in (
            ('ms', Bounds.sensitivity, 'largest peak of the sensitivity'),
            ('saturation', Bounds.saturation, 'largest share of the time with V^2 at zero'),
            ('noise-gain', Bounds.noise_gain, 'largest gain from noise of a/a_ref to V^2/V_L^2'),
            ('tension', Bounds.tension,
             'lower tension at which Ms holds as well, of that at rest')):
        group.add_argument(f'--{name}', type=float, default=default, metavar='X',
                           help=f'{help} (default: {default:g})')
    options.add_results(parser, 'folder of the results (default: out/tune)')
    parser.set_defaults(out='out/tune', duration=0.3)


def run(arguments: argparse.Namespace) -> None:
    """Identify, tune, try on the wing, and write everything."""
    settings, bounds = _check(arguments)
    from dewing_control.law.registry import refusing
    from dewing_control.model.design import Design
    from dewing_control.tuning.tuning import tune
    from dewing_sim.build import build_wing
    built = build_wing(options.load_case(arguments))
    model = _model(arguments, built)
    with refusing(settings.kind):
        design = Design.of(model, settings.reference.output, settings.command.period_steps)
    with bar('tuning', 'generations', arguments.quiet) as show:
        judged = tune(settings, built.identity, design, bounds,
                      generations=arguments.generations, progress=show)
    folder = Path(arguments.out)
    model.save(folder / 'model.npz', arguments.force)
    metrics = _verify(arguments, built, model, design, judged)
    metrics['printed'] = _printed(built, design, judged.settings, bounds)
    _write_settings(folder, judged.settings, arguments.force)
    results.write_json(folder / 'metrics.json', metrics, arguments.force)
    if arguments.json:
        results.write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        results.print_table(dict(_flat(metrics)))


def _flat(metrics: dict, prefix: str = '') -> Iterator[tuple[str, Any]]:
    """Yield dotted name and value of every leaf."""
    for name, value in metrics.items():
        if isinstance(value, dict):
            yield from _flat(value, f'{prefix}{name}.')
        else:
            yield prefix + name, value


def _check(arguments: argparse.Namespace) -> tuple[Any, Any]:
    """Return settings and bounds, with every option checked before any work."""
    from dewing_control.settings import ControllerSettings
    from dewing_control.tuning.tuning import ranges_of
    from dewing_sim import parameters
    options.load_case(arguments)
    changes = {'kind': arguments.kind} if arguments.kind else {}
    changes |= {f'command.{field}': getattr(arguments, name) for name, field in TIMING.items()
                if getattr(arguments, name) is not None}
    settings = parameters.load(arguments.settings, ControllerSettings, changes)
    ranges_of(settings.kind)
    options.within('--duration', arguments.duration, 0.01, 100.0, 's')
    options.within('--generations', arguments.generations, 1, 10_000, '')
    bounds = Bounds(options.within('--ms', arguments.ms, 1.05, 100.0, ''),
                    options.within('--saturation', arguments.saturation, 0.0, 1.0, ''),
                    options.within('--noise-gain', arguments.noise_gain, 1.0e-3, 1.0e6, ''),
                    options.within('--tension', arguments.tension, 0.05, 1.0, ''))
    outputs.claim(outputs.within(arguments.out, FILES) | {'--json': arguments.json},
                  arguments.force)
    return settings, bounds


def _model(arguments: argparse.Namespace, built: Any) -> Any:
    from dewing_control.model.identified import identify
    from dewing_sim.linear.model import Model
    if arguments.model:
        return Model.load(arguments.model)
    with bar('identifying', 'runs', arguments.quiet) as show:
        return identify(built, lambda fraction: show(round(100 * fraction), 100))


def _verify(arguments, built, model, design, judged) -> dict[str, Any]:
    """Draw the loop, run it on wing and model, and return all figures."""
    import numpy as np

    from dewing_control.figures import tuning as tuning_figures
    from dewing_control.tuning import on_wing as verification
    from dewing_sim import parameters
    from dewing_sim.build import build_wing
    from dewing_sim.inputs.disturbance import DISTURBANCES
    disturbed = build_wing(parameters.replace(built.plant.case, DISTURBANCES['fig5']))
    run, wing = verification.on_wing(judged.settings, disturbed, design, arguments.duration)
    camber = verification.on_model(judged.settings, built.identity, model, design,
                                   arguments.duration)
    folder = Path(arguments.out)
    for name, figure in (
            ('bode', tuning_figures.bode(judged)), ('nyquist', tuning_figures.nyquist(judged)),
            ('response', tuning_figures.responses(camber, run.camber, np.sqrt(run.v_squared),
                                                  run.dt))):
        with new_file(folder / f'{name}.png', arguments.force) as file:
            figure.savefig(file, format='png', dpi=120)
    timing = {name: getattr(judged.settings.command, name) for name in TIMING.values()}
    return {'kind': judged.settings.kind, **timing, 'gains': _gains(judged.settings),
            **judged.report(),
            'wing': wing,
            'wing_minus_model': verification.difference(run.camber, camber, run.dt)}


def _gains(settings: Any) -> dict[str, float]:
    from dewing_control.law.registry import of_kind
    from dewing_control.settings import value_of
    return {name: value_of(settings, name) for name in of_kind(settings.kind).ranges}


def _printed(built: Any, design: Any, settings: Any, bounds: Bounds) -> dict[str, Any]:
    """Judge the gains of the paper as printed, and with 3000 times the derivative gain."""
    from dewing_control.tuning.judge import judge
    from dewing_control.tuning.printed import pi_limit, printed_gains
    from dewing_sim import parameters
    gains = printed_gains(built.identity)
    found = {'gains': gains, 'ki_limit_without_kd': pi_limit(design, gains['kp'])}
    for name, factor in (('as_printed', 1.0), ('kd_times_3000', 3000.0)):
        changes = {f'pid.{gain}': value for gain, value in gains.items()}
        changes |= {'kind': 'pid', 'pid.kd': factor * gains['kd']}
        found[name] = judge(parameters.replace(settings, changes), built.identity, design,
                            design.at_tension(bounds.tension)).report()
    return found


def _write_settings(folder: Path, settings: Any, overwrite: bool) -> None:
    import dataclasses

    from dewing_control.law.registry import of_kind
    from dewing_sim import parameters
    if of_kind(settings.kind).needs_model:
        settings = dataclasses.replace(settings, model=str((folder / 'model.npz').resolve()))
    with new_file(folder / 'controller.yaml', overwrite) as file:
        file.write(parameters.to_yaml(settings, '/**/controller').encode())

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Identify a linear model of a wing: experiment, realisation, quality.

V^2 is excited about the rest state of the case; a linear state-space model is realised from the
response and judged on runs that it has not seen. --set takes keys of the case and of
config/sysid.yaml. --from identifies from recorded experiments: the npz of --records, or a bag of
the node sysid.
"""

import argparse
import time
import warnings
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.parameters import Case
from dewing_sysid.settings import Settings

SHOWN = ('fit', 'fit_fresh', 'fit_sweep', 'linearity', 'poles_hz', 'poles_damping',
         'spectral_radius', 'order', 'dt', 'seconds')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    group = parser.add_argument_group('identification')
    group.add_argument('--settings', default='sysid', metavar='NAME|FILE',
                       help='YAML file of the identification (default: sysid)')
    group.add_argument('--experiment', metavar='NAME', help='pulse, doublet, step, prbs or chirp')
    group.add_argument('--order', type=int, metavar='N', help='number of states')
    group.add_argument('--window', type=float, metavar='TSTAR',
                       help='length of pulse response realised, in c/U (the paper: 1.2)')
    group.add_argument('--outputs', metavar='NAME,...',
                       help='identified outputs (default: camber_mean,camber_max,cl)')
    group.add_argument('--from', dest='source', metavar='FILE',
                       help='identify from recorded experiments, npz or MCAP bag')
    group.add_argument('--run', dest='number', type=int, metavar='N',
                       help='run of the bag that is the experiment (default: all, by their V^2)')
    options.add_workers(parser)
    options.add_numerics(parser, 's')
    options.add_results(parser, 'write the model as npz')
    group = parser.add_argument_group('more results')
    group.add_argument('--mat', metavar='FILE', help='write the model as mat, for MATLAB, too')
    group.add_argument('--records', metavar='FILE', help='write the experiments as npz')
    group.add_argument('--figures', metavar='FOLDER',
                       help='draw responses, singular values, Bode plot and poles')


def run(arguments: argparse.Namespace) -> None:
    """Identify, then write model, records, figures and metrics."""
    settings, case = _check(arguments)

    from dewing_sysid import figures, identify
    from dewing_sysid.experiment import save_records
    names = tuple(arguments.outputs.split(',')) if arguments.outputs else None
    began = time.perf_counter()
    if arguments.source:
        from dewing_sysid.sources import load
        records, identity = load(arguments.source, arguments.number)
        found = identify.identify(records, settings, identity)
    else:
        found, identity, began = _experiment(arguments, settings, case, names)
    for sentence in identify.concerns(found, settings):
        warnings.warn(sentence, RuntimeWarning, stacklevel=1)
    metrics = identify.report(found) | {'seconds': time.perf_counter() - began}
    if arguments.out:
        found.model.save(arguments.out, arguments.force)
    if arguments.mat:
        found.model.save_mat(arguments.mat, arguments.force)
    if arguments.records:
        save_records(arguments.records, found.records, identity, arguments.force)
    if arguments.figures:
        figures.save(found, arguments.figures, arguments.force)
    _deliver(arguments, metrics)


def _check(arguments: argparse.Namespace) -> tuple[Settings, Case]:
    """Return settings and case with every option applied, all checked before any work."""
    sections = {name.partition('.')[0] for name, _ in parameters.fields(Settings)}
    ours = [text for text in arguments.set if text.partition('.')[0] in sections]
    arguments.set = [text for text in arguments.set if text not in ours]
    changes = dict(map(parameters.parse_assignment, ours))
    case = options.load_case(arguments)
    for key, value in (('experiment.kind', arguments.experiment),
                       ('realisation.order', arguments.order),
                       ('realisation.window', arguments.window),
                       ('experiment.record', _convective_times(arguments.duration, case))):
        if value is not None:
            changes[key] = value
    settings = parameters.load(arguments.settings, Settings, changes)
    options.workers(arguments)
    if arguments.number is not None and not arguments.source:
        raise BadInput('--run picks a run of a bag: --from names it')
    if arguments.source and arguments.outputs:
        raise BadInput('--outputs cannot change what was recorded: leave out --outputs or --from')
    _claim(arguments)
    return settings, case


def _claim(arguments: argparse.Namespace) -> None:
    from dewing_sysid import figures
    files = {f'--{name}': getattr(arguments, name) for name in ('out', 'mat', 'json', 'records')}
    outputs.claim(files | outputs.within(arguments.figures, figures.FILES), arguments.force,
                  [arguments.source])


def _convective_times(duration: float | None, case: Case) -> float | None:
    from dewing_sim.scales import Scales
    if duration is None:
        return None
    options.steps_of(duration, case.numerics.time_step, 's')
    return duration / Scales.of(case.flow, case.membrane.chord).time


def _experiment(arguments: argparse.Namespace, settings: Settings, case: Case, names) -> tuple:
    """Trim the wing, run every experiment; return what was found, the identity and the start."""
    from dewing_sim.build import build_wing
    from dewing_sysid.identify import identify_plant
    with bar('preparing', 's', arguments.quiet) as show:
        built = build_wing(case, show)
    began = time.perf_counter()
    with bar('experiments', 's', arguments.quiet) as show:
        found = identify_plant(built.plant, built.rest, built.identity, settings, names,
                               options.workers(arguments), lambda share: show(share, 1.0))
    return found, built.identity, began


def _deliver(arguments: argparse.Namespace, metrics: dict[str, Any]) -> None:
    """Write every metric, print the short ones."""
    if arguments.json:
        results.write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        flat: dict[str, Any] = {}
        for name in SHOWN:
            value = metrics[name]
            nested = {f'{name}.{key}': item for key, item in value.items()} \
                if isinstance(value, dict) else {name: value}
            flat.update(nested)
        results.print_table(flat)

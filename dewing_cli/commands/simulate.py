# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate a wing offline, under a constant voltage or under a controller.

The run starts from the trimmed rest state of the case. A --voltage other than that of the case is
a step at t = 0. Averages, amplitudes and spectra leave out the first --skip seconds. The end that
Ctrl-C, SIGTERM or SIGHUP asks for keeps the run up to there. For SIGKILL and power cuts, what is
there is in OUT.partial, written every few seconds until OUT is.
"""

import argparse
import warnings
from typing import Any, Iterator, NamedTuple

from dewing_cli import options, outputs, results
from dewing_cli.progress import Laps, bar, until_interrupted
from dewing_sim.parameters import Case


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    command = parser.add_argument_group('command').add_mutually_exclusive_group()
    command.add_argument('--voltage', type=float, metavar='V',
                         help='constant voltage (default: that of the case)')
    command.add_argument('--controller', metavar='NAME|FILE',
                         help='close the loop with the controller of a YAML file')
    late = parser.add_argument_group('late commands')
    late.add_argument('--delay', type=int, default=0, metavar='STEPS',
                      help='obey the controller so many steps late (default: 0)')
    late.add_argument('--jitter', type=float, default=0.0, metavar='SHARE',
                      help='share of its commands that comes a step later still (default: 0)')
    options.add_numerics(parser, 's')
    parser.add_argument('--skip', type=float, metavar='S',
                        help='leave out the first S seconds of the averages (default: half)')
    parser.add_argument('--every', type=int, default=10, metavar='N',
                        help='keep the membrane shape of every N-th step (default: 10)')
    parser.add_argument('--save-state', metavar='FILE',
                        help='write the last state of the wing as npz, for dewing plot')
    options.add_results(parser, 'write the whole run as npz')
    parser.set_defaults(duration=0.2)


def run(arguments: argparse.Namespace) -> None:
    """Simulate, then write and print the metrics, also of an interrupted run."""
    case, settings, steps = _check(arguments)

    from dewing_cli.run_metrics import Watch
    from dewing_sim.records.history import Recorder
    from dewing_sim.records.partial import Partial
    with bar('preparing', 's', arguments.quiet) as show:
        loop = _prepare(case, arguments, settings, steps, show)
    recorder, laps, state = Recorder(loop.plant.case, arguments.every), Laps(), None
    watch, partial = Watch(loop.plant.fluid, steps), Partial(arguments.out, recorder)
    try:
        with bar('simulating', 's', arguments.quiet) as show:
            for instant in until_interrupted(loop.steps):
                state, outputs = instant
                recorder.add(outputs)
                watch.add(state.flow)
                laps.add()
                partial.keep()
                show(len(recorder), steps, outputs.time)
    finally:
        if len(recorder):
            _keep(arguments.save_state, state, loop.plant.case)
            history = recorder.history()
            metrics = _metrics(arguments, case, loop, history, laps) | watch.metrics()
            _deliver(arguments, case, metrics, history)
            partial.remove()


def _check(arguments: argparse.Namespace) -> tuple[Case, Any, int]:
    """Return case, controller settings (or None) and steps, all checked before any work."""
    case = options.load_case(arguments)
    from dewing_sim.records.partial import path_of
    settings = None
    if arguments.controller:
        from dewing_control.settings import ControllerSettings
        from dewing_sim import parameters
        settings = parameters.load(arguments.controller, ControllerSettings)
    options.within('--delay', arguments.delay, 0, 1000, 'steps')
    options.within('--jitter', arguments.jitter, 0.0, 1.0, '')
    steps = options.steps_of(arguments.duration, case.numerics.time_step, 's')
    options.within('--every', arguments.every, 1, 1_000_000, 'steps')
    options.check_skip(arguments.skip, steps, case.numerics.time_step, 's')
    outputs.claim({'--out': arguments.out, '--json': arguments.json,
                   '--save-state': arguments.save_state, 'the run so far':
                   path_of(arguments.out)}, arguments.force,
                  options.read_files(arguments.case, arguments.controller))
    _check_voltage(arguments.voltage, case)
    return case, settings, steps


def _check_voltage(voltage: float | None, case: Case) -> None:
    """Raise `BadInput` for a voltage that the membrane of ``case`` cannot take."""
    from dewing_sim.identity import loss_of_tension
    from dewing_sim.structure.material.limits import require_tension
    voltages = {'--voltage': voltage, 'actuation.voltage': case.actuation.voltage}
    require_tension(case.membrane.prestretch, loss_of_tension(case)**0.5, {
        name: value for name, value in voltages.items() if value is not None})
    if voltage is not None:
        options.within('--voltage', voltage, 0.0, case.actuation.voltage_limit, 'V')
        _warn_of_breakdown(voltage, case)


def _warn_of_breakdown(voltage: float, case: Case) -> None:
    from dewing_sim.structure.material.limits import breakdown_warning
    membrane = case.membrane
    field = voltage * membrane.prestretch * membrane.prestretch_lateral / (
        membrane.initial_thickness)
    warning = breakdown_warning(field, case.actuation.breakdown_field)
    if warning:
        warnings.warn(f'{voltage:.0f} V is {warning}', RuntimeWarning, stacklevel=2)


class Loop(NamedTuple):
    """A plant, its outputs at rest and the run to come."""

    plant: Any
    rest: Any
    steps: Iterator


def _prepare(case: Case, arguments: argparse.Namespace, settings: Any, steps: int, show) -> Loop:
    """Trim the wing and return the run under the controller or the constant voltage."""
    from dewing_sim.build import build_wing
    from dewing_sim.inputs.base import Inputs
    from dewing_sim.plant import rollout
    built = build_wing(case, show)
    wing, rest = built.plant, built.rest
    if settings:
        from dewing_control.trial.closed_loop import closed_loop, controller
        from dewing_control.trial.late import late
        made = late(controller(settings, built.identity), arguments.delay, arguments.jitter)
        run = closed_loop(wing, rest, made, steps)
    else:
        voltage = case.actuation.voltage if arguments.voltage is None else arguments.voltage
        run = rollout(wing, rest, lambda _: Inputs(voltage**2), steps)
    return Loop(wing, wing.observe(rest), run)


def _keep(path: str | None, state: Any, case: Case) -> None:
    if path:
        from dewing_sim.rest import checkpoint
        checkpoint.save(path, state, case)


def _deliver(arguments: argparse.Namespace, case: Case, metrics: dict, history) -> None:
    if arguments.out:
        history.save(arguments.out, arguments.force)
    if arguments.controller:
        _warn_of_breakdown(metrics['v_max'], case)
    results.deliver(arguments, metrics)


def _metrics(arguments, case: Case, loop: Loop, history, laps: Laps) -> dict:
    import numba

    from dewing_cli.run_metrics import averages
    from dewing_sim.records.spectrum import peaks
    end = float(history.time[-1])
    start = 0.5 * end if arguments.skip is None or arguments.skip >= end else arguments.skip
    late = history.since(start)
    return {
        'case': arguments.case, 'engine': loop.plant.case.numerics.engine,
        'grid': case.numerics.grid,
        'dt': loop.plant.dt, 'steps': len(history), 'duration': end, 'averaged_from': start,
        **averages(late, loop.plant.reference_deflection), **_relative(late, loop),
        'v_min': float(late.voltage.min()), 'v_max': float(late.voltage.max()),
        'clipped_steps': int(history.clipped[-1]),
        'rtf': end / laps.total, 'ms_per_step': 1.0e3 * laps.best(),
        'threads': numba.get_num_threads(),
        'spectrum_peaks_hz': peaks(late.cl, loop.plant.dt, scale=1.0),
        'camber_peaks_hz': peaks(late.camber_mean, loop.plant.dt,
                                 scale=loop.plant.reference_deflection),
    }


def _relative(late, loop: Loop) -> dict[str, float]:
    """Return mean camber and its amplitude relative to rest, nothing of a wing flat at rest."""
    from dewing_sim.identity import LEAST
    from dewing_sim.records.spectrum import relative
    passive = loop.rest.camber_mean
    if not abs(passive) > LEAST * loop.plant.reference_deflection:
        return {}
    mean, amplitude = relative(late.camber_mean, passive)
    return {'camber_mean_relative': mean, 'camber_amplitude_relative': amplitude}

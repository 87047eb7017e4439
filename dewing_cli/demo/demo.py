# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's section 3.3 as processes over ROS 2: the wing under a disturbance, open and closed.

Each run is a simulator, a recorder and, closed, a controller, in a ROS domain of their own. All
results are computed from the recorded bags.
"""

import sys
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from dewing_cli import options, outputs
from dewing_cli.demo import realtime
from dewing_cli.demo import results as demo_results
from dewing_cli.demo.graph import SIMULATOR, graph
from dewing_cli.progress import bar
from dewing_cli.results import write_json
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.files import check_free, is_stream, target_of
from dewing_sim.machine.signals import Stop
from dewing_sim.parameters import Case
from dewing_sim.records import bag

RUNS = ('open_loop', 'closed_loop')


@dataclass(frozen=True)
class Demo:
    """What is run for how long (s of simulated time), and the folder of the results."""

    case: Case
    settings: ControllerSettings
    duration: float
    out: Path
    quiet: bool = False
    realtime: float = 0.0       # s that the wing for real time is flown for afterwards

    def bag(self, name: str) -> Path:
        """Return the bag of one of `RUNS`."""
        return self.out / f'{name}.mcap'

    @property
    def results(self) -> list[Path]:
        """Every file the demo writes."""
        others = ('case.yaml', 'closed_loop.png', 'metrics.json')
        return [*map(self.bag, RUNS), *(self.out / name for name in others)]


def run(arguments: Namespace) -> None:
    """Run the demo as the command line asks, then print its table."""
    case = options.load_case(arguments)
    options.steps_of(arguments.duration, case.numerics.time_step, 's')
    settings = parameters.load(arguments.controller, ControllerSettings)
    options.within('--realtime', arguments.realtime, 0.0, 1.0e4, 's')
    demo = Demo(case, settings, arguments.duration, Path(arguments.out), arguments.quiet,
                arguments.realtime)
    outputs.claim({path.name: path for path in demo.results} | {'--json': arguments.json},
                  arguments.force, options.read_files(arguments.case, arguments.controller))
    metrics = perform(demo, arguments.force)
    if arguments.json:
        write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        demo_results.print_table(metrics)
        if 'realtime' in metrics:
            print('real time:', realtime.sentence(metrics['realtime']))
        print('figure:', demo.out / 'closed_loop.png')


def perform(demo: Demo, overwrite: bool = False) -> dict[str, Any]:
    """Run open and closed loop, write figure and metrics, and return the metrics.

    Raises `BadInput` if results exist and may not be overwritten, `RunFailed` if a process fails.
    An interrupt stops all processes in order, says which bags are kept, and goes on up.
    """
    began = perf_counter()
    for path in demo.results:
        check_free(path, overwrite)
        if not is_stream(path):
            target_of(path).unlink(missing_ok=True)
    demo.out.mkdir(parents=True, exist_ok=True)
    (demo.out / 'case.yaml').write_text(parameters.to_yaml(demo.case), encoding='utf-8')
    try:
        with Stop() as stop:
            trim(demo)
            stop.orderly = True
            for name in RUNS:
                record(demo, name, stop)
                stop.check()
            flown = realtime.fly(demo.realtime, demo.quiet, stop) if demo.realtime else None
            stop.check()
    except KeyboardInterrupt:
        report_kept(demo)
        raise
    return evaluate(demo, began, flown)


def trim(demo: Demo) -> None:
    """March the wing to its rest state, once: the simulators find it in the cache.

    Raises `BadInput` if the controller cannot be designed for this wing.
    """
    from dewing_control.trial.closed_loop import controller
    from dewing_sim.build import build_wing
    with bar('trim', quiet=demo.quiet) as show:
        controller(demo.settings, build_wing(demo.case, show).identity)


def record(demo: Demo, name: str, stop: Stop) -> None:
    """Run one of `RUNS` to its end, or until ``stop`` is asked for, and leave its bag."""
    closed = name == 'closed_loop'
    with graph() as nodes:
        nodes.start('dewing_sim.ros.recorder', {'output': demo.bag(name).resolve()})
        if closed:
            nodes.start('dewing_control.node', {
                name: value for name, value, _ in parameters.leaves(demo.settings)}
                | {'command.subscribers': 2})
        simulator = nodes.start(SIMULATOR, {
            'case': (demo.out / 'case.yaml').resolve(), 'run.duration': demo.duration,
            'run.mode': 'lockstep' if closed else 'free', 'run.subscribers': 2 if closed else 1})
        session = nodes.session()
        clock = session.watch_clock()
        with bar(name.replace('_', ' '), quiet=demo.quiet) as show:
            nodes.wait(name, simulator, session, stop,
                       lambda: show(clock.time, demo.duration, clock.time))


def report_kept(demo: Demo) -> None:
    """Say which bags an interrupted demo leaves, and how far they reach."""
    for name in RUNS:
        try:
            end = bag.series(demo.bag(name), demo_results.MEASUREMENT)['time'][-1]
        except BadInput:
            continue
        print(f'dewing: kept {demo.bag(name)} up to {end:.4f} s', file=sys.stderr)


def evaluate(demo: Demo, began: float, flown: dict[str, Any] | None) -> dict[str, Any]:
    """Write figure and metrics of the recorded bags and of the real-time wing; return them."""
    runs = {name: demo_results.Run.read(demo.bag(name)) for name in RUNS}
    metrics = demo_results.metrics(runs, demo.case, demo.settings.command.voltage_limit,
                                   demo.duration)
    demo_results.draw(runs, demo.settings.reference.target - 1.0, demo.out / 'closed_loop.png')
    if flown:
        metrics['realtime'] = flown
    metrics['seconds'] = perf_counter() - began
    write_json(demo.out / 'metrics.json', metrics)
    return metrics

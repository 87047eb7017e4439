# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate a wing at every combination of some parameters, on all cores or a cluster.

--vary flow.angle_of_attack_deg=2.0,4.0 names a parameter of the case and its values; each point
runs from its rest state under its actuation.voltage. The points run in processes of this machine,
or on the dask cluster at --scheduler. Results go to one netCDF file as they come, so the same
command goes on where it was stopped. A point that fails is recorded with its reason; the exit
status is 1 only if no point succeeded.
"""

import argparse
from pathlib import Path
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim.errors import BadInput
from dewing_sim.files import is_stream
from dewing_sim.machine import jobs
from dewing_sim.machine.signals import undisturbed

SHOWN = ('cl_mean', 'cl_amplitude', 'cd_mean', 'strouhal', 'camber_mean', 'y_star',
         'camber_max_x_c')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    group = parser.add_argument_group('sweep')
    group.add_argument('--vary', action='append', required=True, metavar='KEY=A,B,C',
                       help='a parameter of the case and its values; may be repeated')
    group.add_argument('--retry', action='store_true', help='compute failed points again')
    options.add_workers(parser, 'its cores')
    options.add_numerics(parser, 's')
    parser.add_argument('--skip', type=float, metavar='S',
                        help='leave out the first S seconds of the averages (default: half)')
    options.add_results(parser, 'netCDF file of the results (default: out/sweep.nc)')
    parser.set_defaults(duration=0.2, out='out/sweep.nc')


def run(arguments: argparse.Namespace) -> int:
    """Compute what is missing, then print and write what there is, also when interrupted."""
    from dewing_cli.sweep.file import require_extra
    require_extra()
    table = _check(arguments)
    workers = options.workers(arguments, jobs.cores)
    known = int((table.status > 0).sum())
    try:
        with bar('sweeping', 'points', arguments.quiet) as show:
            _compute(arguments, table, workers, show)
    finally:
        if table.status.any():
            _deliver(arguments, table, known)
    from dewing_cli.sweep.sweep import DONE
    return 0 if (table.status == DONE).any() else 1


def _check(arguments: argparse.Namespace) -> Any:
    """Return the table to be filled, with every option checked before any work."""
    from dewing_cli.sweep.file import Table, resume
    from dewing_cli.sweep.sweep import Sweep, parse_axes
    case = options.load_case(arguments)
    skip = 0.5 * arguments.duration if arguments.skip is None else arguments.skip
    sweep = Sweep(case, parse_axes(arguments.vary), arguments.duration, skip)
    for point in sweep.points:
        dt = point.case.numerics.time_step
        options.check_skip(arguments.skip, options.steps_of(arguments.duration, dt, 's'), dt, 's')
    options.workers(arguments, jobs.cores)
    reads = options.read_files(arguments.case)
    outputs.claim({'--json': arguments.json}, arguments.force, reads)
    outputs.claim({'--out': arguments.out, '--json': arguments.json}, True, reads)
    if is_stream(arguments.out):
        raise BadInput(f'--out {arguments.out} is no file; a sweep writes it after every point')
    if Path(arguments.out).exists() and not arguments.force:
        return resume(sweep, arguments.out, arguments.retry)
    return Table(sweep)


def _compute(arguments: argparse.Namespace, table: Any, workers: Any, show: Any) -> None:
    """Run the points that are missing, writing the file whenever some have come."""
    from dewing_cli.sweep.sweep import MISSING, run_points
    sweep = table.sweep
    wanted = [point for point in sweep.points if table.status[point.index] == MISSING]
    finished = len(sweep.points) - len(wanted)
    show(finished, len(sweep.points))
    for batch in run_points(sweep, wanted, workers):
        with undisturbed():
            for point, result in batch:
                table.put(point.index, sweep.fingerprint(point), result)
            table.save(arguments.out, overwrite=True)
        finished += len(batch)
        show(finished, len(sweep.points))


def _deliver(arguments: argparse.Namespace, table: Any, known: int) -> None:
    from dewing_cli.sweep.sweep import STATUS
    rows = _rows(table)
    counts = {name: sum(row['status'] == name for row in rows) for name in STATUS}
    if arguments.json:
        results.write_json(arguments.json, {
            'points': rows, 'counts': counts, 'reused': known,
            'duration': table.sweep.duration, 'averaged_from': table.sweep.skip}, arguments.force)
    if not arguments.quiet:
        keys = [axis.key for axis in table.sweep.axes]
        print('\n'.join(_lines(rows, keys)))
        said = ', '.join(f'{count} {name}' for name, count in counts.items() if count)
        print(f'{said}; {known} of them from before; {arguments.out}')


def _rows(table: Any) -> list[dict[str, Any]]:
    """Return one record a point: varied values, status, reason and metrics."""
    from dewing_cli.sweep.sweep import STATUS
    rows = []
    for point in table.sweep.points:
        result = table.result(point.index)
        varied = {axis.key: axis.values[k] for axis, k in zip(table.sweep.axes, point.index)}
        rows.append(varied | {'status': STATUS[result.status], 'reason': result.reason}
                    | result.metrics)
    return rows


def _lines(rows: list[dict[str, Any]], keys: list[str]) -> list[str]:
    """Return the table as aligned text; a failed point shows its reason."""
    names = [*keys, *SHOWN]
    cells = [[_cell(row.get(name)) for name in names] for row in rows]
    widths = [max(map(len, column)) for column in zip(names, *cells)]
    lines = ['  '.join(name.rjust(width) for name, width in zip(names, widths))]
    for row, line in zip(rows, cells):
        shown = len(names) if row['status'] == 'done' else len(keys)
        text = '  '.join(cell.rjust(width) for cell, width in zip(line[:shown], widths))
        lines.append(text + (f"  {row['status']}: {row['reason']}" if shown < len(names) else ''))
    return lines


def _cell(value: Any) -> str:
    if value is None:
        return '-'
    return f'{value:.5g}' if isinstance(value, float) else str(value)

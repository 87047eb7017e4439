# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compute every result of the paper's section 3 anew and write one report.

Writes report.html (one file, no network needed), paper.json and csv/*.csv into --out, with the
finished runs in --out/runs: they are used again while their case, options and code are
unchanged, also after an interrupt. --quick takes coarse grids and short averages and says so.
Exit status 1 if a run failed; the report then says which.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim.files import new_file
from dewing_sim.fluid import engines
from dewing_sim.machine.signals import undisturbed

REPORT, NUMBERS, SERIES, RUNS = 'report.html', 'paper.json', 'csv', 'runs'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('--quick', action='store_true',
                        help='coarse grids, short averages: under two minutes on two cores')
    parser.add_argument('--engine', metavar='NAME',
                        help=f'main flow solver: {", ".join(engines.NAMES)} (default: '
                             f'{engines.NAMES[0]}, with --quick {engines.NAMES[1]}); the other '
                             'one runs beside it')
    options.add_workers(parser)
    options.add_results(parser, 'folder of report, numbers and finished runs (default: out/paper)')
    parser.set_defaults(out='out/paper')


def run(arguments: argparse.Namespace) -> int:
    """Compute what is not there yet, then write the report; return 1 if a run failed."""
    from dewing_cli.paper.plan import make
    engine = arguments.engine or engines.NAMES[1 if arguments.quick else 0]
    options.one_of('--engine', engine, dict.fromkeys(engines.NAMES))
    workers = options.workers(arguments)
    folder = Path(arguments.out)
    outputs.claim(outputs.within(folder, (REPORT, NUMBERS)) | {'--json': arguments.json},
                  arguments.force)
    plan = make(engine, arguments.quick)
    found, seconds = compute(plan, folder, workers, arguments.quiet)
    record = write(plan, found, folder, seconds)
    if arguments.json:
        results.write_json(arguments.json, record, arguments.force)
    if not arguments.quiet:
        show(record)
        print('report:', folder / REPORT)
    return 1 if record['failures'] else 0


def compute(plan: Any, folder: Path, where: Any, quiet: bool) -> tuple[dict, float]:
    """Return the results of all runs and the seconds spent; keep each as it finishes."""
    import time

    from dewing_cli.paper.report.record import file_name
    from dewing_cli.paper.runs import workers
    from dewing_cli.paper.runs.result import fingerprint, keep, recall
    marks = {name: fingerprint(name, plan.runs) for name in plan.runs}
    paths = {name: folder / RUNS / f'{file_name(name)}.npz' for name in plan.runs}
    kept = {name: recall(paths[name], marks[name]) for name in plan.runs}
    known = {name: result for name, result in kept.items() if result is not None}
    finished = set(known)

    def finish(name: str, result: Any) -> None:
        with undisturbed():
            keep(paths[name], result, marks[name])
            finished.add(name)

    began = time.perf_counter()
    try:
        with bar(f'{len(plan.runs) - len(known)} runs', quiet=quiet) as progress:
            found = workers.execute(plan.runs, known, where, finish, progress)
    except KeyboardInterrupt:
        print(f'dewing: kept {len(finished)} of {len(plan.runs)} runs in {folder / RUNS}',
              file=sys.stderr)
        raise
    return found, time.perf_counter() - began


def write(plan: Any, found: dict, folder: Path, seconds: float) -> dict[str, Any]:
    """Write report, numbers and series; return the numbers."""
    from dewing_cli.paper.report import html, record, sections
    from dewing_cli.paper.report.section import Found
    made = sections.make(plan, Found(found))
    numbers = record.metrics(plan, made, found, seconds)
    record.write_series(folder / SERIES, made, overwrite=True)
    results.write_json(folder / NUMBERS, numbers, overwrite=True)
    with new_file(folder / REPORT, overwrite=True) as file:
        file.write(html.page(plan, made, numbers).encode())
    return numbers


def show(record: dict[str, Any]) -> None:
    """Print the table of the paper's quantities."""
    width = max(len(row['quantity']) for row in record['rows'])
    print(f'{"quantity":{width}}  {"paper":>9}  {"ours":>9}  {"error":>8}  difference')
    for row in record['rows']:
        cells = [f'{row[name]:.4g}' if row[name] is not None else '-' for name in (
            'paper', 'ours')]
        error = f'{row["error"]:.1g}' if row['error'] else '-'
        share = f'{100.0 * row["difference"]:+.1f} %' if row['difference'] is not None else '-'
        print(f'{row["quantity"]:{width}}  {cells[0]:>9}  {cells[1]:>9}  {error:>8}  '
              f'{share:>8}  {row["unit"]}'.rstrip())

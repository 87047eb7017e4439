# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Compare the solvers with independent codes and closed forms.

Prints a table of ours, reference, source, difference and gate; exit status 1 if a gate fails. The
full suite takes about ten minutes on two cores, --quick about one.
"""

import argparse

from dewing_cli import options, outputs, results
from dewing_cli.progress import bar
from dewing_sim.fluid import engines


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('--quick', action='store_true', help='only what takes about a minute')
    parser.add_argument('--engine', action='append', metavar='NAME',
                        help=f'verify this flow solver: {", ".join(engines.NAMES)} or '
                             'package.module:Class; may be repeated (default: all of dewing)')
    options.add_workers(parser, 'idle cores')
    options.add_results(parser, 'folder of the page verification.md and its images')


def run(arguments: argparse.Namespace) -> int:
    """Verify, print the table, write what was asked for."""
    chosen = list(dict.fromkeys(arguments.engine or engines.NAMES))
    for engine in chosen:
        options.check_engine(engine)
    from dewing_sim.machine.jobs import idle_cores
    workers = options.workers(arguments, idle_cores)
    from dewing_sim.verification import report, suite
    images = [] if arguments.quick else map(report.image, suite.STUDIES)
    outputs.claim(outputs.within(arguments.out, [report.PAGE, *images])
                  | {'--json': arguments.json}, arguments.force)
    with bar('verifying', quiet=arguments.quiet) as show:
        verification = suite.verify(chosen, arguments.quick, workers, show)
    if not arguments.quiet:
        print(report.text_table(verification.all_checks))
        print(f'{report.summary(verification)}; {verification.seconds:.0f} s')
    if arguments.json:
        results.write_json(arguments.json, {
            'cases': [check.to_mapping() for check in verification.all_checks],
            'seconds': verification.seconds}, arguments.force)
    if arguments.out:
        report.write(verification, arguments.out, arguments.force)
    return 1 if verification.missed else 0

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Say what a recorded bag holds, or draw it.

``info`` lists topics, messages, runs, the plant and the last words of the nodes; ``plot`` draws
camber and voltage against simulated time. Bags of ``ros2 bag record`` and of our recorder are read
alike, also those of a recorder that was killed or that are damaged: what is lost is counted.
"""

import argparse
from pathlib import Path

from dewing_cli import options, outputs, results
from dewing_sim.errors import BadInput

ACTIONS = {'info': None, 'plot': None}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('action', metavar='ACTION', help=' or '.join(ACTIONS))
    parser.add_argument('file', metavar='FILE', help='MCAP file')
    parser.add_argument('--run', dest='number', type=int, metavar='N',
                        help='run to plot, as info numbers them; a reset begins a new one')
    options.add_results(parser, 'PNG to draw into (default: FILE with .png)')


def run(arguments: argparse.Namespace) -> None:
    """Describe or draw the bag."""
    options.one_of('ACTION', arguments.action, ACTIONS)
    if arguments.action == 'info' and arguments.number is not None:
        raise BadInput('info lists every run: --run is for plot')
    out = None
    if arguments.action == 'plot':
        out = Path(arguments.out or Path(arguments.file).with_suffix('.png'))
    outputs.claim({'--json': arguments.json, '--out': out}, arguments.force, [arguments.file])
    if arguments.action == 'info':
        _info(arguments)
    else:
        _plot(arguments, out)


def _info(arguments: argparse.Namespace) -> None:
    from dewing_sim.records import bag_summary
    summary = bag_summary.summary(arguments.file)
    if arguments.json:
        results.write_json(arguments.json, summary, arguments.force)
    if not arguments.quiet:
        print('\n'.join(bag_summary.lines(summary)))


def _plot(arguments: argparse.Namespace, out: Path) -> None:
    from dewing_sim.records import bag_summary
    metrics = bag_summary.draw(arguments.file, out, arguments.force, arguments.number)
    if arguments.json:
        results.write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        print('figure:', out)

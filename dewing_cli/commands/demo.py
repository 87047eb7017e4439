# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Show the closed loop over ROS 2: simulator and controller as two processes.

Runs the wing under the 10 Hz disturbance of the paper's section 3.3, first passive, then with the
controller, and writes picture, metrics and recording into --out. Then the wing of the case
realtime flies for a few seconds under its own controller, and how fast it went is told.
"""

import argparse

from dewing_cli import options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    parser.add_argument('--controller', default='controller', metavar='NAME|FILE',
                        help='controller of the closed loop (default: controller)')
    options.add_numerics(parser, 's')
    parser.add_argument('--realtime', type=float, default=3.0, metavar='S',
                        help='time that the case realtime is flown for afterwards, 0: not at all '
                             '(default: 3)')
    options.add_results(parser, 'folder of the results (default: out/demo)')
    parser.set_defaults(out='out/demo', disturbance='fig5', duration=0.4)


def run(arguments: argparse.Namespace) -> int | None:
    """Run the demonstration."""
    from dewing_cli.demo import demo
    return demo.run(arguments)

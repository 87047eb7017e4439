# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Show the closed loop over ROS 2: simulator and controller as two processes.

Runs the wing under the 10 Hz disturbance of the paper's section 3.3, first passive, then with the
controller, and writes picture, metrics and recording into --out.
"""

import argparse

from dewing_cli import options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.add_case(parser)
    parser.add_argument('--controller', default='controller', metavar='NAME|FILE',
                        help='controller of the closed loop (default: controller)')
    options.add_numerics(parser, 's')
    options.add_results(parser, 'folder of the results (default: out/demo)')
    parser.set_defaults(out='out/demo', disturbance='fig5', duration=0.4)


def run(arguments: argparse.Namespace) -> int | None:
    """Run the demonstration."""
    from dewing_cli.demo import demo
    return demo.run(arguments)

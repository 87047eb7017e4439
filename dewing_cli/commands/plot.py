# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the flow of a saved state: vorticity, streamlines and the membrane.

STATE is an npz that the simulator node or `dewing simulate --save-state` wrote; the case and the
engine are inside. Deflections are drawn exaggerated, and labelled so.
"""

import argparse
from pathlib import Path
from typing import Any, Iterator

from dewing_cli import options, outputs
from dewing_cli.progress import bar, until_interrupted
from dewing_sim.errors import BadInput
from dewing_sim.files import new_file

FRAMES = 40
SUFFIXES = {True: ('.gif', '.mp4'), False: ('.png', '.pdf', '.svg')}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument('state', metavar='STATE', help='saved state of a wing, npz')
    parser.add_argument('--exaggeration', type=float, default=20.0, metavar='X',
                        help='factor on all deflections drawn (default: 20)')
    parser.add_argument('--limit', type=float, default=25.0, metavar='U/C',
                        help='vorticity of the deepest colour (default: 25)')
    parser.add_argument('--film', type=float, metavar='S',
                        help=f'march on for S seconds and write a film of {FRAMES} frames, GIF or '
                             '(with ffmpeg) MP4')
    group = parser.add_argument_group('results')
    group.add_argument('--out', metavar='FILE',
                       help='picture, PNG, PDF or SVG (default: beside STATE)')
    group.add_argument('--force', action='store_true', help='write over an existing file')
    group.add_argument('--quiet', action='store_true', help='no progress and no message')


def run(arguments: argparse.Namespace) -> None:
    """Draw the picture or the film."""
    options.within('--exaggeration', arguments.exaggeration, 1.0, 1000.0, '')
    options.within('--limit', arguments.limit, 1.0e-3, 1.0e6, 'U/c')
    filming = arguments.film is not None
    path = Path(arguments.out or Path(arguments.state).with_suffix(SUFFIXES[filming][0]))
    if path.suffix not in SUFFIXES[filming]:
        raise BadInput(f'{path}: the file name must end in one of '
                       f"{', '.join(SUFFIXES[filming])}")
    outputs.claim({'--out': path}, arguments.force, [arguments.state])
    from dewing_cli.figures import flow as flow_figure
    from dewing_sim.rest import checkpoint
    from dewing_sim.wing import Wing
    state, case = checkpoint.load(arguments.state), checkpoint.load_case(arguments.state)
    wing = Wing(case)
    if filming:
        _film(arguments, wing, state, path)
    else:
        shown = flow_figure.picture(wing, state, arguments.exaggeration)
        with new_file(path, arguments.force) as file:
            flow_figure.figure(shown, arguments.limit).savefig(file, format=path.suffix[1:])
    if not arguments.quiet:
        print(path)


def _film(arguments: argparse.Namespace, wing: Any, state: Any, path: Path) -> None:
    import tempfile

    from dewing_cli.figures import flow as flow_figure
    from dewing_cli.figures.flow import picture
    from dewing_sim.inputs.base import Inputs
    steps = options.steps_of(arguments.film / FRAMES, wing.dt, 's')

    def states() -> Iterator[Any]:
        now = state
        for frame in range(FRAMES):
            yield now
            for _ in range(steps):
                now = wing.step(now, Inputs(now.v_squared))
            show(frame + 1, FRAMES)

    with bar('filming', 'frames', arguments.quiet) as show, \
            tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / path.name
        flow_figure.animate((picture(wing, each, arguments.exaggeration)
                             for each in until_interrupted(states())), draft, arguments.limit)
        with new_file(path, arguments.force) as file:
            file.write(draft.read_bytes())

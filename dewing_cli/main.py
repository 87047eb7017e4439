# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The command ``dewing``: one sentence on standard error for every failure.

Exit status: 0 done, 1 the run or a gate failed, 2 bad input; interrupted 130 by Ctrl-C, 143 by
SIGTERM and 129 by SIGHUP, with what was computed kept alike.
"""

import argparse
import importlib
import io
import os
import pkgutil
import sys
import warnings
from contextlib import suppress
from types import ModuleType
from typing import Sequence

from dewing_cli import commands
from dewing_sim.errors import BadInput, DewingError
from dewing_sim.machine.signals import Stop, status_of

# The small systems of a step gain nothing from threads, and one thread rounds as the nodes do.
THREADS = ('OPENBLAS_NUM_THREADS', 'OMP_NUM_THREADS', 'MKL_NUM_THREADS', 'NUMBA_NUM_THREADS')
DONE, FAILED, BAD_INPUT = 0, 1, 2


class Parser(argparse.ArgumentParser):
    """A parser that raises `BadInput` and takes no abbreviated options."""

    def __init__(self, **settings):
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message):
        """Raise `BadInput` in place of printing the usage and exiting."""
        raise BadInput(f'{message}; see {self.prog} --help')


def command_modules() -> dict[str, ModuleType]:
    """Return the modules of all commands by name."""
    names = sorted(module.name for module in pkgutil.iter_modules(commands.__path__))
    return {name: importlib.import_module(f'{commands.__name__}.{name}') for name in names}


def build_parser() -> Parser:
    """Return the parser of every command."""
    parser = Parser(prog='dewing', description='Membrane wings of dielectric elastomer: simulate '
                    'and control them.', epilog='dewing COMMAND --help explains a command.')
    subparsers = parser.add_subparsers(
        dest='command', required=True, metavar='COMMAND', parser_class=Parser)
    for name, module in command_modules().items():
        summary, _, details = module.__doc__.partition('\n')
        command = subparsers.add_parser(
            name, help=summary, description=summary, epilog=details.strip() or None,
            formatter_class=argparse.RawDescriptionHelpFormatter)
        module.add_arguments(command)
        command.set_defaults(run=module.run)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``dewing`` with ``argv`` (default: the command line); return the exit status."""
    for name in THREADS:
        os.environ.setdefault(name, '1')
    _write_every_character()
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            with Stop():
                arguments = build_parser().parse_args(argv)
                return arguments.run(arguments) or DONE
        except BadInput as error:
            return _complain(error, BAD_INPUT)
        except (DewingError, OSError) as error:
            return _complain(error, FAILED)
        except KeyboardInterrupt as error:
            return _complain('interrupted', status_of(error))


def _write_every_character() -> None:
    """Let both outputs write what their encoding lacks as an escape, not end in an exception."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors='backslashreplace')


def _complain(error: object, status: int) -> int:
    with suppress(OSError):             # of a terminal that is gone
        print('dewing:', ' '.join(str(error).split()), file=sys.stderr)
    return status


def _show_warning(message, category, filename, lineno, file=None, line=None) -> None:
    print('dewing: warning:', ' '.join(str(message).split()), file=file or sys.stderr)

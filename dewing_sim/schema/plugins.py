# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Parts from outside the package: a word ``package.module:Name`` in a YAML file names one."""

import importlib
import os
import re
import sys
from typing import Any

from dewing_sim.errors import BadInput

PATTERN = re.compile(r'[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*')


def is_plugin(word: str) -> bool:
    """Return whether ``word`` has the form of a part from outside."""
    return PATTERN.fullmatch(word) is not None


def load(word: str, what: str) -> Any:
    """Return the object that ``package.module:Name`` names; the working folder is looked in too.

    ``what`` opens the sentence of the `BadInput` that is raised if there is none.
    """
    if not is_plugin(word):
        raise BadInput(f'{what} = {word!r} is not of the form package.module:Name')
    module, _, name = word.partition(':')
    try:
        return getattr(_module(module), name)
    except AttributeError:
        raise BadInput(f'{what} = {word!r}: the module {module} has no {name}') from None
    except Exception as error:          # whatever a foreign module raises as it is loaded
        raise BadInput(f'{what} = {word!r}: {module} cannot be imported '
                       f'({type(error).__name__}: {error})') from error


def _module(name: str) -> Any:
    """Import a module; a console script does not look in the working folder by itself."""
    folder = os.getcwd()
    if folder not in sys.path and '' not in sys.path:
        sys.path.append(folder)
    return importlib.import_module(name)

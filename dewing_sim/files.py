# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Result files: never half written, never written over another unasked, read with one sentence."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Iterator

import numpy as np
import yaml

from dewing_sim.errors import BadInput


def check_free(path: str | Path, overwrite: bool = False,
               way_out: str = '--force writes over it') -> Path:
    """Return ``path`` if a file may be written there; raise `BadInput` otherwise.

    ``way_out`` is what who may not overwrite can do about it.

    Commands call it before a long computation, so that the result is not lost at its end.
    """
    path = Path(path)
    if path.is_dir():
        raise BadInput(f'{path} is a folder, not a file')
    if path.exists() and not overwrite:
        raise BadInput(f'{path} exists; {way_out}')
    folder = path.parent
    while not folder.exists():
        folder = folder.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise BadInput(f'{path}: {folder} is not a folder that can be written to')
    return path


@contextmanager
def new_file(path: str | Path, overwrite: bool = False) -> Iterator[BinaryIO]:
    """Open a binary file that appears at ``path``, with its folders, once it is complete."""
    path = check_free(path, overwrite)
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor, temporary = tempfile.mkstemp(dir=path.parent, prefix=f'.{path.name}.')
    try:
        with os.fdopen(descriptor, 'wb') as file:
            yield file
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


@contextmanager
def read_npz(path: str | Path, what: str) -> Iterator[dict[str, np.ndarray]]:
    """Give the arrays of an npz file to a block that makes ``what``, such as 'a model', of them.

    Whatever is wrong with the file, or with the arrays for the block, becomes `BadInput`.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except FileNotFoundError:
        raise BadInput(f'{path}: no such file') from None
    except Exception as error:          # numpy and zipfile raise some ten kinds
        raise BadInput(f'{path}: not {what} ({_sentence(error)})') from None
    try:
        yield arrays
    except BadInput as error:
        raise error if str(path) in str(error) else BadInput(f'{path}: {error}') from None
    except (KeyError, IndexError, ValueError, TypeError, AttributeError, OverflowError,
            RecursionError, yaml.YAMLError) as error:
        raise BadInput(f'{path}: not {what} ({_sentence(error)})') from None


def _sentence(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f'it holds no {error}'
    return ' '.join(str(error).split()) or type(error).__name__

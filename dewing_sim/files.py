# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Result files: never half written, never written over another unasked, read with one sentence."""

import io
import os
import re
import stat
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

    ``way_out`` is what who may not overwrite can do about it. A symbolic link stands for what it
    leads to, and a stream, see `is_stream`, is always free.

    Commands call it before a long computation, so that the result is not lost at its end.
    """
    path = Path(path)
    try:
        if not is_stream(path):
            _check_file(path, overwrite, way_out)
        elif not os.access(path, os.W_OK):
            raise BadInput(f'{path} cannot be written to')
    except OSError as error:
        raise BadInput(f'{path} cannot be written ({error.strerror})') from None
    return path


def _check_file(path: Path, overwrite: bool, way_out: str) -> None:
    target = target_of(path)
    _check_lengths(path, target)
    if target.is_symlink():
        raise BadInput(f'{path} is a link that leads in circles')
    if target.is_dir():
        raise BadInput(f'{path} is a folder, not a file')
    if target.exists():
        if not target.is_file():
            raise BadInput(f'{path} is neither a file nor a stream')
        if not overwrite:
            raise BadInput(f'{path} exists; {way_out}')
    folder = _nearest_folder(target)
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        raise BadInput(f'{path}: {folder} is not a folder that can be written to') from None


def _check_lengths(path: Path, target: Path) -> None:
    most = os.pathconf(_nearest_folder(target), 'PC_NAME_MAX')
    for name in target.parts:
        if len(os.fsencode(name)) > most:
            raise BadInput(f'{path}: a name of {len(os.fsencode(name))} bytes is too long: '
                           f'at most {most}')


def _nearest_folder(target: Path) -> Path:
    """Return the parent, or the nearest folder above it that is there."""
    folder = target.parent
    while not os.path.lexists(folder):
        folder = folder.parent
    return folder


def target_of(path: str | Path) -> Path:
    """Return where ``path`` leads to over symbolic links, whether or not a file is there."""
    return Path(os.path.realpath(path))


def is_stream(path: str | Path) -> bool:
    """Return whether what is written to ``path`` goes elsewhere at once.

    So it is with character devices and pipes, and with open files that go by their descriptor,
    such as ``/dev/stdout``.
    """
    try:
        mode = os.stat(path).st_mode
    except OSError:
        return False
    if stat.S_ISREG(mode):
        return _DESCRIPTOR.fullmatch(os.path.abspath(path)) is not None
    return stat.S_ISCHR(mode) or stat.S_ISFIFO(mode)


_DESCRIPTOR = re.compile(r'/dev/(stdout|stderr|fd/\d+)|/proc/[^/]+/fd/\d+')


@contextmanager
def new_file(path: str | Path, overwrite: bool = False) -> Iterator[BinaryIO]:
    """Open a binary file that appears at ``path``, with its folders, once it is complete.

    Where ``path`` is a stream, see `is_stream`, the whole is written to it then.
    """
    if is_stream(check_free(path, overwrite)):
        whole = io.BytesIO()
        yield whole
        with open(path, 'ab') as stream:
            stream.write(whole.getvalue())
        return
    path = target_of(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor, temporary = tempfile.mkstemp(dir=path.parent, prefix='.dewing.')
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

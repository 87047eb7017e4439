# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""All files that a command will write, checked together before it computes anything."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from dewing_sim.errors import BadInput
from dewing_sim.files import check_free, is_stream, target_of


def claim(files: Mapping[str, str | Path | None], overwrite: bool = False,
          reads: Iterable[str | Path | None] = ()) -> None:
    """Raise `BadInput` unless every one of ``files`` may be written, and each is another.

    ``files`` are by the words for them in messages, such as the option; None is not written.
    None of them may be among the files that the command ``reads``.
    """
    sources = {target_of(path) for path in reads if path is not None}
    taken: dict[Path, str] = {}
    for name, path in files.items():
        if path is None:
            continue
        check_free(path, overwrite)
        if is_stream(path):
            continue
        target = target_of(path)
        if target in sources:
            raise BadInput(f'{name} {path} is a file that the command reads')
        for other, whose in taken.items():
            if target == other:
                raise BadInput(f'{name} {path} and {whose} are the same file')
            if target in other.parents or other in target.parents:
                raise BadInput(f'{name} {path} and {whose} cannot both be: one is a folder')
        taken[target] = f'{name} {path}'


def within(folder: str | Path | None, names: Iterable[str]) -> dict[str, Path]:
    """Return the files ``names`` of the folder of results, for `claim`; none without one."""
    if folder is None:
        return {}
    return {name: Path(folder) / name for name in names}

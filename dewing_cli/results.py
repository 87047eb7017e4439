# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Metrics as a table on the terminal and as JSON in a file."""

import json
from pathlib import Path
from typing import Any, Mapping

from dewing_sim.errors import RunFailed
from dewing_sim.files import new_file


def write_json(path: str | Path, metrics: Mapping[str, Any], overwrite: bool = False) -> None:
    """Write ``metrics``; raise `RunFailed` rather than write a number that is not finite."""
    try:
        text = json.dumps(metrics, indent=2, allow_nan=False) + '\n'
    except ValueError:
        raise RunFailed(f'{path}: a metric is not finite') from None
    with new_file(path, overwrite) as file:
        file.write(text.encode())


def print_table(metrics: Mapping[str, Any]) -> None:
    """Print names and values, six digits each, on standard output."""
    width = max(map(len, metrics))
    for name, value in metrics.items():
        print(f'{name:{width}}  {_short(value)}')


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f'{value:.6g}'
    if isinstance(value, list):
        return ', '.join(map(_short, value)) or '-'
    return str(value)


def deliver(arguments: Any, metrics: Mapping[str, Any]) -> None:
    """Write and print ``metrics`` as --json, --force and --quiet ask."""
    if arguments.json:
        write_json(arguments.json, metrics, arguments.force)
    if not arguments.quiet:
        print_table(metrics)

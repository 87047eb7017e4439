# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The report's numbers as JSON and its series as CSV."""

import csv
import io
import re
from pathlib import Path
from typing import Any, Mapping

import numpy as np

from dewing_cli.paper.plan import Plan
from dewing_cli.paper.report.section import Section
from dewing_cli.paper.runs.workers import Failure
from dewing_sim.errors import RunFailed
from dewing_sim.files import new_file
from dewing_sim.identity import version

DIGITS = '.10g'


def metrics(plan: Plan, sections: list[Section], results: Mapping[str, Any], seconds: float,
            ) -> dict[str, Any]:
    """Return everything for JSON; ``rows`` is the table of the report."""
    return {
        'rows': [row.to_mapping() for section in sections for row in section.rows],
        'quick': plan.quick, 'engine': plan.engine, 'grids': plan.extent.grids,
        'version': version(), 'seconds': seconds,
        'failures': {name: result.reason for name, result in results.items()
                     if isinstance(result, Failure)},
        'sections': {section.name: {
            'title': section.title, 'values': section.values,
            'tables': [{'caption': table.caption, 'header': table.header, 'rows': table.rows}
                       for table in section.tables],
            'series': sorted(section.series)} for section in sections}}


def write_series(folder: Path, sections: list[Section], overwrite: bool) -> None:
    """Write every series to ``folder``, one CSV file each; raise `RunFailed` for NaN."""
    for section in sections:
        for name, columns in section.series.items():
            path = folder / f'{file_name(name)}.csv'
            with new_file(path, overwrite) as file:
                file.write(table(path, columns).encode())


def file_name(name: str) -> str:
    """Return ``name`` with nothing that a file system dislikes."""
    return re.sub(r'[^\w.-]+', '_', name).strip('_')


def table(path: Path, columns: Mapping[str, np.ndarray]) -> str:
    """Return CSV with a header; raise `RunFailed` for a column that is not finite."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(columns)
    for name, column in columns.items():
        if column.dtype.kind == 'f' and not np.isfinite(column).all():
            raise RunFailed(f'{path}: {name} is not finite')
    for row in zip(*columns.values(), strict=True):
        writer.writerow([item if isinstance(item, str) else format(item, DIGITS)
                         for item in row])
    return text.getvalue()

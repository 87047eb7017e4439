# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a section of the report is made of."""

from dataclasses import dataclass, field
from typing import Any, Mapping

import numpy as np

from dewing_cli.paper.runs.result import Result
from dewing_cli.paper.runs.workers import Failure
from dewing_sim.errors import DewingError


@dataclass(frozen=True)
class Row:
    """A quantity of the paper beside ours.

    ``error`` is the standard error of an average, from eight blocks; ``spread`` the largest change
    of ``ours`` with grid, time step and engine, where these were varied.
    """

    quantity: str
    paper: float | None
    ours: float
    unit: str = ''
    error: float | None = None
    spread: float | None = None
    explanation: str = ''
    bound: bool = False             # whether the paper's value is an upper bound

    @property
    def difference(self) -> float | None:
        """(ours - paper) / |paper|, None for a bound."""
        if self.bound or self.paper in (None, 0.0):
            return None
        return (self.ours - self.paper) / abs(self.paper)

    def to_mapping(self) -> dict[str, Any]:
        """Return the record for JSON."""
        return {**{name: value if value is None or isinstance(value, (str, bool)) else float(value)
                   for name, value in vars(self).items()},
                'difference': None if self.difference is None else float(self.difference)}


@dataclass(frozen=True)
class Table:
    """Cells as they are shown."""

    caption: str
    header: tuple[str, ...]
    rows: list[tuple[str, ...]]


@dataclass(frozen=True)
class Figure:
    """A picture as a file in memory, its alternative text and its caption."""

    name: str
    caption: str
    data: bytes
    kind: str = 'png'


@dataclass
class Section:
    """A part of the report; ``series`` become CSV files, columns by name with units."""

    name: str
    title: str
    text: list[str] = field(default_factory=list)
    figures: list[Figure] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    series: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    values: dict[str, Any] = field(default_factory=dict)


class Missing(DewingError):
    """A run that a section needs has failed."""


class Found:
    """Results by name of run; asking for one that failed raises `Missing`."""

    def __init__(self, results: Mapping[str, Result | Failure]):
        """Hold ``results``."""
        self.results = results

    def __getitem__(self, name: str) -> Result:
        """Return the result of the run ``name``."""
        result = self.results[name]
        if isinstance(result, Failure):
            raise Missing(f'{name}: {result.reason}')
        return result

    def __contains__(self, name: str) -> bool:
        """Return whether the run was planned and did not fail."""
        return isinstance(self.results.get(name), Result)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What verification is made of: runs that compute, checks that compare, studies that explain."""

from dataclasses import dataclass
from typing import Any, Callable, Protocol


class Run(Protocol):
    """A computation for a process of its own: hashable, picklable, shared between studies."""

    engine: str

    @property
    def cost(self) -> float:
        """Expected time in arbitrary units; the most expensive runs start first."""

    def __call__(self) -> Any:
        """Return the result, which depends on nothing but the fields of the run."""


@dataclass(frozen=True)
class Check:
    """A value beside its reference.

    The difference is (value - reference) / scale; ``scale`` is the reference itself unless given,
    and 1 for an absolute difference. Without ``reference`` or ``gate`` the value is reported only.
    """

    name: str
    engine: str
    value: float
    reference: float | None
    source: str
    gate: float | None = None       # largest admissible |difference|
    scale: float | None = None
    error: float | None = None      # standard error of the value, where it is an average

    @property
    def difference(self) -> float | None:
        """Signed difference, a fraction of the scale."""
        if self.reference is None:
            return None
        return (self.value - self.reference) / abs(self.scale or self.reference)

    @property
    def passed(self) -> bool:
        """Whether the difference lies within the gate; true where there is none."""
        return self.gate is None or abs(self.difference) <= self.gate

    def to_mapping(self) -> dict[str, Any]:
        """Return the record that goes to JSON."""
        return {'name': self.name, 'engine': self.engine, 'value': float(self.value),
                'reference': self.reference, 'source': self.source,
                'difference': self.difference, 'scale': self.scale or self.reference,
                'gate': self.gate, 'error': self.error, 'passed': bool(self.passed)}


@dataclass(frozen=True)
class Study:
    """One question asked to every engine.

    ``runs(engine, quick)`` names the computations, none where the study does not apply;
    ``checks(engine, results)`` judges their results, under the same names. ``draw(figure,
    {engine: results})`` fills a matplotlib figure; only full suites draw.
    """

    name: str
    title: str
    text: str
    runs: Callable[[str, bool], dict[str, Run]]
    checks: Callable[[str, dict[str, Any]], list[Check]]
    draw: Callable[[Any, dict[str, dict[str, Any]]], None] | None = None

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers by name, whose names are not known beforehand."""

from collections.abc import Iterator, Mapping


class Numbers(Mapping):
    """Named numbers, immutable and comparable: what an open section holds."""

    def __init__(self, values: Mapping[str, float]):
        """Keep the values in the order of their names."""
        self._values = dict(sorted(values.items()))

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return f'Numbers({self._values})'

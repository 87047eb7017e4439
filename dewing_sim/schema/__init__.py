# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Declared fields with unit, meaning and range, and what is read into them, checked."""

from dewing_sim.schema.declarations import (
    Section,
    check,
    choice,
    count,
    describe,
    fields,
    flag,
    from_mapping,
    leaves,
    numbers,
    outside_modules,
    real,
    replace,
    shown,
    text,
    to_mapping,
)
from dewing_sim.schema.named_numbers import Numbers

__all__ = [
    'Numbers', 'Section', 'check', 'choice', 'count', 'describe', 'fields', 'flag',
    'from_mapping', 'leaves', 'numbers', 'outside_modules', 'real', 'replace', 'shown', 'text',
    'to_mapping',
]

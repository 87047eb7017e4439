# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Docstrings are prose, names in back quotes and indented equations; this makes them reST.

Indented paragraphs become literal blocks; what reST would read as markup stays what it is.
"""

import re

QUOTED = re.compile(r'(``.+?``|`[^`]+`)')
MARKUP = re.compile(r'([*|\\]|_(?=\W|$))')


def to_rest(lines):
    """Return the lines of a docstring as reST."""
    text, inside = [], False
    for line in lines:
        indented = line.startswith('    ')
        if indented and not inside:
            text += ['', '::', '']
        elif inside and not indented and line.strip():
            text.append('')
        if line.strip():
            inside = indented
        text.append(line if inside else _escape(line))
    return [*text, '']


def _escape(line):
    parts = QUOTED.split(line)
    parts[::2] = [MARKUP.sub(r'\\\1', part) for part in parts[::2]]
    parts[1::2] = [part if part.startswith('``') else f'`{part}`' for part in parts[1::2]]
    return ''.join(parts)


def _process(app, what, name, obj, options, lines):
    lines[:] = to_rest(lines)


def setup(app):
    """Convert every docstring of the API reference."""
    app.connect('autodoc-process-docstring', _process)
    return {'parallel_read_safe': True, 'parallel_write_safe': True}

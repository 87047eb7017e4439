# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Equations as MathML, which every browser draws itself: no script, no font, no network."""

from docutils.utils.math import MathError, latex2mathml
from sphinx.errors import ExtensionError


def _mathml(node, block):
    source = node.astext()
    if block and '\\\\' in source and r'\begin{' not in source:
        source = rf'\begin{{aligned}}{source}\end{{aligned}}'
    try:
        return latex2mathml.tex2mathml(source, as_block=block)
    except MathError as error:
        raise ExtensionError(f'{node.source}:{node.line}: {source!r}: {error}') from error


def _visit_inline(translator, node):
    translator.body.append(_mathml(node, block=False))
    _skip()


def _visit_block(translator, node):
    translator.body.append('<div class="math" style="overflow: auto hidden; padding: 0.3em 0">'
                           f'{_mathml(node, block=True)}</div>')
    _skip()


def _skip():
    from docutils.nodes import SkipNode
    raise SkipNode


def setup(app):
    """Offer the renderer ``mathml``."""
    app.add_html_math_renderer('mathml', (_visit_inline, None), (_visit_block, None))
    return {'parallel_read_safe': True, 'parallel_write_safe': True}

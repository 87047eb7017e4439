# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Pages that read as plain Markdown on a forge: what only the site needs is added here.

The links of index.md, in their order, are the navigation. A link to a module leads to its page in
the API reference, one to any other file of the repository to a copy of it; Markdown files that
are no pages are only named.
"""

import re

MODULE = re.compile(
    r'\]\((?:\.\./)+(dewing_(?:sim|sysid|control|cli)(?:/\w+)*?)(?:/__init__)?\.py\)')
PACKAGE = re.compile(r'\]\((?:\.\./)+(dewing_(?:sim|sysid|control|cli)(?:/\w+)*)/?\)')
PACKAGES = ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')
OUTSIDE = re.compile(r'\[([^]]+)\]\((?:\.\./)+\w+\.md[^)]*\)')
SECTION = re.compile(r'^## (.+)$', re.M)
PAGE = re.compile(r'\]\(((?!\.\./)[\w/-]+)\.md\)')


def _read(app, docname, content):
    text = content[0]
    for pattern in (MODULE, PACKAGE):
        text = pattern.sub(r'](/autoapi/\1/index.rst)', text)
    text = OUTSIDE.sub(r'\1', text)
    if docname == 'index':
        text += _navigation(text)
    content[0] = text


def _navigation(text):
    """Return a hidden toctree for each section of the front page."""
    parts = SECTION.split(text)
    trees = []
    for title, body in zip(parts[1::2], parts[2::2]):
        pages = PAGE.findall(body)
        if 'api' in pages:
            pages += [f'autoapi/{package}/index' for package in PACKAGES]
        if pages:
            trees.append('\n'.join([f'```{{toctree}}\n:hidden:\n:caption: {title}\n', *pages,
                                    '```']))
    return '\n\n' + '\n\n'.join(trees) + '\n'


def setup(app):
    """Complete each page as it is read."""
    app.connect('source-read', _read)
    return {'parallel_read_safe': True, 'parallel_write_safe': True}

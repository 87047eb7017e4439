# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How Sphinx builds the site of `make docs`; the pages themselves are plain Markdown."""

import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
PROJECT = DOCS.parent
sys.path.insert(0, str(DOCS / 'extensions'))

project = 'dewing'
author = 'The dewing authors'
copyright = f'2026, {author}'   # noqa: A001
release = re.search(r"version='([^']+)'", (PROJECT / 'setup.py').read_text())[1]

extensions = ['myst_parser', 'autoapi.extension', 'mathml', 'plain_docstrings', 'plain_pages']
nitpicky = False                # docstrings name private helpers too
smartquotes = False
suppress_warnings = [
    'autoapi.python_import_resolution',     # libraries are not installed here
    'ref.python',                           # an annotation may fit classes of several modules
]

html_theme = 'furo'
html_title = f'dewing {release}'
html_show_sphinx = False
html_math_renderer = 'mathml'
html_copy_source = False

myst_enable_extensions = ['dollarmath']
myst_heading_anchors = 4

autoapi_dirs = [str(PROJECT / name) for name in (
    'dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')]
autoapi_options = ['members', 'undoc-members', 'show-inheritance', 'show-module-summary']
autoapi_add_toctree_entry = False
autoapi_python_class_content = 'both'
autoapi_member_order = 'bysource'

linkcheck_timeout = 20
linkcheck_retries = 2
linkcheck_anchors = False

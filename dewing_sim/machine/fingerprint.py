# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a result was computed with: the text of a module and of all that it imports.

Results that are kept on disk carry this fingerprint, so that a change of any source that took
part makes them void. The import statements themselves say which sources these are: a file that
is moved or added cannot be forgotten.
"""

import ast
import hashlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path

OURS = ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')


def fingerprint(*modules: str) -> str:
    """Return a hash of the sources of ``modules`` and of everything of ours that they import.

    Imports inside functions count as well. Modules outside dewing, such as a user's own law, are
    followed within their own top-level package.
    """
    digest = hashlib.sha256()
    for name, text in sorted(sources(*modules).items()):
        digest.update(f'{name}\n'.encode() + text)
    return digest.hexdigest()


@cache
def sources(*modules: str) -> dict[str, bytes]:
    """Return the text of every module that a `fingerprint` covers, by name."""
    tops = {*OURS, *(name.partition('.')[0] for name in modules)}
    found: dict[str, bytes] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        if name in found or name.partition('.')[0] not in tops:
            continue
        path = _source(name)
        if path is None:
            continue                    # not a module: a class or function of one
        found[name] = path.read_bytes()
        package = name if path.name == '__init__.py' else name.rpartition('.')[0]
        waiting += _imported(found[name], package)
        if '.' in name:
            waiting.append(name.rpartition('.')[0])     # its package is run as well
    return found


def _source(name: str) -> Path | None:
    """Return the file of a module, None if there is none of that name."""
    try:
        spec = find_spec(name)
    except (ImportError, AttributeError, ValueError):
        return None
    if spec is None or not spec.origin or not spec.origin.endswith('.py'):
        return None
    return Path(spec.origin)


def _imported(text: bytes, package: str) -> list[str]:
    """Return the dotted names that a source in ``package`` imports, of modules or of parts."""
    names = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ''
            if node.level:
                above = package.split('.')[:len(package.split('.')) - node.level + 1]
                base = '.'.join([*above, *filter(None, [node.module])])
            names += [base, *(f'{base}.{alias.name}' for alias in node.names)]
    return names

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What a result was computed with: the text of a module and of all that it imports.

Results that are kept on disk carry this fingerprint, so that a change of any source that took
part makes them void. The import statements themselves say which sources these are: a file that
is moved or added cannot be forgotten.
"""

import ast
import hashlib
import os
import re
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Iterable, NamedTuple

OURS = ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')
# A parser takes ten times as long. What these do not cover, `UNUSUAL` finds, and is parsed.
IMPORT = re.compile(r'^[ \t]*(?:from[ \t]+([.\w]+)[ \t]+import[ \t]*'
                    r'(\((?:[^)#]|#[^\n]*)*\)|[^\n(]+)|import[ \t]+([^\n]+))', re.MULTILINE)
UNUSUAL = re.compile(r'[;:][ \t]*(?:import|from)[ \t(]|import[ \t(][^\n]*[;\\]'
                     r'|\bfrom\b[^\n]*\\\n|^[ \t]*from[ \t]+\.+[ \t]+\w', re.MULTILINE)
COMMENT = re.compile(r'#[^\n]*')


class Source(NamedTuple):
    """A module's file, a hash of its text, and the modules of ours or of its own that it needs."""

    path: str
    digest: str
    imports: tuple[str, ...]


def fingerprint(*modules: str) -> str:
    """Return a hash of the sources of ``modules`` and of everything of ours that they import.

    Imports inside functions count as well. Modules outside dewing, such as a user's own law, are
    followed within their own top-level package.
    """
    lines = [f'{name} {source.digest}\n' for name, source in sorted(sources(*modules).items())]
    return hashlib.sha256(''.join(lines).encode()).hexdigest()


def sources(*modules: str) -> dict[str, Source]:
    """Return every module that a `fingerprint` covers, by name."""
    tops = {*OURS, *(name.partition('.')[0] for name in modules)}
    found: dict[str, Source] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        if name in found or name.partition('.')[0] not in tops:
            continue
        source = _source(name)
        if source is None:
            continue                    # not a module: a class or function of one
        found[name] = source
        waiting += source.imports
        if '.' in name:
            waiting.append(name.rpartition('.')[0])     # its package is run as well
    return found


@cache
def _source(name: str) -> Source | None:
    """Read a module, once in a process; None if there is none of that name."""
    path = _path(name)
    if path is None:
        return None
    text = Path(path).read_bytes()
    package = name if os.path.basename(path) == '__init__.py' else name.rpartition('.')[0]
    return Source(path, hashlib.sha256(text).hexdigest(),
                  tuple(imported(text.decode('utf-8', 'replace'), package)))


def _path(name: str) -> str | None:
    """Return the file of a module without importing anything."""
    top, *inner = name.split('.')
    for folder in _folders(top) if inner else ():
        base = os.path.join(folder, *inner)
        for path in (os.path.join(base, '__init__.py'), base + '.py'):
            if os.path.isfile(path):
                return path
    spec = None if inner else _spec(top)
    return spec.origin if spec and spec.origin and spec.origin.endswith('.py') else None


@cache
def _folders(top: str) -> tuple[str, ...]:
    spec = _spec(top)
    return tuple(spec.submodule_search_locations or ()) if spec else ()


def _spec(top: str):
    try:
        return find_spec(top)
    except (ImportError, AttributeError, ValueError):
        return None


def imported(text: str, package: str) -> list[str]:
    """Return the dotted names that a source in ``package`` imports, of modules or of parts."""
    if UNUSUAL.search(text):
        return imported_by_parser(text, package)
    names = []
    for module, parts, plain in IMPORT.findall(text):
        listed = _listed(parts or plain)
        names += _from(module, listed, package) if module else listed
    return names


def _listed(text: str) -> list[str]:
    """Return the names of ``(a as b, c)``, comments and all."""
    items = COMMENT.sub('', text).strip(' \t\r\n()').split(',')
    return [item.split()[0] for item in items if item.strip()]


def imported_by_parser(text: str, package: str) -> list[str]:
    """Return what `imported` does, of any source."""
    names = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += _from('.' * node.level + (node.module or ''),
                           [alias.name for alias in node.names], package)
    return names


def _from(module: str, names: Iterable[str], package: str) -> list[str]:
    """Return the names of ``from module import names``; leading dots count from ``package``."""
    base = module.lstrip('.')
    if level := len(module) - len(base):
        above = package.split('.')[:len(package.split('.')) - level + 1]
        base = '.'.join([*above, *filter(None, [base])])
    return [base, *(f'{base}.{name}' for name in names)]

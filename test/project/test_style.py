# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What linters do not see: licence headers, short files and functions, finished work."""

import ast
import re
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
HEADER = ('# Copyright 2026 The dewing authors\n'
          '# SPDX-License-Identifier: Apache-2.0\n')
FOLDERS = ('config', 'dewing_cli', 'dewing_control', 'dewing_sim', 'dewing_sysid', 'docs',
           'examples', 'scripts', 'test')
PYTHON = sorted(path.relative_to(PROJECT) for folder in FOLDERS
                for path in (PROJECT / folder).rglob('*.py'))
MODULES = [path for path in PYTHON if path.parts[0].startswith('dewing_')]
LONGEST_FILE = 250
LONGEST_FUNCTION = 45
MOST_ARGUMENTS = 8          # by position
# Decorators of compiled functions, which take no keywords; a signature names types.
KERNELS = {'kernel', 'checked_kernel', 'summing_kernel', 'lean_kernel', 'stage', 'part',
           'lean_part', 'formula', 'compiled', 'KERNEL', 'KERNEL_INSIDE'}
SIGNATURES = {'types.int64'}


def read(path: Path) -> str:
    return (PROJECT / path).read_text(encoding='utf-8')


@pytest.mark.parametrize('path', [*PYTHON, Path('setup.py')], ids=str)
def test_a_file_starts_with_copyright_and_licence(path):
    assert read(path).startswith(HEADER)


@pytest.mark.parametrize('path', PYTHON, ids=str)
def test_nothing_is_left_to_be_done(path):
    marker = '|'.join(['TO' + 'DO', 'FIX' + 'ME', 'X' * 3, 'NotImplemented' + 'Error'])
    assert not re.search(rf'\b({marker})\b', read(path))


@pytest.mark.parametrize('path', MODULES, ids=str)
def test_files_and_functions_are_short(path):
    assert len(read(path).splitlines()) <= LONGEST_FILE
    for node in ast.walk(ast.parse(read(path))):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            length = node.end_lineno - node.lineno + 1
            assert length <= LONGEST_FUNCTION, f'{node.name} has {length} lines'


def calls_outside_kernels(node):
    """Yield the calls below ``node`` that no compiled function makes."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef):
            names = {ast.unparse(each).partition('(')[0] for each in child.decorator_list}
            if names & KERNELS:
                continue
        if isinstance(child, ast.Call):
            yield child
        yield from calls_outside_kernels(child)


@pytest.mark.parametrize('path', MODULES, ids=str)
def test_a_call_names_its_arguments_where_there_are_many(path):
    for call in calls_outside_kernels(ast.parse(read(path))):
        if ast.unparse(call.func) not in SIGNATURES:
            assert len(call.args) <= MOST_ARGUMENTS, f'{call.lineno}: {ast.unparse(call.func)}'


@pytest.mark.parametrize('path', MODULES, ids=str)
def test_every_module_and_public_name_has_a_docstring(path):
    tree = ast.parse(read(path))
    assert ast.get_docstring(tree)
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith('_'):
            assert ast.get_docstring(node), node.name

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Who may import whom, read from the import statements: one chain, and ROS at the rim only."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from slow_imports import SLOW

PROJECT = Path(__file__).parents[2]
CHAIN = ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')
FILES = sorted(path.relative_to(PROJECT) for package in CHAIN
               for path in (PROJECT / package).rglob('*.py'))
ROS = {'rclpy', 'builtin_interfaces', 'rcl_interfaces', 'ament_index_python'}
ROS_FILES = ('node.py', 'messages.py')     # ends of names


def imported(path: Path, everywhere: bool = True) -> set[str]:
    """Return the dotted names a file imports, or only those imported when it is loaded."""
    tree = ast.parse((PROJECT / path).read_text())
    nodes = list(ast.walk(tree)) if everywhere else _outside_functions(tree)
    names = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names.update(f'{_base(node, path)}.{alias.name}' for alias in node.names)
    return names


def _outside_functions(node) -> list[ast.AST]:
    found = []
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and getattr(child.test, 'id', '') == 'TYPE_CHECKING':
            continue                                    # never executed
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)):
            found += [child, *_outside_functions(child)]
    return found


def _base(node: ast.ImportFrom, path: Path) -> str:
    """Return the absolute module that a ``from`` import names."""
    if not node.level:
        return node.module
    package = path.parts[:-node.level]
    return '.'.join([*package, node.module] if node.module else package)


def is_ros(name: str) -> bool:
    top = name.split('.')[0]
    return top in ROS or top.endswith(('_msgs', '_srvs'))


@pytest.mark.parametrize('path', FILES, ids=str)
def test_packages_import_only_down_the_chain(path):
    above = CHAIN[CHAIN.index(path.parts[0]) + 1:]
    assert not [name for name in imported(path) if name.split('.')[0] in above]


@pytest.mark.parametrize('path', FILES, ids=str)
def test_ros_appears_only_at_the_rim(path):
    if not path.name.endswith(ROS_FILES) and path.parts[:2] != ('dewing_sim', 'ros'):
        assert not [name for name in imported(path) if is_ros(name)]


@pytest.mark.parametrize('path', FILES, ids=str)
def test_what_is_slow_or_optional_is_imported_where_it_is_used(path):
    assert not [name for name in imported(path, everywhere=False)
                if {name.split('.')[0], '.'.join(name.split('.')[:2])} & SLOW]


@pytest.mark.parametrize('side, other', [('structure', 'fluid'), ('fluid', 'structure')])
def test_structure_and_fluid_do_not_know_each_other(side, other):
    files = [path for path in FILES if path.parts[:2] == ('dewing_sim', side)]
    assert files
    for path in files:
        assert not [name for name in imported(path) if f'dewing_sim.{other}' in name], path


@pytest.mark.parametrize('side', ['structure', 'fluid'])
def test_physics_gets_its_own_parameters_never_the_whole_case(side):
    for path in FILES:
        if path.parts[:2] == ('dewing_sim', side):
            assert 'dewing_sim.parameters.Case' not in imported(path), path
            assert 'parameters.Case' not in (PROJECT / path).read_text(), path


def modules() -> dict[str, Path]:
    """Return the files of all modules by dotted name."""
    return {'.'.join(path.with_suffix('').parts).removesuffix('.__init__'): path
            for path in FILES}


def test_no_module_imports_itself_through_others():
    """Imports inside functions count: they would only hide a circle."""
    known = modules()
    graph = {name: {found for found in (
        part if part in known else part.rpartition('.')[0] for part in imported(path))
        if found in known and found != name} for name, path in known.items()}
    assert len(graph) > 150 and graph['dewing_sim.wing'] > {'dewing_sim.rest.trim'}
    assert len(list(TopologicalSorter(graph).static_order())) == len(known)


def test_the_reader_of_imports_sees_every_form(tmp_path):
    file = tmp_path / 'dewing_sim' / 'fluid' / 'module.py'
    file.parent.mkdir(parents=True)
    file.write_text('import a.b\nfrom c import d\nfrom . import e\nfrom ..f import g\n'
                    'def later():\n    import h\nif TYPE_CHECKING:\n    import i\n')
    path = file.relative_to(tmp_path)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(globals(), 'PROJECT', tmp_path)
        loaded = {'a.b', 'c.d', 'dewing_sim.fluid.e', 'dewing_sim.f.g'}
        assert imported(path, everywhere=False) == loaded
        assert imported(path) == loaded | {'h', 'i'}

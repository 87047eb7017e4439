# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What pip, colcon and ``ros2 run`` find."""

import ast
import csv
import os
import re
import runpy
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree

import pytest
import setuptools

PROJECT = Path(__file__).parents[2]
PACKAGE = ElementTree.parse(PROJECT / 'package.xml').getroot()
EXECUTABLES = ('simulator', 'controller', 'sysid', 'recorder', 'loop')


@pytest.fixture(scope='module')
def setup():
    """Return the arguments that setup.py gives to setuptools."""
    caught = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(PROJECT)
        patch.setattr(setuptools, 'setup', caught.update)
        runpy.run_path('setup.py')
    return caught


def test_the_version_is_the_same_everywhere(setup):
    version = setup['version']
    assert PACKAGE.findtext('version') == version
    assert f'## {version}' in (PROJECT / 'CHANGELOG.md').read_text()
    assert metadata.version('dewing') == version


def test_every_module_is_in_an_installed_package(setup):
    modules = [path.relative_to(PROJECT) for path in PROJECT.glob('dewing_*/**/*.py')]
    assert {'.'.join(path.parts[:-1]) for path in modules} <= set(setup['packages'])


def test_every_data_file_exists_and_the_index_marker_is_among_them(setup):
    data = dict(setup['data_files'])
    for names in data.values():
        assert names and all((PROJECT / name).is_file() for name in names)
    assert data['share/ament_index/resource_index/packages'] == ['resource/dewing']
    assert {Path(name) for name in data['share/dewing/config']} == {
        path.relative_to(PROJECT) for path in PROJECT.glob('config/*.*') if path.suffix != '.py'}
    assert {Path(name) for name in data['share/dewing/launch']} == {
        path.relative_to(PROJECT) for path in PROJECT.glob('launch/*.py')}


def test_an_editable_environment_has_every_file_that_an_installed_one_has(setup, tmp_path):
    """``make venv`` links what setup.py copies: no documented command may miss a file."""
    environment = runpy.run_path(str(PROJECT / 'scripts' / 'environment.py'))
    old = tmp_path / 'share' / 'dewing' / 'config'      # as version 0.2.0 had it
    old.parent.mkdir(parents=True)
    old.symlink_to(PROJECT / 'config')
    (tmp_path / 'bin').mkdir()
    for name in EXECUTABLES:
        (tmp_path / 'bin' / f'dewing_{name}').touch()
    for _ in range(2):
        environment['add_to_ament_index'](tmp_path)
    found = {}
    for folder, _, names in os.walk(tmp_path):          # as `ros2 launch` looks: not into links
        found |= {Path(folder, name).relative_to(tmp_path): Path(folder, name) for name in names}
    for folder, names in setup['data_files']:
        for name in names:
            assert found[Path(folder, Path(name).name)].is_file(), name
    assert (PROJECT / 'config' / 'paper.yaml').is_file()


def test_a_new_launch_file_makes_the_environment_anew(tmp_path, monkeypatch):
    environment = runpy.run_path(str(PROJECT / 'scripts' / 'environment.py'))
    before = environment['recipe'](tmp_path, 'none', None)
    assert environment['recipe'](tmp_path, 'none', None) == before
    monkeypatch.setitem(environment['recipe'].__globals__, 'SHARED', ('config',))
    assert environment['recipe'](tmp_path, 'none', None) != before


@pytest.mark.parametrize('name', EXECUTABLES)
def test_an_executable_is_a_wrapper_of_the_console_script_of_its_name(setup, name):
    assert f'scripts/{name}' in dict(setup['data_files'])['lib/dewing']
    path = PROJECT / 'scripts' / name
    assert os.access(path, os.X_OK) and path.read_text().startswith('#!/usr/bin/env python3\n')
    module, function = re.search(r'^from (\S+) import (\S+)$', path.read_text(), re.M).groups()
    scripts = dict(entry.split(' = ') for entry in setup['entry_points']['console_scripts'])
    assert scripts[f'dewing_{name}'] == f'{module}:{function}'


def test_colcon_lists_every_executable_once():
    """Nothing but the wrappers may go where ``ros2 run`` looks."""
    assert 'script' not in (PROJECT / 'setup.cfg').read_text()


def test_every_console_script_leads_to_a_function(setup):
    for entry in setup['entry_points']['console_scripts']:
        module, function = entry.partition(' = ')[2].split(':')
        path = PROJECT / f'{module.replace(".", "/")}.py'
        assert function in [node.name for node in ast.parse(path.read_text()).body
                            if isinstance(node, ast.FunctionDef)], entry


@pytest.mark.parametrize('name', EXECUTABLES)
def test_ros2_run_finds_the_executables(name):
    packages = pytest.importorskip('ament_index_python.packages')
    path = Path(packages.get_package_prefix('dewing'), 'lib', 'dewing', name)
    assert path.is_file() and os.access(path, os.X_OK)


def test_the_ament_index_leads_to_the_shipped_parameters():
    packages = pytest.importorskip('ament_index_python.packages')
    share = Path(packages.get_package_share_directory('dewing'))
    assert (share / 'package.xml').is_file()
    assert (share / 'config' / 'paper.yaml').is_file()


DEPENDS = [element.text for kind in ('exec_depend', 'test_depend')
           for element in PACKAGE.iter(kind)]
KEYS = {row[0]: row[-1] for row in csv.reader(
    (PROJECT / 'test' / 'reference' / 'rosdep_keys.csv').read_text().splitlines()[3:])}
WITHOUT_KEY = {'control', 'distributed', 'osqp', 'xarray'}
BROUGHT_ALONG = {'llvmlite': 'python3-numba', 'mcap': 'mcap-ros2-support'}


def test_every_imported_ros_package_is_declared():
    imported = {'ros2launch'}           # the documentation starts the nodes by it
    for path in [*PROJECT.glob('dewing_*/**/*.py'), *PROJECT.glob('launch/*.py')]:
        imported |= set(re.findall(
            r'^\s*(?:from|import) (rclpy|launch|launch_ros|\w+_interfaces|\w+_msgs|\w+_srvs)\b',
            path.read_text(), re.M))
    assert {'rclpy', 'builtin_interfaces', 'launch_ros'} < imported
    assert imported == {key for key in DEPENDS if not key.startswith(('python3-', 'mcap'))}


def test_every_key_of_rosdep_stands_once_and_is_known_to_rosdep():
    assert len(DEPENDS) == len(set(DEPENDS))
    assert set(DEPENDS) == KEYS.keys()


def test_what_pip_would_install_rosdep_installs_too_or_the_page_says_how_to_get_it(setup):
    wanted = setup['install_requires'] + setup['extras_require']['test']
    by_pip = {re.match(r'[\w-]+', name)[0] for name in wanted}
    packages = {name.removeprefix('python3-') for name in KEYS.values()}
    packages |= {brought for brought, key in BROUGHT_ALONG.items() if key in KEYS}
    assert by_pip - {'pyyaml'} - packages == WITHOUT_KEY and 'yaml' in packages
    page = (PROJECT / 'docs' / 'getting-started.md').read_text()
    told = re.search(r"pip install (--user )?('control.*)", page)[2]
    required = {name for name in wanted + setup['extras_require']['sweep']
                if re.match(r'[\w-]+', name)[0] in WITHOUT_KEY}
    assert set(re.findall("'(.*?)'", told)) == required


def test_the_linters_look_at_all_sources_and_at_nothing_that_lies_beside_them():
    """By name: an environment of any name, or a build, may lie in the checkout."""
    text = (PROJECT / 'Makefile').read_text().replace('\\\n', ' ')
    named = set(re.search(r'^SOURCES = (.*)$', text, re.M)[1].split())
    tracked = subprocess.run(['git', 'ls-files', '*.py'], cwd=PROJECT, capture_output=True,
                             text=True, check=False).stdout.splitlines()
    ours = {path.partition('/')[0] for path in tracked} or {
        path.name for path in PROJECT.iterdir() if path.name in named}
    assert named == ours
    assert '$(BIN)/ruff check $(SOURCES)' in text and '$(BIN)/flake8 $(SOURCES)' in text


def test_package_xml_is_of_format_3_for_ament_python():
    assert PACKAGE.get('format') == '3'
    assert PACKAGE.findtext('export/build_type') == 'ament_python'
    assert PACKAGE.findtext('license') == 'Apache-2.0'


def test_ros_wheels_are_an_extra_for_the_machines_they_exist_for(setup):
    assert not [name for name in setup['install_requires'] if name.startswith('ros-')]
    for requirement in setup['extras_require']['ros']:
        assert requirement.startswith('ros-jazzy-')
        assert 'sys_platform == "linux"' in requirement and '"x86_64"' in requirement


@pytest.mark.parametrize('machine, version, source', [
    ('x86_64', (3, 10), 'wheels'), ('x86_64', (3, 13), 'wheels'), ('x86_64', (3, 14), 'none'),
    ('aarch64', (3, 12), 'none'), ('arm64', (3, 12), 'none')])
def test_ros_comes_from_wheels_where_they_exist(monkeypatch, machine, version, source):
    environment = runpy.run_path(str(PROJECT / 'scripts' / 'environment.py'))
    monkeypatch.delenv('AMENT_PREFIX_PATH')
    monkeypatch.setattr('platform.machine', lambda: machine)
    monkeypatch.setattr(sys, 'version_info', version)
    monkeypatch.setattr(sys, 'platform', 'linux')
    assert environment['ros_source']() == source
    assert 'ROS: ' in environment['REASONS'][source]


def set_up(folder) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, PROJECT / 'scripts' / 'environment.py', folder],
                          capture_output=True, text=True)


def test_the_set_up_touches_no_folder_that_is_not_an_environment(tmp_path):
    (tmp_path / 'thesis.tex').touch()
    result = set_up(tmp_path)
    assert result.returncode == 1 and 'is not a virtual environment' in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ['thesis.tex']


def test_the_environment_of_the_documentation_depends_on_its_requirements_alone(tmp_path, setup):
    environment = runpy.run_path(str(PROJECT / 'scripts' / 'environment.py'))
    requirements = PROJECT / 'docs' / 'requirements.txt'
    recipe = environment['recipe'](tmp_path, 'tools', requirements)
    assert recipe != environment['recipe'](tmp_path, 'tools', None)
    copy = tmp_path / 'copy.txt'
    copy.write_text(requirements.read_text())
    assert environment['recipe'](tmp_path, 'tools', copy) == recipe
    copy.write_text('sphinx\n')
    assert environment['recipe'](tmp_path, 'tools', copy) != recipe
    listed = re.findall(r'^[a-z]\S+$', requirements.read_text(), re.M)
    assert setup['extras_require']['docs'] == listed and len(listed) == 4


def test_without_a_usable_python_the_set_up_says_what_is_needed(tmp_path):
    result = subprocess.run(['/bin/sh', PROJECT / 'scripts' / 'find_python'],
                            env={'PATH': str(tmp_path)}, capture_output=True, text=True)
    assert result.returncode == 1 and result.stdout == ''
    assert 'needs Python 3.10 or newer' in result.stderr and result.stderr.count('\n') == 1

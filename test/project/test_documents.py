# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What README, CONTRIBUTING and docs/ show is executed, and what they link to is there."""

import argparse
import re
import runpy
import sys
from xml.etree import ElementTree

import documented_commands as documented
import numpy as np
import pytest
import yaml
from documented_commands import LONG, PAGES, PROJECT, SHORT, blocks, words

from dewing_cli import main as cli

BLOCKS = [block for page in PAGES for block in blocks(page)]
SHELL = [block for block in BLOCKS if block.language == 'sh']
RUNNABLE = [page for page in PAGES if any(
    block.language == 'python' or block.language == 'sh' and block.where == 'test'
    for block in blocks(page))]
PROSE = {page: documented.FENCE.sub('', page.read_text()) for page in PAGES}
LINK = re.compile(r'!?\[[^]]*\]\(([^)\s]+)\)')
HERE = PROJECT / 'docs'


def name(page):
    return str(page.relative_to(PROJECT))


# Commands and Python.

def test_every_block_says_what_it_is():
    assert {block.language for block in BLOCKS} <= {'sh', 'python', 'text', 'console'}
    for page, prose in PROSE.items():
        assert not re.search(r'^ *```', prose, re.M), page
        assert not re.search(r'\n\n {4}(dewing|make|python|ros2|pip)\b', prose), page


@pytest.mark.parametrize('block', SHELL, ids=lambda block: f'{block.page}: {block.lines[0]}')
def test_every_command_is_executed_by_somebody(block):
    assert block.where, 'add it to SHORT or LONG of scripts/documented_commands.py'


@pytest.mark.parametrize('page', PAGES, ids=name)
def test_every_command_in_the_text_is_executed_by_somebody(page):
    shown = {' '.join(words(line)) for block in SHELL for line in block.lines}
    for code in documented.commands_in_text(page):
        assert (' '.join(words(code)) in shown or code in documented.LONG_IN_TEXT
                or code in documented.ELSEWHERE), code


def test_nothing_is_listed_that_no_page_shows():
    first = {block.lines[0] for block in SHELL}
    assert {*LONG, *documented.BLOCKS_ELSEWHERE} <= first
    in_text = {code for page in PAGES for code in documented.commands_in_text(page)}
    assert {*documented.LONG_IN_TEXT, *documented.ELSEWHERE} <= in_text
    shown = {words(line)[1] for block in SHELL if block.where == 'test' for line in block.lines}
    assert shown == SHORT.keys()


@pytest.mark.parametrize('page', RUNNABLE, ids=name)
def test_the_commands_and_the_python_of_a_page_run(page, tmp_path, monkeypatch, cluster):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    monkeypatch.setattr(sys, 'path', [*sys.path])
    record(tmp_path / 'run.mcap')
    names = {'__name__': name(page)}
    for block in blocks(page):
        if block.language == 'python':
            file = re.fullmatch(r'# (\w+\.py)', block.lines[0])
            if file:                    # the block is this file, which later ones use
                (tmp_path / file[1]).write_text(block.text)
                sys.modules.pop(file[1].removesuffix('.py'), None)
            exec(compile(block.text, name(page), 'exec'), names)
        elif block.where == 'test':
            for line in block.lines:
                run_short(line, cluster)


def run_short(line, cluster):
    command, *arguments = words(line)[1:]
    where = ['--scheduler', cluster] if command == 'sweep' else []
    assert cli.main([command, *arguments, *SHORT[command].split(), *where]) == 0, line


@pytest.fixture(scope='module')
def cluster():
    """Return the address of a dask scheduler with one worker in this process."""
    from distributed import LocalCluster
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False,
                      dashboard_address='127.0.0.1:0') as running:
        yield running.scheduler_address


def record(path):
    """Write a bag of three measurements."""
    from dewing_sim.records import bag
    types, kind = bag._types(), 'sensor_msgs/msg/JointState'
    time, header, state = (types.types[each] for each in (
        'builtin_interfaces/msg/Time', 'std_msgs/msg/Header', kind))
    writer = bag.BagWriter(path)
    writer.add_topic('/dewing/measurement', kind)
    for step in range(3):
        message = state(header(time(0, 100_000 * step), 'wing'), ['camber_mean', 'v_squared'],
                        np.array([2.0e-5, 100.0 * step]), np.empty(0), np.empty(0))
        writer.write('/dewing/measurement', bytes(types.serialize_cdr(message, kind)),
                     step, step)
    writer.close()


# Commands within the text.

INLINE = [(page, code) for page, prose in PROSE.items()
          for code in re.findall(r'`([^`\n]+(?:\n[^`\n]+)?)`', prose)]


def subparsers():
    parser = cli.build_parser()
    return next(action for action in parser._actions
                if isinstance(action, argparse._SubParsersAction)).choices


@pytest.mark.parametrize('page, code', [(page, code) for page, code in INLINE if re.match(
    r'(\.venv/bin/)?dewing [a-z]', code)], ids=lambda value: getattr(value, 'name', value))
def test_a_command_in_the_text_exists_with_its_options(page, code):
    _, command, *arguments = code.split()
    parser = subparsers()[command]
    options = {text for action in parser._actions for text in action.option_strings}
    given = {word.strip('[](),') for word in arguments if word.lstrip('[').startswith('--')}
    assert given <= options


def test_options_and_scripts_in_the_text_exist():
    known = {text for parser in subparsers().values() for action in parser._actions
             for text in action.option_strings}
    others = {'--ros-args', '--params-file', '--bag', '--help'}
    for page, code in INLINE:
        option = re.match(r'--[\w-]+', code)
        assert not option or option[0] in known | others, (page, code)
        script = re.match(r'python ((?:scripts|benchmarks)/\w+\.py)', code)
        assert not script or (PROJECT / script[1]).is_file(), (page, code)


def test_targets_of_make_exist():
    makefile = (PROJECT / 'Makefile').read_text()
    targets = set(re.findall(r'^([\w-]+):', makefile, re.M))
    shown = {words(line)[1] for block in SHELL for line in block.lines
             if words(line)[:1] == ['make']}
    shown |= {code.split()[1] for _, code in INLINE if re.match(r'make [a-z]', code)}
    assert {'demo', 'docs', 'links', 'long'} <= shown <= targets
    assert set(re.findall(r"'make ([\w-]+)", makefile)) == targets - {'help', 'docs-venv'}


def test_ros_commands_name_executables_arguments_and_parameters_that_exist():
    launch = (PROJECT / 'launch' / 'dewing.launch.py').read_text()
    reference = (HERE / 'ros-reference.md').read_text()
    for page in PAGES:
        text = page.read_text()
        for executable in re.findall(r'(?:ros2 run dewing |dewing_)(\w+) --ros-args', text):
            assert (PROJECT / 'scripts' / executable).is_file(), page
        for parameter in re.findall(r' -p ([\w.]+):=', text):
            assert f'| `{parameter}` |' in reference, page
        for file, line in re.findall(r'ros2 launch dewing (\w+\.launch\.py)(.*)', text):
            known = launch + (PROJECT / 'launch' / file).read_text()
            for argument in re.findall(r'(\w+):=', line):
                assert f"('{argument}'," in known, page


# Links.

def anchors(page):
    """Return the anchors that a forge gives the headings of a page."""
    headings = re.findall(r'^#+ (.+)$', documented.FENCE.sub('', page.read_text()), re.M)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


@pytest.mark.parametrize('page', [*PAGES, PROJECT / 'CHANGELOG.md'], ids=name)
def test_every_link_within_the_repository_leads_somewhere(page):
    for link in LINK.findall(documented.FENCE.sub('', page.read_text())):
        if not link.startswith('http'):
            path, _, anchor = link.partition('#')
            target = (page.parent / path).resolve() if path else page
            assert target.exists() and PROJECT in target.parents, link
            assert not anchor or anchor in anchors(target), link


def test_every_page_is_in_the_navigation():
    linked = {(HERE / link).resolve() for link in LINK.findall((HERE / 'index.md').read_text())}
    assert set(HERE.glob('**/*.md')) - {HERE / 'index.md'} <= linked


# What the site adds.

def extension(name):
    return runpy.run_path(str(HERE / 'extensions' / f'{name}.py'))


def test_docstrings_become_rest_with_equations_and_names_as_they_are():
    to_rest = extension('plain_docstrings')['to_rest']
    text = ['Return a * b of `name`, with y_ and |z|:', '', '    x_n+1 = A x_n', '',
            '    y = C x', '', 'Raises ``Error``.']
    assert to_rest(text) == [
        r'Return a \* b of ``name``, with y\_ and \|z\|:', '', '', '::', '', '    x_n+1 = A x_n',
        '', '    y = C x', '', '', 'Raises ``Error``.', '']


def test_links_to_modules_lead_to_their_reference_and_the_front_page_navigates():
    read = extension('plain_pages')['_read']
    content = ['[a](../../dewing_sim/fluid/base.py) [b](../dewing_sim) [c](../README.md#limits)'
               ' [d](../dewing_sim/__init__.py) [e](ros.md)']
    read(None, 'page', content)
    assert content == ['[a](/autoapi/dewing_sim/fluid/base/index.rst)'
                       ' [b](/autoapi/dewing_sim/index.rst) c'
                       ' [d](/autoapi/dewing_sim/index.rst) [e](ros.md)']
    content = [(HERE / 'index.md').read_text()]
    read(None, 'index', content)
    trees = re.findall(r'^```{toctree}\n(?::.*\n)+\n((?:.+\n)+?)```$', content[0], re.M)
    pages = [page for tree in trees for page in tree.split()]
    assert {f'{page}.md' for page in pages if not page.startswith('autoapi')} == {
        str(page.relative_to(HERE)) for page in HERE.glob('**/*.md')} - {'index.md'}
    assert [page for page in pages if page.startswith('autoapi')] == [
        f'autoapi/{package}/index'
        for package in ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')]


# What scripts write.

def test_the_figure_of_the_architecture_is_that_of_its_script():
    svg = runpy.run_path(str(PROJECT / 'scripts' / 'architecture.py'))['svg']()
    assert (HERE / 'images' / 'architecture.svg').read_text() == svg, (
        'run: python scripts/architecture.py')
    assert ElementTree.fromstring(svg).tag.endswith('svg')


def test_the_citation_is_of_format_1_2_0():
    citation = yaml.safe_load((PROJECT / 'CITATION.cff').read_text())
    assert {'cff-version', 'message', 'title', 'authors'} <= citation.keys() <= {
        'abstract', 'authors', 'cff-version', 'commit', 'contact', 'date-released', 'doi',
        'identifiers', 'keywords', 'license', 'license-url', 'message', 'preferred-citation',
        'references', 'repository', 'repository-artifact', 'repository-code', 'title', 'type',
        'url', 'version'}       # all that the schema of 1.2.0 admits
    assert citation['cff-version'] == '1.2.0' and citation['type'] == 'software'
    assert citation['license'] == 'Apache-2.0'
    assert str(citation['version']) == ElementTree.parse(
        PROJECT / 'package.xml').getroot().findtext('version')
    assert all('name' in who for who in citation['authors'])
    paper, = citation['references']
    assert paper.keys() >= {'authors', 'title', 'type'} and paper['type'] == 'conference-paper'
    assert [who['family-names'] for who in paper['authors']] == ['Buoso', 'Palacios']
    assert paper['conference'].keys() == {'name'} and paper['year'] == 2015

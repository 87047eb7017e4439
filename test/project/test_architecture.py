# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""docs/architecture.md tells the truth: its tree is the real one, and its walk that of a V^2."""

import re
from pathlib import Path

import pytest
from walk import files_of

from dewing_sim import parameters
from dewing_sim.lockstep import LockStep
from dewing_sim.rest import trim
from dewing_sim.wing import Wing

PROJECT = Path(__file__).parents[2]
PAGE = (PROJECT / 'docs' / 'architecture.md').read_text(encoding='utf-8')
PACKAGES = ('dewing_sim', 'dewing_sysid', 'dewing_control', 'dewing_cli')
ENGINES = {'conformal': ('realtime', 5.0e-4), 'finite_volume': ('fast', 2.0e-4)}
LONGEST_WALK = 15           # files, those within an engine counted as one


def section(title):
    """Return the text below a heading."""
    return dict(part.split('\n', 1) for part in re.split('^## ', PAGE, flags=re.M)[1:])[title]


def drawn():
    """Return the paths of the tree on the page."""
    found, package = [], ''
    for line in re.search(r'```text\n(.*?)```', section('The tree'), re.S)[1].splitlines():
        name, _, meaning = line.strip().partition(' ')
        assert meaning.strip(), line
        if line.startswith(' '):
            found.append(f'{package}{name}')
        else:
            package = name
            found.append(name)
    return found


def real():
    """Return packages, their folders of modules and their modules."""
    found = []
    for package in PACKAGES:
        inside = [path for path in (PROJECT / package).iterdir()
                  if not path.name.startswith('__') and (path.suffix == '.py' or (
                      path / '__init__.py').is_file())]
        found += [f'{package}/', *(f"{package}/{path.name}{'/' if path.is_dir() else ''}"
                                   for path in inside)]
    return found


def test_the_tree_on_the_page_is_the_real_one():
    assert len(drawn()) == len(set(drawn()))
    assert set(drawn()) == set(real())
    assert [name for name in drawn() if name.count('/') == 1 and name[-1] == '/'] == [
        f'{package}/' for package in PACKAGES]


def listed(engine):
    """Return the files of the walk on the page, with the folder of one engine."""
    rows = re.findall(r'^\| (.+?) \| .+ \|$', section('The walk of one $V^2$'), re.M)[1:]
    links = [re.search(r'\(\.\./dewing_sim/(.+?)\)', row)[1] for row in rows]
    place = links.index('fluid/conformal/engine.py')
    return [*links[:place], f'fluid/{engine}/', *links[place + 1:]]


@pytest.mark.parametrize('engine', ENGINES)
def test_the_walk_on_the_page_is_that_of_a_step(engine):
    grid, step = ENGINES[engine]
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': engine, 'numerics.grid': grid, 'numerics.time_step': step,
        'numerics.trim_time': 1.0, 'membrane.elements': 32}))
    state = trim.march(wing)
    files = files_of(lambda: LockStep(wing, state, 1.0e9).advance, 200.0**2, 400.0**2)
    folder = f'fluid/{engine}/'
    walk = list(dict.fromkeys(folder if file.startswith(folder) else file for file in files))
    assert walk == listed(engine)
    assert len(walk) <= LONGEST_WALK
    assert f'These are {len(walk)} files' in section('The walk of one $V^2$')


def test_a_walk_holds_what_v_squared_changes_and_nothing_else():
    from dewing_sim.inputs.amplifier import Amplifier
    from dewing_sim.scales import Scales
    scales, amplifier = Scales(1.0, 1.0, 1.0, 1.0), Amplifier(1000.0)

    def step(v_squared):
        for _ in range(round(v_squared)):           # more often, to no other effect
            assert scales.reynolds == 1.0
        amplifier.drive(0.0, v_squared, 1.0e-4)
    assert files_of(lambda: step, 1.0, 2.0) == ['inputs/amplifier.py']
    assert files_of(lambda: step, 2.0, 2.0) == []

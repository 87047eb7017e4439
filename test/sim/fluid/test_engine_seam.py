# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""An engine from outside the package, in one file: that of docs/howto/engine.md."""

import dataclasses
import hashlib
import json
import sys

import numpy as np
import pytest
from documented_commands import PROJECT, blocks

from dewing_cli import main as cli
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.plate import Plate
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import rollout
from dewing_sim.rest import checkpoint, trim
from dewing_sim.schema import outside_modules
from dewing_sim.wing import Wing

ENGINE = 'thin_aerofoil:ThinAerofoil'
SOURCE = blocks(PROJECT / 'docs' / 'howto' / 'engine.md')[0].text
ALPHA = np.radians(4.0)
CHANGES = {'numerics.engine': ENGINE, 'numerics.grid': 'fast', 'numerics.trim_time': 12.0,
           'membrane.elements': 32}


@pytest.fixture(autouse=True)
def folder(own_folder):
    """Work in a folder that holds the engine."""
    (own_folder / 'thin_aerofoil.py').write_text(SOURCE)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, 'path', [*sys.path, str(own_folder)])
        yield own_folder
    sys.modules.pop('thin_aerofoil', None)


def make(grid: str = 'standard', alpha: float = ALPHA, dt: float = 0.01):
    return engines.make(ENGINE, grid, 2500.0, alpha, dt)


def test_the_stub_is_thin_aerofoil_theory():
    fluid = make()
    loads = fluid.loads(fluid.rest(Wall.flat(fluid.columns), 0.3))
    assert loads.cl == pytest.approx(2.0 * np.pi * np.sin(ALPHA), rel=1.0e-9)
    assert loads.cm == pytest.approx(0.0, abs=1.0e-9)
    x = fluid.columns
    bent = Wall(4.0 * 0.02 * x * (1.0 - x), np.zeros(len(x) - 1))
    assert fluid.loads(fluid.rest(bent, 0.3)).cl == pytest.approx(
        2.0 * np.pi * (np.sin(ALPHA) + 2.0 * 0.02), rel=0.01)


def test_the_stub_has_the_added_mass_of_a_flat_plate():
    fluid = make()
    dx = np.diff(fluid.columns)
    mass = dx[:, None] * fluid.added_mass
    assert mass.sum() == pytest.approx(np.pi / 4.0, rel=1.0e-9)
    assert mass == pytest.approx(mass.T, abs=1.0e-12)
    rest = fluid.rest(Wall.flat(fluid.columns), 0.3)
    pushed = Wall(np.zeros(len(dx) + 1), np.full(len(dx), 0.1))
    prediction = fluid.predict(rest, pushed)
    found = fluid.correct(prediction, np.zeros(len(dx)))
    assert found.jump == pytest.approx(rest.jump, abs=1.0e-12)


def test_a_wing_flies_on_it_and_goes_on_from_a_file(tmp_path):
    wing = Wing(parameters.load('paper', changes=CHANGES))
    rest = wing.rest()
    outputs = wing.observe(rest)
    expected = 2.0 * np.pi * (np.sin(ALPHA) + 2.0 * outputs.camber_max / wing.scales.length)
    assert outputs.cl == pytest.approx(expected, rel=0.03)
    assert outputs.camber_max > 0.0
    run = list(rollout(wing, rest, lambda _: Inputs(300.0**2), steps=20))
    assert max(outputs.coupling_iterations for _, outputs in run) <= 3
    state, outputs = run[-1]
    assert outputs.camber_max > wing.observe(rest).camber_max
    path = tmp_path / 'state.npz'
    checkpoint.save(path, state, wing.case)
    again, case = checkpoint.load(path), checkpoint.load_case(path)
    assert case == wing.case
    assert type(again.flow) is type(wing.fluid).state
    ends = [last for start in (state, again)
            for _, last in [*rollout(Wing(case), start, lambda _: Inputs(300.0**2), steps=3)][-1:]]
    assert ends[0].cl == ends[1].cl and np.array_equal(ends[0].y, ends[1].y)


def test_the_name_of_its_rest_state_covers_its_source(monkeypatch):
    wing = Wing(parameters.load('paper', changes=CHANGES))
    assert outside_modules(wing.case) == ('thin_aerofoil',)
    assert trim.machine.sources('thin_aerofoil')['thin_aerofoil'].digest == (
        hashlib.sha256(SOURCE.encode()).hexdigest())
    asked = []
    monkeypatch.setattr(trim.machine, 'fingerprint', lambda *modules: asked.append(modules) or '')
    trim.fingerprint(wing)
    assert asked == [('dewing_sim.wing', 'thin_aerofoil')]


def test_commands_take_it(tmp_path, capsys):
    numbers = tmp_path / 'numbers.json'
    grid = ['--engine', ENGINE, '--grid', 'fast', '--quiet', '--json', str(numbers), '--force']
    run = ['--set', 'numerics.trim_time=1.0', '--set', 'membrane.elements=32', '--duration',
           '0.002', '--save-state', 'state.npz']
    assert cli.main(['simulate', *grid, *run]) == 0
    assert json.loads(numbers.read_text())['engine'] == ENGINE
    assert cli.main(['plate', '--alpha', '4', *grid, '--duration', '0.1']) == 0
    assert json.loads(numbers.read_text())['cl_mean'] == pytest.approx(2.0 * np.pi * np.sin(ALPHA))
    assert cli.main(['plot', 'state.npz']) == 2
    assert f'the engine {ENGINE} has no picture' in capsys.readouterr().err


@pytest.mark.parametrize('change, sentence', [
    ({'numerics.grid': 'realtime'}, "numerics.grid = 'realtime' does not go with the engine "
                                    f'{ENGINE}: one of fast, standard'),
    ({'numerics.engine': 'thin_aerofoil:State'}, 'is no flow engine: it lacks name, grids'),
    ({'numerics.engine': 'thin_aerofoil:np'}, 'is not a class'),
    ({'numerics.engine': 'thin_aerofoil:Missing'}, 'has no Missing'),
    ({'numerics.engine': 'elsewhere:Engine'}, 'elsewhere cannot be imported'),
    ({'gust.shape': 'ramp'}, 'knows no gust nor rigid_motion: conformal does'),
])
def test_what_does_not_fit_is_told_in_one_sentence(change, sentence):
    with pytest.raises(BadInput, match=sentence) as raised:
        Wing(parameters.load('paper', changes=CHANGES | change))
    assert '\n' not in str(raised.value)


def test_a_class_that_leaves_out_what_it_must_have_is_told_so(folder):
    (folder / 'thin_aerofoil.py').write_text(
        SOURCE.replace('def predict', 'def forecast').replace('self.impedance =', 'impedance ='))
    with pytest.raises(BadInput, match='it lacks predict of dewing_sim.fluid.base.Fluid$'):
        make()
    sys.modules.pop('thin_aerofoil')
    (folder / 'thin_aerofoil.py').write_text(
        SOURCE.replace('self.impedance = ', 'self.other = '))
    with pytest.raises(BadInput, match='it lacks impedance of'):
        make()


@pytest.mark.parametrize('name', engines.NAMES)
def test_what_an_engine_declares_before_it_is_loaded_is_so(name):
    found = engines.find(name)
    assert engines.PACKAGES[name].GRIDS == tuple(found.grids)
    assert found.name == name and dataclasses.is_dataclass(found.state)


def test_names_are_known_without_any_kernel():
    import subprocess
    code = ('import sys; from dewing_sim import parameters; '
            "print([m for m in ('numba', 'numpy', 'scipy') if m in sys.modules])")
    found = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                           check=True, cwd=PROJECT)
    assert found.stdout == '[]\n'


def test_a_rigid_plate_flies_on_it():
    plate = Plate(ALPHA, grid='fast', dt=0.02, engine=ENGINE)
    state = plate.step(plate.step(plate.rest()))
    assert plate.observe(state).cl == pytest.approx(2.0 * np.pi * np.sin(ALPHA), rel=1.0e-9)

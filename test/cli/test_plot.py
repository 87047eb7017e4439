# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Fields of a flow for pictures, and the command that draws them."""

import numpy as np
import pytest
from scipy.interpolate import griddata

from dewing_cli import main as cli
from dewing_cli.commands import plot
from dewing_cli.figures import flow as flow_figure
from dewing_sim import parameters
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.engines import NAMES, make
from dewing_sim.rest import checkpoint
from dewing_sim.wing import Wing

ALPHA = np.radians(5.0)
COARSE = {'finite_volume': 'fast', 'conformal': 'realtime'}


def wall(fluid, camber: float) -> Wall:
    x = fluid.columns
    return Wall(4.0 * camber * x * (1.0 - x), np.zeros(len(x) - 1))


def started(engine: str, camber: float, steps: int):
    """Return an engine and its flow some steps after the start with circulation 0.3."""
    fluid = make(engine, COARSE[engine], 2500.0, ALPHA, 0.004)
    around = wall(fluid, camber)
    flow = fluid.rest(around, 0.3)
    for _ in range(steps):
        flow = fluid.correct(fluid.predict(flow, around), around.velocity)
    return fluid, flow


def value_at(patches, x: float, y: float, camber: float) -> float:
    """Return the value at (x, y), interpolated between the mesh points on this side of the wing.

    Points on it are left out: the field jumps there, and both sides may have one at one place.
    """
    points, values = [], []
    above = y > 4.0 * camber * x * (1.0 - x)
    for patch in patches:
        height = patch.y - 4.0 * camber * patch.x * (1.0 - patch.x)
        near = ((np.hypot(patch.x - x, patch.y - y) < 0.1)
                & ((height if above else -height) > 1.0e-3))
        points += [np.column_stack([patch.x[near], patch.y[near]])]
        values += [patch.value[near]]
    return float(griddata(np.concatenate(points), np.concatenate(values), (x, y)))


@pytest.mark.parametrize('engine', NAMES)
def test_stream_function_of_the_start_is_that_of_potential_flow(engine):
    fluid, flow = started(engine, 0.0, 0)
    patch, = fluid.field(flow).stream
    near = (np.hypot(patch.x - 0.5, patch.y) < 6.0) & (np.hypot(patch.x - 0.5, patch.y) > 1.0)
    z = patch.x[near] - 0.5 + 1j * patch.y[near]
    zeta = 0.5 * (z + np.sqrt(z - 0.5) * np.sqrt(z + 0.5))
    turn = np.exp(-1j * ALPHA)
    exact = np.imag(turn * zeta + np.conj(turn) / (16.0 * zeta)) + (
        0.3 / (2.0 * np.pi) * np.log(4.0 * np.abs(zeta)))
    assert patch.value[near] == pytest.approx(exact, abs=2.0e-3)


@pytest.mark.parametrize('engine', NAMES)
@pytest.mark.parametrize('camber', [0.0, 0.03])
def test_membrane_is_a_streamline(engine, camber):
    fluid, flow = started(engine, camber, 20)
    patch, = fluid.field(flow).stream
    height = 4.0 * camber * patch.x * (1.0 - patch.x)
    on_wall = (patch.x > 0.1) & (patch.x < 0.9) & (np.abs(patch.y - height) < 4.0e-3)
    assert on_wall.any()
    assert np.abs(patch.value[on_wall]).max() < 4.0e-3


def test_engines_agree_on_the_vorticity_of_the_boundary_layers():
    values = []
    for engine in NAMES:
        fluid, flow = started(engine, 0.03, 250)
        field = fluid.field(flow)
        values.append([value_at(field.vorticity, 0.5, 0.03 + side, 0.03)
                       for side in (0.01, -0.01)])
    assert values[0][0] < 0.0 < values[0][1]        # clockwise above, counter-clockwise below
    assert values[0] == pytest.approx(values[1], rel=0.1)


@pytest.fixture(scope='module', params=NAMES)
def state(request, tmp_path_factory):
    """Return the file of a wing's state soon after its start."""
    path = tmp_path_factory.mktemp('state') / f'{request.param}.npz'
    case = parameters.load('paper_alpha8', changes={
        'numerics.engine': request.param, 'numerics.grid': COARSE[request.param],
        'numerics.trim_time': 0.1})
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('XDG_CACHE_HOME', str(path.parent / 'cache'))
        wing = Wing(case)
        checkpoint.save(path, wing.rest(), case)
    return path


def test_a_state_becomes_a_picture_which_is_not_written_over(state, tmp_path, capsys):
    out = tmp_path / 'flow.png'
    assert cli.main(['plot', str(state), '--out', str(out)]) == 0
    assert out.read_bytes().startswith(b'\x89PNG') and out.stat().st_size > 50_000
    assert cli.main(['plot', str(state), '--out', str(out)]) == 2
    assert '--force' in capsys.readouterr().err


def test_a_film_marches_on(state, tmp_path, monkeypatch):
    from PIL import Image
    monkeypatch.setattr(plot, 'FRAMES', 3)
    out = tmp_path / 'flow.gif'
    assert cli.main(['plot', str(state), '--film', '0.003', '--out', str(out), '--quiet']) == 0
    assert Image.open(out).n_frames == 3


def test_deflections_are_drawn_as_large_as_told(state):
    wing = Wing(checkpoint.load_case(state))
    deflected = checkpoint.load(state)
    height = wing.membrane.surface(deflected.motion.position)[:, 1]
    alpha = wing.case.flow.angle_of_attack
    shown = flow_figure.picture(wing, deflected, 50.0).membrane
    x, y = shown[0] - 0.5, shown[1]
    drawn = np.sin(alpha) * x + np.cos(alpha) * y       # back into the wing frame
    assert drawn == pytest.approx(50.0 * height, abs=1.0e-12)


@pytest.mark.parametrize('arguments, complaint', [
    (['missing.npz'], 'no such file'), (['{state}', '--out', 'a.bmp'], '.png'),
    (['{state}', '--film', '1.0', '--out', 'a.png'], '.gif'),
    (['{state}', '--exaggeration', '0'], '--exaggeration'),
    (['{state}', '--film', '0.0'], 'at least one time step')])
def test_bad_input_is_one_sentence(arguments, complaint, state, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(['plot', *(text.format(state=state) for text in arguments)]) == 2
    error = capsys.readouterr().err
    assert complaint in error and error.count('\n') == 1


def test_a_simulation_leaves_the_state_that_is_drawn(tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'cache'))
    path = tmp_path / 'last.npz'
    run = ['simulate', '--grid', 'fast', '--set', 'numerics.trim_time=0.1', '--duration', '0.001',
           '--save-state', str(path), '--quiet']
    assert cli.main(run) == 0
    assert checkpoint.load(path).step == 10
    assert cli.main(run) == 2
    assert cli.main(['plot', str(path), '--quiet']) == 0
    assert path.with_suffix('.png').is_file()

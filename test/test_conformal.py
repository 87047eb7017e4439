# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal engine against exact statements: stream function, map, no slip, added mass."""

import numpy as np
import pytest
from scipy import fft

from dewing_sim.errors import BadInput, Diverged, NotConverged
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal import adi
from dewing_sim.fluid.conformal.engine import Conformal
from dewing_sim.fluid.conformal.fourier import Line
from dewing_sim.fluid.conformal.grid import PRESETS, Grid, Preset
from dewing_sim.fluid.conformal.mapping import Mapping
from dewing_sim.fluid.conformal.poisson import Poisson

COARSE = Preset(48, 40, 0.016)
ALPHA = np.radians(4.0)


@pytest.fixture(scope='module')
def engine() -> Conformal:
    return Conformal(Grid.build(COARSE), 2500.0, ALPHA, 0.01)


def arc(x: np.ndarray, camber: float) -> np.ndarray:
    """Return the heights of a circular arc over the chord."""
    radius = (camber**2 + 0.25) / (2.0 * camber)
    height = np.sqrt(radius**2 - (x - 0.5)**2) - (radius - camber)
    height[[0, -1]] = 0.0
    return height


def march(engine: Conformal, wall_at, steps: int, circulation: float = 0.2):
    state = engine.rest(wall_at(0.0), circulation)
    for step in range(1, steps + 1):
        wall = wall_at(step * engine.dt)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    return state


def bending(engine: Conformal, camber: float, amplitude: float, frequency: float):
    """Return the wall at a time: a parabola whose camber oscillates."""
    x = engine.columns
    mean = np.diff(4.0 * (x**2 / 2.0 - x**3 / 3.0)) / np.diff(x)

    def wall_at(time: float) -> Wall:
        height = camber + amplitude * (1.0 - np.cos(frequency * time))
        rate = amplitude * frequency * np.sin(frequency * time)
        return Wall(4.0 * height * x * (1.0 - x), rate * mean)
    return wall_at


@pytest.mark.parametrize('name', PRESETS)
def test_presets_reach_the_far_field_with_no_node_on_an_edge(name):
    grid = Grid.build(PRESETS[name])
    assert grid.face[-1] == pytest.approx(PRESETS[name].outermost)
    assert grid.eta[0] == 0.0 and grid.eta[1] == pytest.approx(PRESETS[name].first)
    assert np.abs(np.sin(grid.xi)).min() > 0.4 * grid.step
    assert grid.columns[[0, -1]] == pytest.approx([0.0, 1.0], abs=1.0e-15)


def test_transforms_of_a_line_are_those_of_the_library():
    values = np.random.default_rng(4).normal(size=24)
    modes = fft.rfft(values)
    assert Line.of(24).modes(values) == pytest.approx(modes, abs=1.0e-13)
    assert Line.of(24).values(modes + 1j * np.eye(13)[0]) == pytest.approx(values, abs=1.0e-13)


def stream_error(rows: int, first: float, k: int = 3) -> float:
    """Return the error of psi = (1 + eta) exp(-k eta) cos(k xi) and of its wall slope."""
    grid = Grid.build(Preset(16, rows, first))
    poisson = Poisson.of(grid)
    wave = np.cos(k * grid.xi)
    vorticity = 2.0 * k * np.exp(-k * grid.eta)
    q_hat = fft.rfft(vorticity[:, None] * wave, axis=1)
    wall = fft.rfft(wave)
    psi = fft.irfft(poisson.solve(q_hat, wall, 0.0), axis=1)
    exact = ((1.0 + grid.eta) * np.exp(-k * grid.eta))[:, None] * wave
    slope = fft.irfft(poisson.wall_slope(q_hat, wall, 0.0))
    return max(np.abs(psi - exact).max(), np.abs(slope - (1.0 - k) * wave).max())


def test_stream_function_converges_with_second_order():
    rows = np.array([40, 80, 160])
    errors = [stream_error(n, 0.64 / n) for n in rows]
    assert -np.polyfit(np.log(rows), np.log(errors), 1)[0] > 1.9, errors
    assert errors[-1] < 1.0e-3


def test_wall_slope_is_that_of_the_solution():
    grid = Grid.build(COARSE)
    poisson = Poisson.of(grid)
    rng = np.random.default_rng(1)
    q_hat = fft.rfft(rng.normal(size=(len(grid.eta), len(grid.xi))), axis=1)
    wall = poisson.wall_value(rng.normal(size=len(grid.xi)))
    psi = poisson.solve(q_hat, wall, 0.7)
    k = grid.wavenumbers
    slope = (psi[1] - psi[0]) / grid.gap[0] + grid.width[0] * (q_hat[0] - k**2 * psi[0])
    assert poisson.wall_slope(q_hat, wall, 0.7) == pytest.approx(slope, abs=1.0e-10)


@pytest.mark.parametrize('camber', [0.001, 0.02, 0.15])
def test_map_of_a_circular_arc_is_joukowskis(camber):
    grid = Grid.build(PRESETS['standard'])
    mapping = Mapping(grid)
    found = mapping.follow(arc(grid.columns, camber), mapping.flat())
    turn = np.arctan(2.0 * camber)
    assert found.edges == pytest.approx(
        [0.25 / np.cos(turn), -turn, np.pi + turn], abs=2.0e-6)
    place, slope = mapping.wall(found)
    assert place.imag == pytest.approx(
        np.interp(place.real, grid.columns, arc(grid.columns, camber)), abs=1.0e-3 * camber)
    assert np.abs(slope)**2 == pytest.approx(mapping.metric(found)[0], abs=1.0e-13)


def test_a_shape_that_no_map_describes_is_refused(engine):
    with pytest.raises(NotConverged, match='cambered'):
        engine.rest(Wall(arc(engine.columns, 0.4), np.zeros(len(engine.columns) - 1)), 0.0)


def test_edges_must_be_pinned(engine):
    wall = Wall.flat(engine.columns)
    with pytest.raises(BadInput, match='edges'):
        engine.rest(Wall(wall.height + 0.1, wall.velocity), 0.0)


def test_sweeps_invert_their_factors():
    rng = np.random.default_rng(2)
    grid = Grid.build(Preset(12, 10, 0.2))
    rows, n = 10, 12
    h = rng.uniform(1.0, 2.0, (rows, n))
    u, v = rng.normal(size=(2, rows, n))
    r = rng.normal(size=(rows, n))
    r[0] = 0.0
    d = r.copy()
    nu = 0.01
    adi.sweep_eta(d, h, v, grid.width, grid.gap, nu)
    adi.sweep_xi(d, h, u, grid.step, nu)
    d[0] = 0.0

    def across(f):
        flux = adi.CONVECTION * 0.5 * v
        damp = adi.DISSIPATION * np.abs(v)
        out = np.zeros_like(f)
        for j in range(1, rows):
            low = nu / grid.gap[j - 1] + flux[j - 1] + damp[j - 1]
            out[j] += low * (f[j] - f[j - 1]) / grid.width[j]
            if j < rows - 1:
                high = nu / grid.gap[j] - flux[j] + damp[j]
                out[j] += high * (f[j] - f[j + 1]) / grid.width[j]
        return out

    def along(f):
        flux = adi.CONVECTION * 0.5 * u
        damp = adi.DISSIPATION * np.abs(u) + nu / grid.step
        out = (damp - flux) * (f - np.roll(f, -1, 1))
        return (out + np.roll(damp + flux, 1, 1) * (f - np.roll(f, 1, 1))) / grid.step

    middle = (h * d + along(d)) / h
    middle[0] = 0.0
    assert (h * middle + across(middle))[1:] == pytest.approx(r[1:], abs=1.0e-12)


def slip(engine: Conformal, state) -> np.ndarray:
    """Return the tangential velocity of the flow less that of a wall at rest, times h."""
    q_hat = fft.rfft(state.q, axis=1)
    none = np.zeros(q_hat.shape[1], dtype=complex)
    stream = 2.0 * state.map.scale * np.sin(engine.grid.xi - engine.alpha)
    return fft.irfft(engine.poisson.wall_slope(q_hat, none, state.circulation)) + stream


def test_flow_does_not_slip_along_a_plate(engine):
    state = march(engine, lambda _: Wall.flat(engine.columns), 20)
    assert np.abs(slip(engine, state)).max() < 1.0e-12
    assert np.abs(state.w[0]).max() > 10.0


def test_flow_hardly_slips_along_a_cambered_plate(engine):
    wall = bending(engine, 0.05, 0.0, 1.0)
    state = march(engine, wall, 100)
    assert np.abs(slip(engine, state)).max() < 1.0e-6


def test_total_vorticity_obeys_kelvin(engine):
    """The vorticity of the strip, with the wall's half cells, is minus the circulation."""
    state = march(engine, bending(engine, 0.0, 0.01, 8.0), 60, circulation=0.3)
    total = np.sum(engine.grid.width[:, None] * state.q) * engine.grid.step
    assert total == pytest.approx(-0.3, abs=1.0e-3)


def test_a_symmetric_flow_stays_symmetric():
    engine = Conformal(Grid.build(COARSE), 2500.0, 0.0, 0.01)
    state = march(engine, lambda _: Wall.flat(engine.columns), 100, circulation=0.0)
    assert state.w == pytest.approx(-state.w[:, ::-1], abs=1.0e-9 * np.abs(state.w).max())
    assert engine.loads(state).cl == pytest.approx(0.0, abs=1.0e-10)


def weighted_added_mass(engine: Conformal) -> np.ndarray:
    return np.diff(engine.columns)[:, None] * engine.resistance * (2.0 * engine.dt / 3.0)


def test_added_mass_is_symmetric_and_that_of_a_strip(engine):
    mass = weighted_added_mass(engine)
    assert mass == pytest.approx(mass.T, abs=1.0e-12)
    assert np.linalg.eigvalsh(mass).min() > 0.0
    assert mass.sum() == pytest.approx(np.pi / 4.0, rel=2.0e-3)


@pytest.mark.parametrize('n, expected', [(1, 0.8546), (2, 0.3592), (3, 0.2356)])
def test_added_mass_of_sine_modes(n, expected):
    engine = Conformal(Grid.build(PRESETS['fast']), 2500.0, 0.0, 0.01)
    columns = engine.columns
    mode = -np.diff(np.cos(n * np.pi * columns)) / (n * np.pi * np.diff(columns))
    assert 2.0 * mode @ weighted_added_mass(engine) @ mode == pytest.approx(expected, rel=5.0e-3)


def test_load_is_affine_in_the_wall_velocity(engine):
    state = march(engine, lambda _: Wall.flat(engine.columns), 10)
    still = engine.predict(state, Wall.flat(engine.columns))
    velocity = 1.0e-3 * np.sin(np.pi * np.arange(len(still.jump)) / len(still.jump))
    moved = engine.correct(still, velocity)
    change = engine.loads(moved).jump - still.jump
    assert change == pytest.approx(-engine.resistance @ velocity, abs=1.0e-9)


def test_unsteady_lift_converges_faster_than_first_order_in_time():
    grid = Grid.build(COARSE)
    lifts = []
    for n in range(4):
        engine = Conformal(grid, 500.0, ALPHA, 0.01 / 2**n)
        lifts.append(engine.loads(march(engine, bending(engine, 0.01, 0.005, 4.0),
                                        100 * 2**n)).cl)
    first, second, third = np.abs(np.diff(lifts))
    assert np.log2(second / third) > 1.2, lifts
    assert third < 1.0e-4 * lifts[-1]


def test_runaway_motion_stops_with_advice(engine):
    with pytest.raises(Diverged, match='time step'):
        march(engine, bending(engine, 0.0, 0.02, 600.0), 60)


def test_a_grid_of_the_other_engine_is_refused():
    with pytest.raises(BadInput, match='fast, standard, fine'):
        engines.make('finite_volume', 'realtime', 2500.0, ALPHA, 0.01)

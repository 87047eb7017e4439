# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The conformal engine against exact statements: stream function, map, no slip, added mass."""

import numpy as np
import pytest
from scipy import fft

from dewing_sim.errors import BadInput, Diverged, NotConverged
from dewing_sim.fluid import engines
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.conformal import adi, poisson
from dewing_sim.fluid.conformal.engine import Conformal
from dewing_sim.fluid.conformal.fourier.modes import (
    Plan,
    line_modes,
    line_values,
    to_field,
    to_modes,
)
from dewing_sim.fluid.conformal.fourier.stockham import Buffers, TwiddleFactors, transform
from dewing_sim.fluid.conformal.geometry.exterior import Exterior, metric_and_flux
from dewing_sim.fluid.conformal.geometry.mapping import Mapping
from dewing_sim.fluid.conformal.grid import Grid
from dewing_sim.fluid.conformal.poisson import Poisson
from dewing_sim.fluid.conformal.presets import PRESETS, Preset

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


def parts(modes: np.ndarray) -> np.ndarray:
    """Return real parts, then imaginary parts of modes (rows, n / 2 + 1)."""
    return np.concatenate((modes.real, modes.imag), axis=1)


def complex_modes(both: np.ndarray) -> np.ndarray:
    """Return the modes of these parts."""
    real, imaginary = np.split(both, 2, axis=1)
    return real + 1j * imaginary


@pytest.mark.parametrize('n', [16, 36, 64, 96, 192])
@pytest.mark.parametrize('lanes', [1, 7, 72])
def test_transform_is_that_of_the_library(n, lanes):
    x, y = np.random.default_rng(n).normal(size=(2, n, lanes))
    buffers = Buffers.of(n * lanes)
    buffers.re[:], buffers.im[:] = x.ravel(), y.ravel()
    real, imaginary = transform(buffers, n, lanes, TwiddleFactors.of(n))
    assert real + 1j * imaginary == pytest.approx(fft.fft(x + 1j * y, axis=0), abs=1.0e-12)


def test_other_factors_than_two_and_three_are_refused():
    with pytest.raises(BadInput, match='70 values'):
        TwiddleFactors.of(70)


@pytest.mark.parametrize('rows', [5, 24])
def test_modes_of_a_field_and_back(rows):
    n, plan, buffers = 24, Plan.of(24), Buffers.of(24 * 24)
    field, modes = np.random.default_rng(4).normal(size=(n, 24)), np.zeros((24, n + 2))
    to_modes(field, rows, buffers, plan, modes)
    exact = fft.rfft(field.T, axis=1)
    assert complex_modes(modes[:rows]) == pytest.approx(exact[:rows], abs=1.0e-13)
    assert not modes[rows:].any()
    back = np.empty_like(field)
    exact[:, [0, -1]] += 1.0j           # no part of a real field
    to_field(parts(exact), buffers, plan, back)
    assert back == pytest.approx(field, abs=1.0e-13)


def test_modes_of_a_line_and_back():
    values, plan, buffers = np.random.default_rng(4).normal(size=24), Plan.of(24), Buffers.of(24)
    modes = line_modes(values, buffers, plan)
    assert modes == pytest.approx(fft.rfft(values), abs=1.0e-13)
    assert line_values(modes, buffers, plan) == pytest.approx(values, abs=1.0e-13)


def solved(grid: Grid, q_hat: np.ndarray, wall: np.ndarray, outer: float):
    """Return the modes (rows, modes) of psi and those of its slope at the membrane."""
    solver, both = Poisson.of(grid), parts(q_hat)
    psi = np.empty_like(both)
    poisson.solve(solver, both, wall, outer, psi)
    return complex_modes(psi), poisson.wall_slope(solver, both, wall, outer)


def stream_error(rows: int, first: float, k: int = 3) -> float:
    """Return the error of psi = (1 + eta) exp(-k eta) cos(k xi) and of its wall slope."""
    grid = Grid.build(Preset(16, rows, first))
    wave = np.cos(k * grid.xi)
    vorticity = 2.0 * k * np.exp(-k * grid.eta)
    psi, slope = solved(grid, fft.rfft(vorticity[:, None] * wave, axis=1), fft.rfft(wave), 0.0)
    exact = ((1.0 + grid.eta) * np.exp(-k * grid.eta))[:, None] * wave
    return max(np.abs(fft.irfft(psi, axis=1) - exact).max(),
               np.abs(fft.irfft(slope) - (1.0 - k) * wave).max())


def test_stream_function_converges_with_second_order():
    rows = np.array([40, 80, 160])
    errors = [stream_error(n, 0.64 / n) for n in rows]
    assert -np.polyfit(np.log(rows), np.log(errors), 1)[0] > 1.9, errors
    assert errors[-1] < 1.0e-3


def test_wall_slope_is_that_of_the_solution():
    grid = Grid.build(COARSE)
    rng = np.random.default_rng(1)
    q_hat = fft.rfft(rng.normal(size=(len(grid.eta), len(grid.xi))), axis=1)
    wall = fft.rfft(rng.normal(size=len(grid.xi)))
    psi, slope = solved(grid, q_hat, wall, 0.7)
    k = grid.wavenumbers
    found = (psi[1] - psi[0]) / grid.gap[0] + grid.width[0] * (q_hat[0] - k**2 * psi[0])
    assert slope == pytest.approx(found, abs=1.0e-10)


@pytest.mark.parametrize('camber', [0.001, 0.02, 0.15])
def test_map_of_a_circular_arc_is_joukowskis(camber):
    grid = Grid.build(PRESETS['standard'])
    exterior = Exterior.of(grid)
    mapping = Mapping(exterior)
    found = mapping.follow(arc(grid.columns, camber), mapping.flat())
    turn = np.arctan(2.0 * camber)
    assert found.edges == pytest.approx(
        [0.25 / np.cos(turn), -turn, np.pi + turn], abs=2.0e-6)
    line = mapping.wall(found)
    assert line.place.imag == pytest.approx(
        np.interp(line.place.real, grid.columns, arc(grid.columns, camber)), abs=1.0e-3 * camber)
    h2, _, _ = metric_and_flux(exterior, found.shape, found.scale, 0.0 * found.shape, 0.0)
    assert np.abs(line.slope)**2 == pytest.approx(h2[:, 0],
                                                  abs=1.0e-13)


def test_a_shape_that_no_map_describes_is_refused(engine):
    with pytest.raises(NotConverged, match='cambered'):
        engine.rest(Wall(arc(engine.columns, 0.4), np.zeros(len(engine.columns) - 1)), 0.0)


def test_edges_must_be_pinned(engine):
    wall = Wall.flat(engine.columns)
    with pytest.raises(BadInput, match='edges'):
        engine.rest(Wall(wall.height + 0.1, wall.velocity), 0.0)


def test_sweeps_invert_their_factors():
    rng = np.random.default_rng(2)
    grid = Grid.build(Preset(24, 10, 0.2))
    n, rows = 24, 10
    h = rng.uniform(1.0, 2.0, (n, rows))
    u, v = rng.normal(size=(2, n, rows))
    r = rng.normal(size=(n, rows))
    r[:, 0] = u[:, 0] = 0.0
    d, strip = r.copy(), grid.strip
    nu = 0.01
    for first in range(0, n, adi.LANES):
        adi.sweep_eta(d, h, v, strip, nu, first, min(first + adi.LANES, n))
    adi.sweep_xi(d, h, u, strip, nu, *np.empty((2, n, rows)))
    d[:, 0] = 0.0

    def across(f):
        flux = adi.CONVECTION * 0.5 * v
        damp = adi.DISSIPATION * np.abs(v)
        out = np.zeros_like(f)
        for j in range(1, rows):
            low = nu / grid.gap[j - 1] + flux[:, j - 1] + damp[:, j - 1]
            out[:, j] += low * (f[:, j] - f[:, j - 1]) / grid.width[j]
            if j < rows - 1:
                high = nu / grid.gap[j] - flux[:, j] + damp[:, j]
                out[:, j] += high * (f[:, j] - f[:, j + 1]) / grid.width[j]
        return out

    def along(f):
        flux = adi.CONVECTION * 0.5 * u
        damp = adi.DISSIPATION * np.abs(u) + nu / grid.step
        out = (damp - flux) * (f - np.roll(f, -1, 0))
        return (out + np.roll(damp + flux, 1, 0) * (f - np.roll(f, 1, 0))) / grid.step

    middle = (h * d + along(d)) / h
    middle[:, 0] = 0.0
    assert (h * middle + across(middle))[:, 1:] == pytest.approx(r[:, 1:], abs=1.0e-12)


def slip(engine: Conformal, state) -> np.ndarray:
    """Return the tangential velocity of the flow less that of a wall at rest, times h."""
    q_hat = fft.rfft(state.q.T, axis=1)
    none = np.zeros(q_hat.shape[1], dtype=complex)
    stream = 2.0 * state.map.scale * np.sin(engine.grid.xi - engine.alpha)
    outer = len(stream) * state.circulation / (2.0 * np.pi)
    return fft.irfft(solved(engine.grid, q_hat, none, outer)[1]) + stream


def test_flow_does_not_slip_along_a_plate(engine):
    state = march(engine, lambda _: Wall.flat(engine.columns), 20)
    assert np.abs(slip(engine, state)).max() < 1.0e-12
    assert np.abs(state.w[:, 0]).max() > 10.0


def test_flow_hardly_slips_along_a_cambered_plate(engine):
    wall = bending(engine, 0.05, 0.0, 1.0)
    state = march(engine, wall, 100)
    assert np.abs(slip(engine, state)).max() < 1.0e-6


def test_total_vorticity_obeys_kelvin(engine):
    """The vorticity of the strip, with the wall's half cells, is minus the circulation."""
    state = march(engine, bending(engine, 0.0, 0.01, 8.0), 60, circulation=0.3)
    total = np.sum(engine.grid.width * state.q) * engine.grid.step
    assert total == pytest.approx(-0.3, abs=1.0e-3)


def test_a_symmetric_flow_stays_symmetric():
    engine = Conformal(Grid.build(COARSE), 2500.0, 0.0, 0.01)
    state = march(engine, lambda _: Wall.flat(engine.columns), 100, circulation=0.0)
    assert state.w == pytest.approx(-state.w[::-1], abs=1.0e-9 * np.abs(state.w).max())
    assert engine.loads(state).cl == pytest.approx(0.0, abs=1.0e-10)


def weighted_added_mass(engine: Conformal) -> np.ndarray:
    return np.diff(engine.columns)[:, None] * engine.impedance * (2.0 * engine.dt / 3.0)


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
    assert change == pytest.approx(-engine.impedance @ velocity, abs=1.0e-9)


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

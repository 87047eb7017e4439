# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The finite-volume engine against exact statements: pressure, divergence, added mass, orders."""

from dataclasses import replace

import numpy as np
import pytest

from dewing_sim.errors import Diverged
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume import mapping, projection
from dewing_sim.fluid.finite_volume.engine import FiniteVolume, FlowState
from dewing_sim.fluid.finite_volume.grid import PRESETS, Grid, Spacing, build
from dewing_sim.fluid.finite_volume.poisson import Poisson
from dewing_sim.fluid.finite_volume.potential import Potential

COARSE = Spacing(0.02, 0.02, 0.08, 0.015, 0.2, 0.2, 0.4, 0.2, 0.4, extent=20.0)
ALPHA = np.radians(4.0)


@pytest.fixture(scope='module')
def engine() -> FiniteVolume:
    return FiniteVolume(build(COARSE), 2500.0, ALPHA, 0.02)


def parabola(columns: np.ndarray, camber: float, rate: float) -> Wall:
    """Return a parabolic wall with its exact column-averaged velocity."""
    antiderivative = 4.0 * (columns**2 / 2.0 - columns**3 / 3.0)
    mean = np.diff(antiderivative) / np.diff(columns)
    return Wall(4.0 * camber * columns * (1.0 - columns), rate * mean)


@pytest.mark.parametrize('name', PRESETS)
def test_presets_put_faces_on_both_edges_and_on_the_plate(name):
    grid = build(PRESETS[name])
    assert grid.x[grid.leading] == 0.0
    assert grid.x[grid.trailing] == 1.0
    assert grid.y[grid.middle] == 0.0
    assert np.array_equal(grid.y, -grid.y[::-1])
    assert (np.diff(grid.x) > 0.0).all() and (np.diff(grid.y) > 0.0).all()


def test_pressure_solution_satisfies_the_cut_laplacian():
    grid = build(COARSE)
    poisson = Poisson.of(grid)
    rng = np.random.default_rng(1)
    fx = rng.normal(size=(len(grid.x), len(grid.dy)))
    fy = rng.normal(size=(len(grid.dx), len(grid.y)))
    theta = 0.1
    r = projection.divergence(fx, fy, grid.dx, grid.dy) / theta
    even, odd, jump = poisson.forward(r)
    phi = poisson.backward(even, odd, jump, np.zeros(len(jump)))
    assert phi[grid.plate, grid.middle] - phi[grid.plate, grid.middle - 1] == pytest.approx(
        jump, abs=1.0e-10 * np.abs(phi).max())
    projection.correct(fx, fy, phi, grid.dxf, grid.dyf, theta, grid.leading, grid.trailing)
    left = projection.divergence(fx, fy, grid.dx, grid.dy)
    assert np.abs(left).max() < 1.0e-10 * np.abs(theta * r).max()


def test_fluxes_stay_free_of_divergence_on_the_moving_grid(engine):
    state = engine.rest(Wall.flat(engine.columns), 0.2)
    for step in range(1, 11):
        wall = parabola(engine.columns, 0.05 * step * engine.dt, 0.05)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    metrics = mapping.metrics(engine.grid, wall)
    fx, fy = projection.fluxes(engine.grid, mapping.decay(engine.grid), metrics,
                               state.u, state.v)
    assert fx == pytest.approx(state.fx, abs=1.0e-13)
    outflow = projection.divergence(fx, fy, engine.grid.dx, engine.grid.dy)
    assert np.abs(outflow).max() < 1.0e-12
    assert fy[engine.grid.plate, engine.grid.middle] == pytest.approx(wall.velocity, abs=1e-14)


def free_engine(cells: int, dt: float, stream=(0.8, 0.6), reynolds=100.0, extent=4.0,
                ) -> FiniteVolume:
    """Return an engine without a plate, on a uniform grid whose middle column may heave."""
    x = np.linspace(-extent, extent, cells + 1)
    engine = FiniteVolume(Grid(x, x, cells // 2, cells // 2), reynolds, 0.0, dt)
    shape_x, shape_y = (cells + 1, cells), (cells, cells + 1)
    engine.potential = Potential(np.full(shape_x, stream[0]), np.full(shape_y, stream[1]),
                                 np.zeros(shape_x), np.zeros(shape_y))
    return engine


def heaving(time: float) -> Wall:
    return Wall(np.array([0.2 * np.sin(time)]), np.empty(0),
                (0.2 * np.cos(time), 0.2 * np.cos(time)))


def with_velocities(engine: FiniteVolume, wall: Wall, u: np.ndarray, v: np.ndarray) -> FlowState:
    g, metrics = mapping.decay(engine.grid), mapping.metrics(engine.grid, wall)
    fx, fy = projection.fluxes(engine.grid, g, metrics, u, v)
    w = fy - np.outer(metrics.velocity, g.f)
    p = np.zeros((len(engine.grid.dx), len(engine.grid.dy)))
    return FlowState(u, v, fx, w, p, u, v, fx, w, wall.height, wall.velocity, 0.0)


def test_a_uniform_stream_is_kept_on_a_moving_grid():
    engine = free_engine(24, 0.05, extent=7.0)
    u, v = engine.potential.fluxes(0.0)
    wall = heaving(0.0)
    state = with_velocities(engine, wall, u, v)
    for step in range(1, 21):
        wall = heaving(step * engine.dt)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    assert wall.height[0] > 0.1
    assert state.u == pytest.approx(u, abs=1.0e-12)
    assert state.v == pytest.approx(v, abs=1.0e-12)


def taylor_vortex(x, y, time, nu, strength=0.2):
    """Return (u, v) of a decaying vortex without circulation, an exact solution.

    Vorticity strength (1 - r^2 / 4 s) exp(-r^2 / 4 s) / s^2, s = nu (t + 4): Taylor (1918).
    """
    s = nu * (time + 4.0)
    swirl = strength / s**2 * np.exp(-(x**2 + y**2) / (4.0 * s)) / 2.0
    return -swirl * y, swirl * x


def vortex_pressure(x, y, time, nu, far, strength=0.2):
    """Return the pressure of `taylor_vortex` for the pressure ``far`` from it."""
    s = nu * (time + 4.0)
    return far - strength**2 / (4.0 * s**3) * np.exp(-(x**2 + y**2) / (2.0 * s))


def vortex_error(cells: int, dt: float) -> float:
    """Return the error of a Taylor vortex after one time unit on a heaving grid."""
    nu = 0.05
    engine = free_engine(cells, dt, stream=(0.0, 0.0), reynolds=1.0 / nu, extent=6.0)
    grid = engine.grid

    def place(x, eta, time):
        return eta + np.outer(np.exp(-x**2), heaving(time).height[0] * np.exp(-eta**2))

    def exact(time):
        return (taylor_vortex(grid.x[:, None], place(grid.x, grid.yc, time), time, nu)[0],
                taylor_vortex(grid.xc[:, None], place(grid.xc, grid.y, time), time, nu)[1])

    before = with_velocities(engine, heaving(-dt), *exact(-dt))
    state = with_velocities(engine, heaving(0.0), *exact(0.0))
    state = replace(
        state, u_before=before.u, v_before=before.v, fx_before=before.fx, w_before=before.w,
        p=vortex_pressure(grid.xc[:, None], place(grid.xc, grid.yc, 0.0), 0.0, nu, far=0.5))
    for step in range(1, round(1.0 / dt) + 1):
        wall = heaving(step * dt)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    u, v = exact(1.0)
    return max(np.abs(state.u - u).max(), np.abs(state.v - v).max()) / np.abs(u).max()


def test_a_decaying_vortex_converges_with_second_order_on_a_moving_grid():
    cells = np.array([32, 64, 128])
    errors = [vortex_error(n, 1.6 / n) for n in cells]
    order = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
    assert order > 1.8, errors
    assert errors[-1] < 0.01


def lift_after(engine: FiniteVolume, time: float) -> float:
    state = engine.rest(parabola(engine.columns, 0.01, 0.0), 0.2)
    for step in range(1, round(time / engine.dt) + 1):
        phase = 4.0 * step * engine.dt
        wall = parabola(engine.columns, 0.01 + 0.005 * (1.0 - np.cos(phase)),
                        0.02 * np.sin(phase))
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    return engine.loads(state).cl


def test_unsteady_lift_of_a_moving_plate_converges_with_second_order_in_time():
    grid = build(COARSE)
    lifts = [lift_after(FiniteVolume(grid, 2500.0, ALPHA, 0.04 / 2**n), 2.0) for n in range(4)]
    first, second, third = np.abs(np.diff(lifts))
    assert np.log2(second / third) > 1.7, lifts
    assert third < second < first


def weighted_added_mass(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the column faces and diag(dx) M_A of a grid preset."""
    grid = build(PRESETS[name])
    return grid.columns, np.diff(grid.columns)[:, None] * Poisson.of(grid).added_mass


def test_added_mass_is_symmetric_and_positive():
    _, mass = weighted_added_mass('standard')
    assert mass == pytest.approx(mass.T, abs=1.0e-12 * np.abs(mass).max())
    assert np.linalg.eigvalsh(0.5 * (mass + mass.T)).min() > 0.0


def test_added_mass_of_a_heaving_plate_approaches_pi_over_four():
    errors = [weighted_added_mass(name)[1].sum() / (np.pi / 4.0) - 1.0
              for name in ('fast', 'standard', 'fine')]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2] > 0.0, errors
    assert errors[2] < 3.0e-3


@pytest.mark.parametrize('n, expected', [(1, 0.8546), (2, 0.3592), (3, 0.2356)])
def test_added_mass_of_sine_modes(n, expected):
    columns, mass = weighted_added_mass('standard')
    mode = -np.diff(np.cos(n * np.pi * columns)) / (n * np.pi * np.diff(columns))
    assert 2.0 * mode @ mass @ mode == pytest.approx(expected, rel=4.0e-3)


def test_starting_field_carries_its_circulation_without_divergence(engine):
    fx, fy = engine.potential.fluxes(0.2)
    outflow = projection.divergence(fx, fy, engine.grid.dx, engine.grid.dy)
    assert np.abs(outflow).max() < 1.0e-12
    assert np.abs(fy[engine.grid.plate, engine.grid.middle]).max() < 1.0e-15
    far = engine.with_circulation(engine.rest(Wall.flat(engine.columns), 0.2), 0.5)
    assert far.fx[0] == pytest.approx(engine.potential.fluxes(0.5)[0][0], abs=1e-15)


def test_runaway_motion_stops_with_advice(engine):
    state = engine.rest(Wall.flat(engine.columns), 0.2)
    with pytest.raises(Diverged, match='time step'):
        for step in range(1, 60):
            wall = parabola(engine.columns, 0.0, 60.0 * (-1.0)**step)
            state = engine.correct(engine.predict(state, wall), wall.velocity)
    with pytest.raises(Diverged, match='deflection'):
        engine.predict(engine.rest(Wall.flat(engine.columns), 0.2),
                       parabola(engine.columns, 0.9, 0.0))

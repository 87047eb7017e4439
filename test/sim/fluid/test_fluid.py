# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The finite-volume engine against exact statements: pressure, divergence, added mass, orders."""

from dataclasses import replace

import numpy as np
import pytest

from dewing_sim.errors import Diverged
from dewing_sim.fluid.base import Wall
from dewing_sim.fluid.finite_volume import mapping, poisson, projection
from dewing_sim.fluid.finite_volume.engine import FiniteVolume
from dewing_sim.fluid.finite_volume.grid import build
from dewing_sim.fluid.finite_volume.presets import PRESETS, Spacing
from dewing_sim.fluid.finite_volume.solver import Solver
from dewing_sim.fluid.finite_volume.step import After, Before
from dewing_sim.machine.kernels import kernel
from dewing_sim.verification.fluid.added_mass import AddedMassRun, sine
from dewing_sim.verification.fluid.rigid_flow import parabola
from dewing_sim.verification.fluid.vortex import VortexRun, free_engine, heaving, with_velocities

COARSE = Spacing(0.02, 0.02, 0.08, 0.015, 0.2, 0.2, 0.4, 0.2, 0.4, extent=20.0)
ALPHA = np.radians(4.0)


@pytest.fixture(scope='module')
def engine() -> FiniteVolume:
    return FiniteVolume(build(COARSE), 2500.0, ALPHA, 0.02)


@pytest.mark.parametrize('name', PRESETS)
def test_presets_put_faces_on_both_edges_and_on_the_plate(name):
    grid = build(PRESETS[name].spacing)
    assert grid.x[grid.leading] == 0.0
    assert grid.x[grid.trailing] == 1.0
    assert grid.y[grid.middle] == 0.0
    assert np.array_equal(grid.y, -grid.y[::-1])
    assert (np.diff(grid.x) > 0.0).all() and (np.diff(grid.y) > 0.0).all()


@kernel
def corrected(before, halves, m, solver, after):
    projection.correct(before, halves, m, solver, after)


def test_pressure_solution_satisfies_the_cut_laplacian():
    grid = build(COARSE)
    solver = Solver.of(grid, 1.0, 0.1)
    rng = np.random.default_rng(1)
    fx = rng.normal(size=(len(grid.x), len(grid.dy)))
    fy = rng.normal(size=(len(grid.dx), len(grid.y)))
    fy[grid.plate, grid.middle] = 0.0
    given = np.abs(projection.divergence(fx, fy, grid.dx, grid.dy)).max()
    still = Wall.flat(grid.columns)
    even, odd, jump = poisson.forward(fx, fy, grid.dx, grid.dy, solver.theta, solver.poisson)
    halves = poisson.backward(even, odd, jump, still.velocity, solver.poisson)
    after = After(*map(np.empty_like, (fx, fy, fx, fy, halves[0])))._replace(
        p=np.empty((len(grid.dx), len(grid.dy))))
    before = Before(fx, fy, np.zeros_like(after.p))
    corrected(before, halves, mapping.metrics(grid, still), solver, after)
    assert after.p[grid.plate, grid.middle] - after.p[
        grid.plate, grid.middle - 1] == pytest.approx(jump, abs=1.0e-10 * np.abs(after.p).max())
    left = projection.divergence(after.fx, after.v, grid.dx, grid.dy)
    assert np.abs(left).max() < 1.0e-10 * given


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


def test_a_prediction_outlives_the_next_and_needs_nothing_left_of_the_last(engine):
    state = engine.rest(parabola(engine.columns, 0.02, 0.0), 0.2)
    walls = [parabola(engine.columns, height, 0.3) for height in (0.021, 0.03)]
    state = engine.correct(engine.predict(state, walls[0]), walls[0].velocity)
    alone = engine.correct(engine.predict(state, walls[0]), walls[0].velocity)
    first = engine.predict(state, walls[0])
    fields = engine.solver.fields
    scratch = [*fields[:fields._fields.index('lines')], *fields.lines, *fields.sloped,
               engine.solver.poisson.halves]
    for field in scratch:
        field.fill(np.nan)
    engine.predict(state, walls[1])
    for field in scratch:
        field.fill(np.nan)
    again = engine.correct(first, walls[0].velocity)
    assert all(np.array_equal(one, other) for one, other in zip(
        (alone.u, alone.v, alone.fx, alone.w, alone.p),
        (again.u, again.v, again.fx, again.w, again.p), strict=True))
    repeated = engine.correct(engine.predict(state, walls[0]), walls[0].velocity)
    assert np.array_equal(alone.u, repeated.u) and np.array_equal(alone.p, repeated.p)


def test_loads_are_those_of_pressure_and_wall_shear(engine):
    state = engine.rest(parabola(engine.columns, 0.05, 0.0), 0.2)
    x, grid = engine.columns, engine.grid
    p = np.zeros_like(state.p)
    p[grid.plate, grid.middle - 1] = 0.5                # the jump of a uniform load
    loads = engine.loads(replace(state, u=np.zeros_like(state.u), p=p))
    assert loads.jump == pytest.approx(0.5)
    assert (loads.cl, loads.cd) == pytest.approx((np.cos(ALPHA), np.sin(ALPHA)))
    assert loads.cm == pytest.approx(-0.25)
    sheared = engine.loads(replace(state, u=np.ones_like(state.u), p=0.0 * p))
    rows = slice(grid.middle - 1, grid.middle + 1)
    jacobian = 1.0 + np.outer(0.2 * x * (1.0 - x), engine.solver.g.dc[rows])
    area = engine.solver.blocked * grid.dxf
    drag = 2.0 / grid.dy[grid.middle] * engine.nu * np.sum(
        (1.0 / jacobian).sum(axis=1) * area[grid.leading:grid.trailing + 1])
    assert (sheared.cl, sheared.cd) == pytest.approx(
        (-2.0 * drag * np.sin(ALPHA), 2.0 * drag * np.cos(ALPHA)))


def test_a_uniform_stream_is_kept_on_a_moving_grid():
    engine = free_engine(24, 0.05, (0.8, 0.6), 100.0, extent=7.0)
    u, v = engine.potential.fluxes(0.0)
    wall = heaving(0.0)
    state = with_velocities(engine, wall, u, v)
    for step in range(1, 21):
        wall = heaving(step * engine.dt)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    assert wall.height[0] > 0.1
    assert state.u == pytest.approx(u, abs=1.0e-12)
    assert state.v == pytest.approx(v, abs=1.0e-12)


def test_a_decaying_vortex_converges_with_second_order_on_a_moving_grid():
    cells = np.array([32, 64, 128])
    errors = [VortexRun(n)() for n in cells]
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


def test_added_mass_is_symmetric_and_positive():
    _, mass = AddedMassRun('finite_volume', 'standard')()
    assert mass == pytest.approx(mass.T, abs=1.0e-12 * np.abs(mass).max())
    assert np.linalg.eigvalsh(0.5 * (mass + mass.T)).min() > 0.0


def test_added_mass_of_a_heaving_plate_approaches_pi_over_four():
    errors = [AddedMassRun('finite_volume', name)()[1].sum() / (np.pi / 4.0) - 1.0
              for name in ('fast', 'standard', 'fine')]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2] > 0.0, errors
    assert errors[2] < 3.0e-3


@pytest.mark.parametrize('n, expected', [(1, 0.8546), (2, 0.3592), (3, 0.2356)])
def test_added_mass_of_sine_modes(n, expected):
    columns, mass = AddedMassRun('finite_volume', 'standard')()
    mode = sine(columns, n)
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

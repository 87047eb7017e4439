# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How near a flow is to the largest time step it bears: CFL numbers, slip, warnings, advice."""

from dataclasses import replace

import numpy as np
import pytest

from dewing_cli.run_metrics import INSTANTS, Watch
from dewing_sim import parameters
from dewing_sim.errors import Diverged
from dewing_sim.fluid.base import EDGE, Wall
from dewing_sim.fluid.conformal import noslip
from dewing_sim.fluid.conformal.diagnostics import courant
from dewing_sim.fluid.conformal.engine import Conformal
from dewing_sim.fluid.conformal.geometry.exterior import metric_and_flux
from dewing_sim.fluid.conformal.grid import Grid, Preset
from dewing_sim.fluid.finite_volume.engine import FiniteVolume
from dewing_sim.fluid.finite_volume.grid import build
from dewing_sim.fluid.finite_volume.presets import Spacing
from dewing_sim.fluid.plate import Plate
from dewing_sim.rest import trim
from dewing_sim.verification.fluid.rigid_flow import parabola
from dewing_sim.verification.fluid.vortex import with_velocities
from dewing_sim.wing import Wing

ALPHA = np.radians(4.0)
CIRCULATION = 0.2
COARSE = Spacing(0.004, 0.02, 0.08, 0.003, 0.2, 0.2, 0.4, 0.2, 0.4, extent=20.0)


@pytest.fixture(scope='module')
def engine() -> Conformal:
    return Conformal(Grid.build(Preset(96, 72, 0.008)), 2500.0, ALPHA, 0.01)


def numbers(engine: Conformal, state):
    return courant(engine.solver.exterior, engine.grid, state.psi, state.incidence, state.map,
                   state.map_before, engine.dt)


def test_the_numbers_of_potential_flow_past_a_plate(engine):
    grid = engine.grid
    state = engine.rest(Wall.flat(engine.columns), CIRCULATION)
    zeta = grid.eta[1:] + 1j * grid.xi[:, None]
    slope = 0.5 * np.sinh(zeta)
    velocity = np.conj((0.5 * np.sinh(zeta - 1j * ALPHA) + 0.5j * CIRCULATION / np.pi) / slope)
    rate = velocity / slope
    exact = engine.dt * (np.abs(rate.real) / grid.width[1:] + np.abs(rate.imag) / grid.step)
    found, distance = numbers(engine, state)
    assert found == pytest.approx(exact, rel=0.02)
    place = 0.5 + 0.5 * np.cosh(zeta)
    near = np.minimum(np.abs(place), np.abs(place - 1.0)) < EDGE
    assert np.array_equal(distance < EDGE, near)
    monitor = engine.monitor(state)
    assert monitor.courant == pytest.approx(exact[~near].max(), rel=0.02)
    assert monitor.edge_courant == pytest.approx(exact[near].max(), rel=0.02)
    assert monitor.edge_courant > monitor.courant and monitor.slip == 0.0


@pytest.mark.parametrize('rate', [0.0, 0.3])
def test_the_numbers_are_of_the_fluxes_of_the_step_less_those_of_the_grid(engine, rate):
    state = engine.rest(Wall.flat(engine.columns), CIRCULATION)
    for step in range(1, 11):
        wall = parabola(engine.columns, rate * step * engine.dt, rate)
        state = engine.correct(engine.predict(state, wall), wall.velocity)
    fields = engine.solver.fields
    h2, grid_v, grid_u = metric_and_flux(
        engine.solver.exterior, state.shape, state.map.scale,
        (state.shape - state.shape_before) / engine.dt,
        (state.edges[0] - state.edges_before[0]) / engine.dt)
    v = 0.5 * (fields.v[:, 1:] + fields.v[:, :-1]) - grid_v[:, 1:]
    u = (0.5 * (fields.u + np.roll(fields.u, 1, axis=0)) - grid_u)[:, 1:]
    expected = engine.dt * (np.abs(v) / engine.grid.width[1:] + np.abs(u) / engine.grid.step)
    assert numbers(engine, state)[0] == pytest.approx(expected / h2[:, 1:], rel=1.0e-9)
    assert (np.abs(grid_v).max() > 0.1) == (rate > 0.0)
    assert engine.monitor(state).slip == engine.slip(state) == state.slip > 0.0


def test_the_numbers_of_a_uniform_stream_on_finite_volumes():
    engine = FiniteVolume(build(COARSE), 2500.0, ALPHA, 0.01)
    grid, wall = engine.grid, Wall.flat(engine.columns)
    u, v = np.ones((len(grid.x), len(grid.dy))), np.full((len(grid.dx), len(grid.y)), -0.5)
    monitor = engine.monitor(with_velocities(engine, wall, u, v))
    exact = engine.dt * (1.0 / grid.dx[:, None] + 0.5 / grid.dy)
    near = np.hypot(np.minimum(np.abs(grid.xc), np.abs(grid.xc - 1.0))[:, None], grid.yc) < EDGE
    assert near.any()
    assert monitor.courant == pytest.approx(exact[~near].max())
    assert monitor.edge_courant == pytest.approx(exact[near].max())
    assert monitor.slip == 0.0


def test_a_run_is_watched_at_every_step_and_at_some_instants():
    plate = Plate(ALPHA, 0.0, 2500.0, 'realtime', 0.02, 'conformal')
    state, watch, flows = plate.rest(), Watch(plate.fluid, 30), []
    for _ in range(30):
        state = plate.step(state)
        watch.add(state.flow)
        flows.append(state.flow)
    monitors = [plate.fluid.monitor(flow) for flow in flows[::30 // INSTANTS]]
    assert watch.metrics() == {
        'slip_max': max(flow.slip for flow in flows),
        'courant_max': max(monitor.courant for monitor in monitors),
        'edge_courant_max': max(monitor.edge_courant for monitor in monitors)}


def test_a_wing_warns_at_half_of_what_stops_it_once_the_start_is_over():
    assert 2.0 * noslip.HIGH_SLIP == noslip.LARGEST_SLIP
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'realtime',
        'numerics.time_step': 5.0e-4}))
    start = trim.start(wing)

    def caution(step: int, slip: float) -> str:
        return wing.caution(replace(start, step=step, flow=replace(start.flow, slip=slip)))

    later = round(wing.scales.time / wing.dt) + 1
    assert wing.monitor(start) == wing.fluid.monitor(start.flow)
    assert caution(later, 0.74) == caution(later - 2, 0.76) == ''
    assert caution(later, 0.76).startswith('the flow slips along the membrane at 0.76 free-stream')


def test_a_step_beyond_the_largest_is_refused_with_the_cfl_number_and_that_step():
    plate = Plate(np.radians(12.0), 0.0, 2500.0, 'realtime', 0.04, 'conformal')
    state = plate.rest()
    with pytest.raises(Diverged, match=(
            r'at a CFL number of \d+ next to the edges: lower the time step, now 0\.04 c/U where '
            r'this grid bears 0\.0205, or')):
        while state.time < 10.0:
            state = plate.step(state)

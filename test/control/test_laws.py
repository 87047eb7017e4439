# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Every control law: pure, bounded, bumpless, offset-free, and safe without measurements."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, strategies
from identified_wing import CAMBER, SLACK, design_model, identity, reduced_model
from scipy import optimize

from dewing_control.law.mpc import block_lengths
from dewing_control.law.registry import LAWS as KINDS
from dewing_control.law.registry import law
from dewing_control.law.supervisor import Supervisor
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.inputs.base import Inputs
from dewing_sim.plant import Measurement

pytest.importorskip('osqp')
MODEL_BASED = [kind for kind, law in KINDS.items() if law.needs_model]


def make(kind, **changes):
    changes = {name.replace('__', '.'): value for name, value in changes.items()}
    settings = parameters.load('controller', ControllerSettings, {'kind': kind, **changes})
    return law(settings, identity(), design_model(settings.command.period_steps))


LAWS = {kind: make(kind) for kind in KINDS}


def measurement(camber, time=0.0):
    return Measurement(time, camber * CAMBER, 1.5 * camber * CAMBER, 0.4, 0.06, 0.0)


def run(controller, plant, steps, begin=0.0, hide=()):
    """Return normalised cambers and V^2 of the loop; measurements ``hide`` are NaN."""
    state = plant.trim(begin)
    memory, cambers, commands = controller.start(begin), [], []
    for step in range(steps):
        camber = plant.observe(state).camber_mean / CAMBER
        cambers.append(camber)
        memory, v_squared = controller.step(
            memory, measurement(math.nan if step in hide else camber, step * plant.dt))
        commands.append(v_squared)
        state = plant.step(state, Inputs(v_squared))
    return np.array(cambers), np.array(commands)


@pytest.mark.parametrize('kind', KINDS)
def test_target_is_met_and_the_disturbance_rejected(kind):
    cambers, commands = run(LAWS[kind], reduced_model(disturbance=0.05), 4000)
    late = cambers[-2000:]
    assert late.mean() == pytest.approx(1.10, abs=5.0e-4)
    assert np.ptp(late) / 2.0 < (1.0e-3 if kind == 'pid' else 1.0e-4)
    assert commands.min() >= 0.0 and commands.max() < SLACK


@pytest.mark.parametrize('kind', KINDS)
@given(cambers=strategies.lists(strategies.floats(-1.0e3, 1.0e3), min_size=1, max_size=20))
def test_command_never_leaves_its_bounds(kind, cambers):
    controller = LAWS[kind]
    memory = controller.start(2.0e5)
    for camber in cambers:
        memory, v_squared = controller.step(memory, measurement(camber))
        assert 0.0 <= v_squared <= controller.v_squared_max


@pytest.mark.parametrize('kind', KINDS)
def test_step_is_a_function_of_memory_and_measurement_alone(kind):
    """Repeat a step after others that solved different programmes."""
    controller, rng = LAWS[kind], np.random.default_rng(5)
    memory, trail = controller.start(1.0e5), []
    for camber in 1.0 + 0.1 * rng.standard_normal(40):
        sample = measurement(camber)
        following, v_squared = controller.step(memory, sample)
        trail.append((memory, sample, v_squared))
        memory = following
    for before, sample, v_squared in reversed(trail):
        assert controller.step(before, sample)[1] == v_squared


@pytest.mark.parametrize('kind', KINDS)
def test_takes_over_without_a_bump(kind):
    _, v_squared = LAWS[kind].step(LAWS[kind].start(3.0e5), measurement(1.04))
    assert v_squared == pytest.approx(3.0e5, rel=1.0e-9)


@pytest.mark.parametrize('kind', KINDS)
def test_infeasible_target_gives_zero_volts_and_no_wind_up(kind):
    """Hold a target below the passive camber, then a feasible one: it is reached at once."""
    low, high = make(kind, reference__target=0.9), make(kind, reference__target=1.05)
    plant = reduced_model()
    state, memory = plant.rest(), low.start()
    for _ in range(3000):
        camber = plant.observe(state).camber_mean / CAMBER
        memory, v_squared = low.step(memory, measurement(camber))
        state = plant.step(state, Inputs(v_squared))
    assert v_squared == 0.0 and camber == pytest.approx(1.0, abs=1.0e-6)
    cambers = []
    for _ in range(1500):
        cambers.append(plant.observe(state).camber_mean / CAMBER)
        memory, v_squared = high.step(memory, measurement(cambers[-1]))
        state = plant.step(state, Inputs(v_squared))
    ramp = 0.15 / high_rate(high)
    assert abs(cambers[round(ramp / plant.dt) + 200] - 1.05) < 0.005
    assert max(cambers) < 1.055


def high_rate(controller):
    base = getattr(controller, 'base', controller)
    return base.rate


@pytest.mark.parametrize('kind', KINDS)
def test_missing_measurements_are_held_then_answered_by_zero_volts(kind):
    supervised = Supervisor(LAWS[kind], 1, 20)
    gap = range(1000, 1050)
    _, commands = run(supervised, reduced_model(), 4000, hide=gap)
    assert np.all(commands[1000:1020] == commands[999]) and commands[999] > 0.0
    assert np.all(commands[1020:1050] == 0.0)
    cambers, _ = run(supervised, reduced_model(), 4000, hide=gap)
    assert cambers[-1] == pytest.approx(1.10, abs=1.0e-3)


@pytest.mark.parametrize('kind', MODEL_BASED)
def test_no_offset_on_another_plant(kind):
    cambers, _ = run(LAWS[kind], reduced_model(stretch=0.93), 3000)
    assert cambers[-1] == pytest.approx(1.10, abs=1.0e-5)


@pytest.mark.parametrize('kind', KINDS)
def test_longer_control_period_still_holds_the_target(kind):
    controller = make(kind, command__period_steps=2, pid__kd=8.0e-3, pid__ki=3.0e3)
    cambers, _ = run(Supervisor(controller, 2, 20), reduced_model(), 3000)
    assert cambers[-1] == pytest.approx(1.10, abs=1.0e-3)


def test_mpc_without_active_bounds_is_lqg():
    plant = reduced_model(disturbance=0.02)
    np.testing.assert_allclose(run(LAWS['mpc'], plant, 800)[1], run(LAWS['lqg'], plant, 800)[1],
                               rtol=1.0e-9, atol=1.0e-3)


def programme(controller, free, applied, w_max):
    """Return w of the programme of `mpc` solved by another method (SLSQP)."""
    prediction = controller.prediction
    rows, weights = prediction.effect, prediction.lengths.astype(float)
    change = controller.rate_limit * 1.0e-4 * weights
    steps = np.diff(np.vstack([np.zeros_like(rows[0]), rows]), axis=0)
    jump = np.diff(free, prepend=applied)
    constraint = [optimize.LinearConstraint(rows, -free, w_max - free),
                  optimize.LinearConstraint(steps, -change - jump, change - jump)]
    found = optimize.minimize(lambda c: 0.5 * weights @ c**2, np.zeros_like(free), method='SLSQP',
                              jac=lambda c: weights * c, constraints=constraint,
                              options={'ftol': 1.0e-14, 'maxiter': 500})
    return free[0] + found.x[0]


@pytest.mark.parametrize('rate_limit', [1.0e5, 40.0])
def test_mpc_solves_its_programme(rate_limit):
    controller = make('mpc', mpc__moves=6, mpc__rate_limit=rate_limit)
    base, rng = controller.base, np.random.default_rng(7)
    active = 0
    for _ in range(20):
        z = base.observer.begin(1.0, 0.0) + 0.02 * rng.standard_normal(base.observer.inlet.size)
        held, applied = 0.05 * rng.standard_normal(), 0.1 * rng.random()
        free = held * controller.prediction.hold - controller.prediction.gain @ z
        w, change, _ = controller._solve(controller.start(), z, held, applied, 0.5)
        active += bool(np.any(change))
        assert w == pytest.approx(programme(controller, free, applied, 0.5), abs=1.0e-4)
    assert active >= 10


def test_blocks_fill_the_horizon():
    lengths = block_lengths(20, 100)
    assert lengths.sum() == 100 and lengths[0] == 1 and np.all(np.diff(lengths) >= -1)
    np.testing.assert_array_equal(block_lengths(5, 5), np.ones(5))
    with pytest.raises(BadInput, match='too short for mpc.moves = 20'):
        block_lengths(20, 10)


def test_effect_of_a_block_is_the_response_of_the_regulated_model():
    """Step x+ = (A - B K) x + B c with c = 1 in one block and read -K x + c."""
    controller = make('mpc', mpc__moves=5)
    model, feedback = controller.base.observer.design, controller.base.feedback
    lengths = controller.prediction.lengths
    owner = np.repeat(np.arange(5), lengths)
    starts = np.flatnonzero(np.diff(owner, prepend=-1))
    for block in range(5):
        x, row = np.zeros(model.order), []
        for step in range(starts[-1] + 1):
            change = float(owner[step] == block)
            w = change - feedback @ x
            if step in starts:
                row.append(w)
            x = model.a @ x + model.b * w
        np.testing.assert_allclose(controller.prediction.effect[:, block], row, atol=1.0e-12)


def test_governor_asks_only_for_what_is_ever_attainable():
    controller = LAWS['mpc']
    z = controller.base.observer.begin(1.0, 0.0)
    order = controller.base.observer.design.order
    z[order], z[order + 1:] = -0.05, (0.03, 0.04)
    assert controller.govern(z, 0.80, 0.9) == pytest.approx(-0.10)
    assert controller.govern(z, 0.95, 0.9) == pytest.approx(
        -0.05 / controller.base.observer.design.static_gain)
    assert controller.govern(z, 3.0, 0.9) == pytest.approx(0.90)


def test_a_change_of_gains_makes_no_bump():
    """Multiply all gains while an error persists: V^2 moves by the integral of one step only."""
    before = LAWS['pid']
    memory = before.start(3.0e5)
    for camber in (1.0, 1.0, 0.999, 0.999, 0.999, 0.999):
        memory, v_squared = before.step(memory, measurement(camber))
    memory = memory._replace(derivative=0.0, reference=memory.reference)
    gains = dataclasses.replace(before.gains, kp=10.0 * before.gains.kp, kd=0.0)
    after = dataclasses.replace(before, gains=gains, rate=1.0e-9)
    still = 1.0 * memory.reference - memory.error
    _, kept = after.step(memory, measurement(still))
    expected = memory.sum + after.dt * gains.ki * memory.error
    assert kept / SLACK == pytest.approx(expected, rel=1.0e-6)


@pytest.mark.parametrize('limit', [500.0, 100.0])
@pytest.mark.parametrize('kind', KINDS)
def test_a_limit_below_the_voltage_found_is_kept_at_once_and_held(kind, limit):
    """No law dips below the limit while the membrane gives way to it."""
    controller = make(kind, command__voltage_limit=limit)
    _, commands = run(controller, reduced_model(), 60, begin=800.0**2)
    assert commands == pytest.approx(limit**2, rel=1.0e-12) and commands.max() <= limit**2


def test_mpc_needs_a_horizon_and_a_known_kind():
    with pytest.raises(BadInput, match='kind'):
        make('fuzzy')
    with pytest.raises(BadInput, match='model is empty'):
        law(parameters.load('controller', ControllerSettings, {'kind': 'lqg'}), identity())

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Late commands: how they are delayed, what a design says of them, and laws that expect them."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from identified_wing import CAMBER, COARSE, design_model, identity, reduced_model
from loops import mode, pid

from dewing_control.law.registry import LAWS, law
from dewing_control.model.design import Design
from dewing_control.model.loop import Loop
from dewing_control.settings import ControllerSettings
from dewing_control.trial.closed_loop import closed_loop, controller, same_memory
from dewing_control.trial.comparison import Plan
from dewing_control.trial.comparison import controller as compared
from dewing_control.trial.late import Late, late
from dewing_control.trial.scenarios import SCENARIOS
from dewing_control.tuning.bounds import Bounds
from dewing_control.tuning.judge import judge
from dewing_control.tuning.tuning import tune
from dewing_sim import parameters
from dewing_sim.inputs.base import Inputs
from dewing_sim.linear import reduced
from dewing_sim.linear.state_space import frequency_response
from dewing_sim.plant import Measurement

STEP = 5.0e-4       # s
MODEL_BASED = [kind for kind, found in LAWS.items() if found.needs_model]


class Counter:
    """A controller that commands 1, 2, 3, ..."""

    def start(self, v_squared=0.0):
        return 0

    def step(self, memory, measurement):
        return memory + 1, float(memory + 1)


def commands(controller, steps, start=0.0):
    memory, given = controller.start(start), []
    for _ in range(steps):
        memory, v_squared = controller.step(memory, None)
        given.append(v_squared)
    return given


def settings(name='controller', **changes):
    changes = {key.replace('__', '.'): value for key, value in changes.items()}
    return parameters.load(name, ControllerSettings, changes)


def fly(delay, steps=2000, jitter=0.0, dt=STEP, **chosen):
    """Return the late cambers (a_ref) of a law on the linear wing disturbed as in Fig. 5."""
    pytest.importorskip('osqp')
    plant = reduced_model(dt, disturbance=0.05, damping=COARSE)
    made = controller(settings(**chosen), dataclasses.replace(identity(), dt=dt),
                      Design.of(plant.model, 'camber_mean'))
    run = closed_loop(plant, plant.rest(), late(made, delay, jitter), steps)
    return np.array([outputs.camber_mean for _, outputs in run])[steps // 2:] / CAMBER


def test_a_command_takes_effect_the_stated_number_of_steps_late():
    assert commands(Late(Counter(), 2), 5, start=7.0) == [7.0, 7.0, 1.0, 2.0, 3.0]
    assert commands(Late(Counter(), 0), 3) == [1.0, 2.0, 3.0]
    counter = Counter()
    assert late(counter, 0) is counter


def test_jitter_holds_its_share_of_the_commands_and_repeats():
    given = commands(Late(Counter(), 1, jitter=0.2, seed=3), 2000)
    assert given == commands(Late(Counter(), 1, jitter=0.2, seed=3), 2000)
    assert given != commands(Late(Counter(), 1, jitter=0.2, seed=4), 2000)
    held = np.mean([one == two for one, two in itertools.pairwise(given)])
    assert held == pytest.approx(0.2, abs=0.03)
    assert all(command in (k, given[k - 1]) for k, command in enumerate(given) if k)


def test_a_delayed_system_answers_with_its_phase_and_no_other_gain():
    system, frequency = pid(2.5, 9.7e3, 0.016, 1.15e-4).compensator(), np.array([3.0, 70.0, 900.0])
    turned = frequency_response(system, frequency, STEP) * np.exp(
        -2j * np.pi * frequency * STEP * 3)
    np.testing.assert_allclose(
        frequency_response(system.delayed(3), frequency, STEP), turned, rtol=1.0e-12)
    assert system.delayed(0) is system


@pytest.mark.parametrize('kp, ki, kd', [(0.0, 20.0, 0.0), (0.1, 40.0, 2.0e-4)])
def test_the_delay_margin_is_the_delay_that_makes_a_loop_unstable(kp, ki, kd):
    model = mode(damping=0.1, dt=STEP)
    compensator = pid(kp, ki, kd, 1.0e-4, model.dt).compensator()
    margin = Loop.of(model, compensator).delay_margin
    assert Loop.of(model, compensator.delayed(math.floor(0.99 * margin / model.dt))).stable
    assert not Loop.of(model, compensator.delayed(math.ceil(1.01 * margin / model.dt))).stable


def test_no_delay_upsets_a_loop_without_gain():
    assert Loop.of(mode(), pid(0.1, 0.0, dt=2.0e-6).compensator()).delay_margin < math.inf
    assert Loop.of(mode(damping=0.7), pid(0.1, 0.0, dt=2.0e-6).compensator()
                   ).delay_margin == math.inf


def test_a_design_is_judged_with_the_delay_it_states():
    model = design_model()
    strained = model.at_tension(0.82)
    found = [judge(settings(command__delay_steps=delay), identity(), model, strained)
             for delay in (0, 1)]
    assert found[0].peak < found[1].peak
    margins = [one.loop.delay_margin for one in found]
    assert margins[0] - margins[1] == pytest.approx(model.dt, rel=0.05)


def test_a_delay_counts_in_whole_control_periods():
    def periods(delay, period):
        return settings(command__delay_steps=delay,
                        command__period_steps=period).command.delay_periods
    assert [periods(*each) for each in ((0, 5), (1, 1), (3, 1), (1, 5), (5, 5), (6, 5))] == [
        0, 1, 3, 1, 1, 2]


def test_tuning_for_a_delay_keeps_its_bounds_with_it():
    model = design_model()
    best = tune(settings('late'), identity(), model, Bounds(), generations=3)
    assert best.settings.command.delay_steps == 1
    assert best.stable and best.peak <= 2.0
    assert judge(settings(command__delay_steps=1), identity(), model,
                 model.at_tension(Bounds.tension)).peak > 3.0       # of gains tuned without it


@pytest.mark.parametrize('name', ['late', 'realtime'])
def test_gains_for_late_commands_keep_their_bounds_with_them(name):
    chosen = settings(name)
    plant = (reduced_model(STEP, damping=COARSE) if name == 'realtime' else reduced_model())
    model = Design.of(plant.model, 'camber_mean')
    found = judge(chosen, dataclasses.replace(identity(), dt=model.dt), model,
                  model.at_tension(Bounds.tension))
    assert chosen.command.delay_steps == 1 and found.stable and found.peak < 2.2


@pytest.mark.parametrize('delay, jitter', [(0, 0.0), (1, 0.0), (2, 0.0), (1, 0.1)])
def test_the_controller_for_real_time_bears_commands_in_time_and_late(delay, jitter):
    cambers = fly(delay, jitter=jitter, name='realtime')
    assert cambers.mean() == pytest.approx(1.10, abs=1.0e-3)
    assert 0.5 * np.ptp(cambers) < (2.0e-3 if jitter else 1.0e-4)


def test_the_pid_of_real_time_holds_fig_5_within_one_and_a_half_percent():
    assert 0.5 * np.ptp(fly(1, name='realtime', kind='pid')) < 0.015


@pytest.mark.parametrize('kind', MODEL_BASED)
def test_a_law_with_the_delay_in_its_model_holds_where_the_same_without_does_not(kind):
    told = fly(2, kind=kind, command__delay_steps=2)
    assert told.mean() == pytest.approx(1.10, abs=1.0e-6) and np.ptp(told) < 1.0e-6
    assert 0.5 * np.ptp(fly(2, kind=kind)) > 0.05


@pytest.mark.parametrize('delay', [0, 1, 3])
def test_the_compensator_of_a_late_lqg_is_its_step(delay):
    """Cambers near the reference, where w = V^2 camber is linear, go through both."""
    chosen = settings(kind='lqg', command__delay_steps=delay, reference__target=1.0)
    made = law(chosen, identity(), design_model())
    compensator = made.compensator()
    errors = 1.0e-7 * np.random.default_rng(1).standard_normal(40)
    operating = 0.2 * made.v_squared_reference
    memory = made.start(operating)._replace(reference=1.0)
    z = made.observer.begin(1.0, 0.2)
    memory = memory._replace(z=z)
    state, steady = np.zeros(compensator.order), None
    for error in errors:
        memory, v_squared = made.step(memory, Measurement(
            0.0, (1.0 - error) * CAMBER, 0.0, 0.0, 0.0, 0.0))
        w = float(compensator.c[0] @ state + compensator.d[0, 0] * error)
        state = compensator.a @ state + compensator.b[:, 0] * error
        steady = 0.2 + w
        assert v_squared / made.v_squared_reference == pytest.approx(steady, abs=2.0e-6)


def test_another_delay_begins_anew():
    assert not same_memory(settings(kind='lqg'), settings(kind='lqg', command__delay_steps=2))
    assert same_memory(settings(kind='lqg'), settings(kind='lqg', lqg__control_weight=0.5))


def test_late_commands_are_compared_with_controllers_told_of_them(tmp_path):
    reduced.save(tmp_path / 'model.npz', reduced_model())
    plan = Plan(parameters.load('paper'), settings(model=str(tmp_path / 'model.npz')),
                identity(), 0.4, 0.2)
    other = dataclasses.replace(identity(), dt=STEP)
    made = compared('lqg', plan, SCENARIOS['jitter'], other)
    assert (made.delay, made.jitter) == (1, 0.1)
    assert made.controller.controller.delay == 1 and made.controller.period == 1
    tuned = compared('pid_tuned', plan, SCENARIOS['late0'], other)
    assert tuned.controller.gains == settings('realtime').pid


def test_a_late_plant_obeys_what_was_commanded_before():
    plant = reduced_model()
    states = closed_loop(plant, plant.rest(), Late(Counter(), 2), 5)
    assert [outputs.v_squared for _, outputs in states] == [0.0, 0.0, 1.0, 2.0, 3.0]
    assert plant.observe(plant.step(plant.rest(), Inputs(4.0))).v_squared == 4.0

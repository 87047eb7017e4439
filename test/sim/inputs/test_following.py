# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""What was jumpy becomes smooth: three equal lags, solved exactly between messages."""

import numpy as np
import pytest
from scipy import signal

from dewing_sim.inputs.following import SETTLED, STEEPEST, Following

LAG = 2.0e-3


def path(following, times):
    """Return value, rate and acceleration (times, 3) of the first component."""
    return np.array([following.after(time).now[:, 0] for time in times])


def test_a_jump_is_the_step_response_of_three_equal_lags():
    times = np.linspace(0.0, 0.02, 41)
    found = path(Following.at_rest(LAG, 1).towards(np.array([3.0]), np.zeros(1)), times)
    lags = signal.TransferFunction([1.0], np.poly([-1.0 / LAG] * 3) * LAG**3)
    assert found[:, 0] == pytest.approx(3.0 * signal.step(lags, T=times)[1], abs=1.0e-9)
    assert found[:, 1].max() == pytest.approx(3.0 * STEEPEST / LAG, rel=1.0e-3)
    assert found[:, 0].max() <= 3.0


def test_many_small_steps_are_one_large_step():
    """Exact in time, also on the way to a moving target and from one target to another."""
    following = Following.at_rest(LAG, 2).towards(np.array([1.0, -2.0]), np.array([5.0, 0.0]))
    following = following.after(1.0e-3).towards(np.array([-1.0, 0.5]), np.array([0.0, 7.0]))
    stepped = following
    for _ in range(30):
        stepped = stepped.after(1.0e-4)
    assert stepped.now == pytest.approx(following.after(3.0e-3).now, rel=1.0e-9)


def test_value_rate_and_acceleration_stay_continuous_when_the_target_jumps():
    before = Following.at_rest(LAG, 1).towards(np.ones(1), np.zeros(1)).after(3.0e-3)
    after = before.towards(np.array([-4.0]), np.array([2.0])).after(1.0e-9)
    assert after.now == pytest.approx(before.now, rel=1.0e-4)


def test_a_moving_target_is_met_without_lag_and_a_held_one_exactly():
    moving = Following.at_rest(LAG, 1).towards(np.ones(1), np.array([2.0]))
    assert moving.after(0.07).now[:, 0] == pytest.approx([1.14, 2.0, 0.0], abs=1.0e-6)
    held = Following.at_rest(LAG, 1).towards(np.ones(1), np.zeros(1))
    assert held.after(1.01 * SETTLED * LAG).now[:, 0].tolist() == [1.0, 0.0, 0.0]
    assert held.after(0.99 * SETTLED * LAG).now[0, 0] == pytest.approx(1.0, abs=1.0e-14)


@pytest.mark.parametrize('steps, within', [(1, 5.0e-3), (2, 1.0e-3), (5, 1.0e-4)])
def test_sampled_rates_add_up_to_what_the_value_changes_by(steps, within):
    """So does the impulse of the added mass, which is why the lag is two time steps at least."""
    dt = LAG / steps
    following, total = Following.at_rest(LAG, 1).towards(np.ones(1), np.zeros(1)), 0.0
    for _ in range(60 * steps):
        following = following.after(dt)
        total += dt * following.now[1, 0]
    assert total == pytest.approx(1.0, abs=within)

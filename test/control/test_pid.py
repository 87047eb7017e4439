# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""PID and supervisor: textbook responses, saturation, wind-up, bad measurements."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies
from scipy import signal

from dewing_control.law.pid import Pid, PidGains
from dewing_control.law.supervisor import Supervisor
from dewing_control.settings import ControllerSettings
from dewing_sim import parameters
from dewing_sim.errors import BadInput
from dewing_sim.plant import Measurement

GAINS = PidGains(kp=4.2, ki=1.0e4, kd=0.012, derivative_filter=2.0e-5, tracking_time=4.2e-4)
A_REF, V_L2 = 26.0e-6, 1.69e6


def make_pid(gains=GAINS, target=1.10, rate=2.0, v_squared_max=1.5625e6, dt=1.0e-4):
    return Pid(gains, 'camber_mean', target, rate, A_REF, V_L2, v_squared_max, dt)


def measurement(camber, time=0.0):
    return Measurement(time, camber * A_REF, 1.5 * camber * A_REF, 0.4, 0.06, 0.0)


def respond(pid, cambers, v_squared=0.0):
    memory, commands = pid.start(v_squared), []
    for camber in cambers:
        memory, command = pid.step(memory, measurement(camber))
        commands.append(command)
    return np.array(commands), memory


def test_unsaturated_response_is_the_backward_euler_transfer_function():
    """Compare with kp + ki T z/(z-1) + kd (z-1)/((Tf+T) z - Tf) from scipy."""
    dt, bias = 1.0e-4, 0.5
    pid = make_pid(rate=1.0e6, target=1.0)
    error = 1.0e-3 * np.random.default_rng(1).standard_normal(200)
    error[0] = 0.0          # the reference starts from the first camber
    commands, _ = respond(pid, 1.0 - error, v_squared=bias * V_L2)
    tf = GAINS.derivative_filter
    parallel = [([GAINS.kp], [1.0]), ([GAINS.ki * dt, 0.0], [1.0, -1.0]),
                ([GAINS.kd, -GAINS.kd], [tf + dt, -tf])]
    expected = bias + sum(signal.lfilter(b, a, error) for b, a in parallel)
    assert np.all((expected > 0.0) & (expected < 0.9))
    np.testing.assert_allclose(commands / V_L2, expected, rtol=0.0, atol=1.0e-10)


def test_takes_over_without_a_bump():
    commands, _ = respond(make_pid(target=0.97), [0.97], v_squared=3.0e5)
    assert commands[0] == pytest.approx(3.0e5, rel=1.0e-14)


def test_reference_ramps_to_the_target_and_stays():
    pid = make_pid(rate=2.0)
    memory, references = pid.start(), []
    for _ in range(600):
        memory, _ = pid.step(memory, measurement(1.0))
        references.append(memory.reference)
    steps = np.diff(references)
    assert references[0] == 1.0 and references[-1] == 1.10
    assert np.max(steps) <= 2.0e-4 * (1.0 + 1.0e-9)
    assert np.count_nonzero(steps) == pytest.approx(500, abs=1)


@given(cambers=strategies.lists(strategies.floats(-1.0e3, 1.0e3), min_size=1, max_size=50))
def test_command_never_leaves_its_bounds(cambers):
    commands, memory = respond(make_pid(), cambers)
    assert np.all((commands >= 0.0) & (commands <= 1.5625e6))
    assert all(map(math.isfinite, memory))


def test_integral_does_not_wind_up():
    """After a long infeasible demand the command leaves saturation in a few tracking times."""
    pid = make_pid(PidGains(1.0, 100.0, 0.0, 2.0e-5, 1.0e-3), target=1.0, rate=1.0e6)
    commands, _ = respond(pid, [1.0] + [1.5] * 5000 + [0.99] * 200)
    assert np.all(commands[200:5001] == 0.0)
    first_above_zero = np.flatnonzero(commands[5001:])[0]
    assert first_above_zero * pid.dt < 3.0 * pid.gains.tracking_time
    without, _ = respond(make_pid(PidGains(1.0, 100.0, 0.0, 2.0e-5, 1.0e3), target=1.0,
                                  rate=1.0e6), [1.0] + [1.5] * 5000 + [0.99] * 200)
    assert np.all(without == 0.0)


class Counter:
    """Answer with the number of the call, so that held commands show."""

    def start(self, v_squared=0.0):
        return 0

    def step(self, memory, _measurement):
        return memory + 1, float(memory + 1)


def supervise(supervisor, measurements, v_squared=7.0):
    memory, commands = supervisor.start(v_squared), []
    for item in measurements:
        memory, command = supervisor.step(memory, item)
        commands.append(command)
    return commands


GOOD, BAD = measurement(1.0), measurement(math.nan)


def test_control_period_holds_between_instants():
    assert supervise(Supervisor(Counter(), 3, 2), [GOOD] * 7) == [1, 1, 1, 2, 2, 2, 3]


def test_bad_measurements_hold_then_fail_safe_then_start_afresh():
    commands = supervise(Supervisor(Counter(), 1, 2), [GOOD, GOOD, BAD, BAD, BAD, BAD, GOOD])
    assert commands == [1, 2, 2, 2, 0, 0, 1]


def test_bad_first_measurement_holds_what_is_in_force():
    assert supervise(Supervisor(Counter(), 1, 1), [BAD, BAD, GOOD]) == [7, 0, 1]


def test_shipped_settings_load_and_reject_changes_out_of_range():
    settings = parameters.load('controller', ControllerSettings)
    assert settings.reference.target == 1.10
    with pytest.raises(BadInput, match='pid.kp = -1.0 is out of range: proportional gain'):
        parameters.replace(settings, {'pid.kp': -1.0})

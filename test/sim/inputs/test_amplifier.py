# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The amplifier's exact responses."""

import math

import pytest

from dewing_sim import parameters
from dewing_sim.inputs.amplifier import Amplifier


def run(amplifier, command, steps, dt=1.0e-4):
    square = 0.0
    for _ in range(steps):
        square = amplifier.drive(square, command, dt)
    return math.sqrt(square)


def test_the_shipped_amplifier_is_ideal():
    amplifier = Amplifier.of(parameters.load('paper').actuation)
    assert amplifier.drive(1.0, 123456.7, 1.0e-4) == 123456.7


@pytest.mark.parametrize('dt', [1.0e-4, 1.0e-3])
def test_a_step_follows_the_exponential_whatever_the_time_step(dt):
    amplifier = Amplifier(1250.0, lag=2.0e-3)
    assert run(amplifier, 800.0 ** 2, round(4.0e-3 / dt), dt) == pytest.approx(
        800.0 * (1.0 - math.exp(-2.0)), rel=1e-12)


def test_the_slew_rate_makes_a_ramp_both_ways():
    amplifier = Amplifier(1250.0, slew_rate=1.0e5)
    assert run(amplifier, 1000.0 ** 2, 40) == pytest.approx(400.0, rel=1e-12)
    assert math.sqrt(amplifier.drive(400.0 ** 2, 0.0, 1.0e-4)) == pytest.approx(390.0, rel=1e-12)


def test_the_output_ends_at_the_command_or_at_the_limit():
    amplifier = Amplifier(1250.0, slew_rate=1.0e6, lag=1.0e-4)
    assert run(amplifier, 900.0 ** 2, 100) == pytest.approx(900.0, rel=1e-9)
    assert run(amplifier, 3000.0 ** 2, 100) == pytest.approx(1250.0, rel=1e-9)

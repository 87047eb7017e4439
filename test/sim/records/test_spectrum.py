# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Lines and amplitudes of signals that are known exactly."""

import numpy as np
import pytest

from dewing_sim.records.spectrum import peaks, power_spectrum, relative

DT = 1.0e-3
TIME = DT * np.arange(2000)


def sine(frequency: float) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency * TIME)


def test_a_sine_on_a_bin_shows_half_its_amplitude_squared():
    frequency, power = power_spectrum(5.0 + 3.0 * sine(10.0), DT)
    assert frequency.shape == power.shape == (1001,)
    assert frequency[np.argmax(power)] == pytest.approx(10.0)
    assert power.max() == pytest.approx(4.5)
    assert power[0] < 1.0e-20


@pytest.mark.parametrize('frequency', [23.6, 26.21, 71.37])
def test_a_line_between_bins_is_found_to_a_tenth_of_a_bin(frequency):
    assert peaks(sine(frequency), DT) == [pytest.approx(frequency, abs=0.05)]


def test_lines_come_strongest_first_and_weak_ones_are_left_out():
    signal = 1.0 + sine(26.0) + 0.3 * sine(52.0) + 0.01 * sine(90.0)
    assert peaks(signal, DT) == pytest.approx([26.0, 52.0], abs=0.05)
    assert peaks(signal, DT, most=1) == pytest.approx([26.0], abs=0.05)
    assert peaks(signal, DT, floor=1.0e-5) == pytest.approx([26.0, 52.0, 90.0], abs=0.05)


@pytest.mark.parametrize('signal', [
    np.ones(100), np.zeros(100), np.arange(5.0), np.empty(0), 1.0 + 4.0e-5 * sine(26.0)])
def test_a_steady_or_very_short_signal_has_no_lines(signal):
    assert peaks(signal, DT) == []


def test_relative_mean_and_amplitude():
    signal = 2.0 * (0.95 + 0.05 * sine(10.0))
    assert relative(signal, 2.0) == pytest.approx((-0.05, 0.05))

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Excitation: shapes, spectra, and a V^2 that is never negative."""

import numpy as np
import pytest

from dewing_sim.errors import BadInput
from dewing_sysid import excitation


def test_pulse_lasts_one_sample():
    assert excitation.pulse(5).tolist() == [1.0, 0.0, 0.0, 0.0, 0.0]


def test_doublet_has_no_net_impulse():
    assert excitation.doublet(8, 3).tolist() == [1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 0.0, 0.0]


def test_prbs_holds_its_bits_and_has_a_white_autocorrelation():
    period = 2**excitation.REGISTER_BITS - 1
    bits = excitation.prbs(3 * period, 3)[::3]
    correlation = np.fft.ifft(np.abs(np.fft.fft(bits))**2).real
    assert set(np.unique(bits)) == {-1.0, 1.0}
    assert correlation[0] == pytest.approx(period)
    assert np.allclose(correlation[1:], -1.0)
    assert np.all(np.diff(excitation.prbs(3 * period, 3).reshape(-1, 3), axis=1) == 0.0)


def test_prbs_of_another_seed_is_another_sequence():
    assert not np.array_equal(excitation.prbs(200, 1, 1), excitation.prbs(200, 1, 99))


def test_prbs_refuses_an_empty_register():
    with pytest.raises(BadInput, match='seed = 0'):
        excitation.prbs(10, 1, 0)


def test_chirp_starts_at_zero_and_ends_at_the_upper_frequency():
    dt = 1.0e-4
    u = excitation.chirp(20000, dt, 10.0, 400.0, sweeping=0.9)
    crossings = np.flatnonzero(np.diff(np.signbit(u[:18000])))
    assert u[0] == pytest.approx(0.0, abs=1e-12)
    assert not u[18000:].any()
    assert 0.5 / (dt * np.diff(crossings)[-1]) == pytest.approx(400.0, rel=0.05)


@pytest.mark.parametrize('low, high', [(0.0, 10.0), (20.0, 10.0), (10.0, 5000.0)])
def test_chirp_refuses_impossible_sweeps(low, high):
    with pytest.raises(BadInput, match='Nyquist frequency 5000 Hz'):
        excitation.chirp(100, 1.0e-4, low, high)


def test_two_sided_signals_swing_about_a_high_operating_point():
    v_squared = excitation.about(excitation.prbs(100), 100.0, 400.0)
    assert set(v_squared) == {300.0, 500.0}


@pytest.mark.parametrize('shape', [excitation.prbs(100), excitation.chirp(100, 1e-4, 10, 400)])
def test_two_sided_signals_are_squeezed_where_v_squared_would_be_negative(shape):
    v_squared = excitation.about(shape, 100.0, 40.0)
    assert v_squared.min() >= 40.0
    assert v_squared.max() <= 140.0


@pytest.mark.parametrize('amplitude, rest', [
    (0.0, 0.0), (-1.0, 4.0), (np.nan, 0.0), (np.inf, 0.0), (1.0, -1.0), (1.0, np.nan)])
def test_about_refuses_bad_numbers(amplitude, rest):
    with pytest.raises(BadInput, match='V\\^2'):
        excitation.about(excitation.pulse(5), amplitude, rest)

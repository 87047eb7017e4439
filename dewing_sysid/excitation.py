# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Test signals for V^2: deviations u[k] from the operating point V0^2, held from t_k to t_k+1."""

import math

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.schema.numerals import apart, not_above

REGISTER_BITS = 11                      # the binary sequence repeats after 2^11 - 1 bits
TAP = 9                                 # x^11 + x^9 + 1 is primitive


def pulse(samples: int, hold: int = 1) -> np.ndarray:
    """Return one at the first ``hold`` samples, zero afterwards (paper section 2.3)."""
    u = np.zeros(samples)
    u[:hold] = 1.0
    return u


def doublet(samples: int, hold: int = 1) -> np.ndarray:
    """Return ``hold`` samples of one, as many of minus one, then zero: no net impulse."""
    u = pulse(samples, 2 * hold)
    u[hold:2 * hold] = -1.0
    return u


def step(samples: int) -> np.ndarray:
    """Return one throughout."""
    return np.ones(samples)


def prbs(samples: int, hold: int = 1, seed: int = 1) -> np.ndarray:
    """Return a maximum-length binary sequence of -1 and 1, each bit held ``hold`` samples.

    Its spectrum is flat within 3 dB up to 0.44 / (hold dt).  ``seed`` (from 1) is the start of
    the shift register, so different seeds give shifted copies of the one sequence.
    """
    count = math.ceil(samples / hold)
    bits = np.zeros(count + REGISTER_BITS, dtype=int)
    bits[:REGISTER_BITS] = [seed >> bit & 1 for bit in range(REGISTER_BITS)]
    if not bits.any():
        raise BadInput(f'seed = {seed} leaves the shift register empty: '
                       f'take 1 to {2**REGISTER_BITS - 1}')
    for k in range(count):
        bits[k + REGISTER_BITS] = bits[k] ^ bits[k + TAP]
    return np.repeat(2.0 * bits[:count] - 1.0, hold)[:samples]


def chirp(samples: int, dt: float, low: float, high: float, sweeping: float = 0.6) -> np.ndarray:
    """Return a sine of unit amplitude swept from ``low`` to ``high`` Hz, logarithmically.

    The sweep fills the share ``sweeping`` of the record; in the rest, at zero, the response
    decays, so that the ratio of output to input spectrum estimates the frequency response.
    """
    if not 0.0 < low < high < 0.5 / dt:
        raise BadInput(f'a sweep from {low:g} to {apart(high, 0.5 / dt)[0]} Hz does not fit '
                       f'between 0 and the Nyquist frequency {not_above(0.5 / dt)} Hz')
    time = dt * np.arange(math.ceil(sweeping * samples))
    u = np.zeros(samples)
    rate = math.log(high / low) / time[-1]
    u[:len(time)] = np.sin(2.0 * np.pi * low / rate * np.expm1(rate * time))
    return u


def about(shape: np.ndarray, amplitude: float, operating_v_squared: float) -> np.ndarray:
    """Return V^2 (V^2, shape ``(samples,)``) that follows ``shape`` about the operating point.

    ``amplitude`` (V^2) is the excursion from V0^2.  V^2 cannot be negative: where V0^2 is smaller
    than the downward excursion, the whole signal is halved and raised, into V0^2 to
    V0^2 + amplitude (a binary sequence then switches between the two).

    Raises `BadInput` if the amplitude is not positive or finite, or if V0^2 is negative.
    """
    if not (math.isfinite(amplitude) and amplitude > 0.0):
        raise BadInput(f'amplitude = {amplitude:g} V^2 must be positive and finite')
    if not (math.isfinite(operating_v_squared) and operating_v_squared >= 0.0):
        raise BadInput(f'operating V^2 = {operating_v_squared:g} V^2 must not be negative')
    if operating_v_squared + amplitude * shape.min() < 0.0:
        shape = 0.5 * (shape + 1.0)
    return operating_v_squared + amplitude * shape

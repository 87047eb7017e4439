# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Lines and amplitudes of a signal in time."""

import numpy as np

STEADY = 1.0e-4     # a relative range below which the lines are those of rounding and iteration
LEAST = 0.1         # of its scale: a range is compared with no smaller signal
SHEDDING = 5.0e-3   # of the mean lift: swings below it are no vortex shedding


def power_spectrum(signal: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies (Hz) and one-sided power of a uniformly sampled ``signal`` (n,).

    Hann-windowed periodogram of the signal less its mean, scaled so that a sine of amplitude a
    shows a line of a^2/2. ``dt`` is in s, n at least 2; the two arrays have shape (n // 2 + 1,).
    """
    count = len(signal)
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(count) / count)
    lines = np.fft.rfft(window * (signal - np.mean(signal))) / window.sum()
    power = np.abs(lines) ** 2
    power[1:(count + 1) // 2] *= 2.0        # the line at half the sampling rate has no mirror
    return np.fft.rfftfreq(count, dt), power


def peaks(signal: np.ndarray, dt: float, most: int = 5, floor: float = 1.0e-3,
          scale: float = 0.0) -> list[float]:
    """Return the frequencies (Hz) of the strongest lines of ``signal``, strongest first.

    Lines weaker than ``floor`` times the strongest are left out, as is a signal that is shorter
    than 8 samples or whose range is below `STEADY` of its largest value, or of `LEAST` times the
    ``scale`` of such signals if that is more. A parabola through the logarithm of three
    neighbouring powers places a line between the bins.
    """
    signal = np.asarray(signal, dtype=float)
    if len(signal) < 8 or np.ptp(signal) <= STEADY * max(np.abs(signal).max(), LEAST * scale):
        return []
    frequency, power = power_spectrum(signal, dt)
    found = _summits(power)
    found = found[power[found] >= floor * power.max()]
    strongest = found[np.argsort(power[found])[::-1][:most]]
    return [float(frequency[k] + _offset(power[k - 1:k + 2]) * frequency[1]) for k in strongest]


def shedding_lines(cl: np.ndarray, dt: float) -> list[float]:
    """Return the `peaks` of a lift coefficient (n,), none if it hardly swings.

    The trend is taken out first. Frequencies are in the inverse of the unit of ``dt``.
    """
    swing = _less_trend(cl)
    sheds = swing.std() > SHEDDING * max(abs(np.mean(cl)), 0.1)
    return peaks(swing, dt) if sheds else []


def _less_trend(signal: np.ndarray) -> np.ndarray:
    """Return ``signal`` less the straight line that fits it best."""
    time = np.arange(len(signal)) - 0.5 * (len(signal) - 1)
    square = time @ time
    slope = time @ signal / square if square else 0.0
    return signal - np.mean(signal) - slope * time


def _summits(power: np.ndarray) -> np.ndarray:
    """Return where ``power`` is above both its neighbours; of a plateau, the middle."""
    edges = np.flatnonzero(np.diff(power)) + 1          # where a run of equal values begins
    first, last = edges[:-1], edges[1:] - 1
    above = (power[first] > power[first - 1]) & (power[last] > power[last + 1])
    return (first[above] + last[above]) // 2


def _offset(power: np.ndarray) -> float:
    """Return where, in bins from the middle, the parabola through three log powers peaks."""
    left, middle, right = np.log(np.maximum(power, np.finfo(float).tiny))
    return 0.5 * (left - right) / (left - 2.0 * middle + right)


def relative(signal: np.ndarray, reference: float) -> tuple[float, float]:
    """Return mean and half the peak-to-peak range of ``signal`` as deviations from ``reference``.

    Both are fractions of ``reference``: (-0.05, 0.05) means 5 % lower on average, swinging by
    5 % to each side.
    """
    deviation = np.asarray(signal) / reference - 1.0
    return float(np.mean(deviation)), float(0.5 * np.ptp(deviation))

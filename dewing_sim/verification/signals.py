# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers drawn from signals: harmonics, means with error bars, ringing frequencies, trends."""

from typing import NamedTuple

import numpy as np

from dewing_sim.records import spectrum
from dewing_sim.structure.camber import peak

BLOCKS = 8              # of a time series, for the error of its mean


class Harmonics(NamedTuple):
    """Fundamental frequency and the amplitudes of its first multiples."""

    frequency: float
    amplitude: np.ndarray


class Mean(NamedTuple):
    """A time average and its standard error."""

    value: float
    error: float


def harmonics(signal: np.ndarray, dt: float, count: int = 4) -> Harmonics:
    """Return the strongest line of a periodic signal and ``count`` harmonics by least squares.

    The line of the windowed spectrum is refined until its harmonics explain most of the signal.
    """
    from scipy.optimize import minimize_scalar
    start = spectrum.peaks(signal, dt, most=1)[0]
    width = 0.5 / (len(signal) * dt)
    found = minimize_scalar(lambda f: _fit(signal, dt, f, count)[1], method='bounded',
                            bounds=(start - width, start + width), options={'xatol': 1.0e-6})
    return Harmonics(float(found.x), _fit(signal, dt, found.x, count)[0])


def whole_periods(signal: np.ndarray, dt: float, frequency: float) -> np.ndarray:
    """Return the last whole periods of ``signal``, at least one."""
    periods = max(1, int(len(signal) * dt * frequency))
    return signal[len(signal) - round(periods / (frequency * dt)):]


def _fit(signal: np.ndarray, dt: float, frequency: float, count: int) -> tuple[np.ndarray, float]:
    """Return the amplitudes of the harmonics and the squared residual."""
    phase = np.outer(2.0 * np.pi * frequency * dt * np.arange(len(signal)),
                     np.arange(1, count + 1))
    basis = np.column_stack([np.ones(len(signal)), np.cos(phase), np.sin(phase)])
    coefficients, *_ = np.linalg.lstsq(basis, signal, rcond=None)
    residual = signal - basis @ coefficients
    cosine, sine = coefficients[1:count + 1], coefficients[count + 1:]
    return np.hypot(cosine, sine), float(residual @ residual)


def mean_peak(x: np.ndarray, y: np.ndarray) -> tuple[Mean, Mean]:
    """Return height and place of the highest point of the mean of shapes (samples, nodes).

    The standard errors are from the mean shapes of `BLOCKS` blocks, 0 for too few samples.
    """
    height, place = peak(x.mean(axis=0), y.mean(axis=0))
    if len(y) < 2 * BLOCKS:
        return Mean(height, 0.0), Mean(place, 0.0)
    parts = [peak(part_x.mean(axis=0), part_y.mean(axis=0)) for part_x, part_y
             in zip(np.array_split(x, BLOCKS), np.array_split(y, BLOCKS))]
    errors = np.std(parts, axis=0, ddof=1) / np.sqrt(BLOCKS)
    return Mean(height, float(errors[0])), Mean(place, float(errors[1]))


def block_mean(signal: np.ndarray, blocks: int = BLOCKS) -> Mean:
    """Return the mean and its standard error from the scatter of the means of equal blocks."""
    length = len(signal) // blocks
    means = np.reshape(signal[len(signal) - blocks * length:], (blocks, length)).mean(axis=1)
    return Mean(float(means.mean()), float(means.std(ddof=1) / np.sqrt(blocks)))


def ringing(signals: np.ndarray, dt: float, delays: int = 12) -> np.ndarray:
    """Return eigenvalues (1/time) of the linear system whose free motion is ``signals`` (n, m).

    Least-squares one-step predictor on delayed samples, projected on six states (Hankel dynamic
    mode decomposition); of each conjugate pair the one above the real axis, slowest first.
    """
    samples = signals / np.abs(signals).max(axis=0)
    rows = len(samples) - delays
    hankel = np.hstack([samples[k:k + rows] for k in range(delays)]).T
    left, size, right = np.linalg.svd(hankel[:, :-1], full_matrices=False)
    states = 2 * signals.shape[1]
    left, size, right = left[:, :states], size[:states], right[:states]
    step = left.T @ hankel[:, 1:] @ right.T / size
    values = np.log(np.linalg.eigvals(step).astype(complex)) / dt
    above = values[values.imag > 0.0]
    return above[np.argsort(above.imag)]


def limit(parameter: np.ndarray, values: np.ndarray) -> float:
    """Return the value at parameter 0 of the polynomial through all points."""
    return float(np.polyfit(parameter, values, len(parameter) - 1)[-1])


class Richardson(NamedTuple):
    """Extrapolated value and observed order of three values on similar grids."""

    value: float
    order: float


def richardson(coarse: float, medium: float, fine: float, ratio: float) -> Richardson:
    """Extrapolate values on grids that are each ``ratio`` times finer.

    Where the differences do not shrink the order is not positive and the value is the finest.
    """
    first, second = medium - coarse, fine - medium
    if second == 0.0 or first / second <= 1.0:
        return Richardson(fine, 0.0)
    order = np.log(first / second) / np.log(ratio)
    return Richardson(float(fine + second / (ratio**order - 1.0)), float(order))

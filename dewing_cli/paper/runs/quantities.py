# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers drawn from flights: averages with error bars, mean shapes, lines, modes."""

from dataclasses import dataclass

import numpy as np

from dewing_cli.paper.runs.result import Result
from dewing_sim.records import spectrum
from dewing_sim.verification.signals import Mean, block_mean, mean_peak

FIRST_MODE = 72.4           # Hz, of the paper's membrane in still air: strip in potential flow
SHEDDING = (0.45, 0.85)     # Strouhal numbers f c/U between which a wing like this one sheds
STATIONS = np.linspace(0.0, 1.0, 101)       # x/c at which shapes are compared


def average(flight: Result, name: str, scale: float = 1.0) -> Mean:
    """Return the average of a series over ``scale``, with its error."""
    return block_mean(flight[name] / scale)


@dataclass(frozen=True)
class Peak:
    """Largest y* of a mean shape and its x/c, with standard errors."""

    height: Mean
    place: Mean


def shapes(flight: Result) -> np.ndarray:
    """Return y* (frames, stations): deflections over y_ref at `STATIONS`."""
    chord, y_ref = flight.values['chord'], flight.values['y_ref']
    return np.array([np.interp(STATIONS, x / chord, y / y_ref)
                     for x, y in zip(flight['x'], flight['y'])])


def peak(flight: Result) -> Peak:
    """Return where the mean shape is highest; errors from the mean shapes of blocks."""
    drawn = shapes(flight)
    return Peak(*mean_peak(np.broadcast_to(STATIONS, drawn.shape), drawn))


def lines(flight: Result, name: str = 'cl', most: int = 6) -> list[float]:
    """Return the lines of a series in Hz, strongest first."""
    return spectrum.peaks(flight[name], flight.values['sample'], most)


def shedding(flight: Result) -> float:
    """Return the strongest line of Cl between the Strouhal numbers of `SHEDDING`, in Hz.

    Stronger lines may be harmonics that a mode of the membrane amplifies. Zero without a line.
    """
    low, high = (number / flight.values['convective_time'] for number in SHEDDING)
    return next((line for line in lines(flight, most=12) if low < line < high), 0.0)


@dataclass(frozen=True)
class Modes:
    """Proper orthogonal decomposition of the fluctuating shape.

    ``shape`` (modes, stations) are orthonormal over the chord, ``energy`` (modes,) shares of the
    variance, ``amplitude`` (frames, modes) in y*.
    """

    shape: np.ndarray
    energy: np.ndarray
    amplitude: np.ndarray


def modes(drawn: np.ndarray) -> Modes:
    """Return the modes of shapes (frames, stations), by weighted singular values."""
    weight = np.sqrt(np.gradient(STATIONS))
    left, size, right = np.linalg.svd((drawn - drawn.mean(axis=0)) * weight, full_matrices=False)
    shape = right / weight
    sign = np.where(shape[np.arange(len(shape)), np.abs(shape).argmax(axis=1)] < 0.0, -1.0, 1.0)
    return Modes(shape * sign[:, None], size**2 / max(np.sum(size**2), 1.0e-300),
                 left * size * sign)

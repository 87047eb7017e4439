# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of an identification: responses (paper Fig. 4), singular values, Bode, poles."""

from pathlib import Path

import numpy as np

from dewing_sim.files import new_file
from dewing_sim.linear.model import Model
from dewing_sysid.experiment import Record
from dewing_sysid.identify import Identification
from dewing_sysid.plan import EXPERIMENT, FRESH, SWEEP

FILES = tuple(f'{name}.png' for name in (
    'response', 'singular_values', 'bode', 'poles', 'fresh'))
DRAWN_VALUES = 60                       # singular values shown


def save(found: Identification, folder: str | Path, overwrite: bool = False) -> list[Path]:
    """Write every figure as PNG into ``folder`` and return the paths."""
    drawings = {
        'response': lambda: responses(found.model, found.records[EXPERIMENT].head(found.window)),
        'singular_values': lambda: singular_values(found.model),
        'bode': lambda: bode(found.model, found.records.get(SWEEP)),
        'poles': lambda: pole_map(found.model)}
    if FRESH in found.records:
        drawings['fresh'] = lambda: responses(found.model, found.records[FRESH])
    paths = []
    for name, draw in drawings.items():
        paths.append(Path(folder) / f'{name}.png')
        with new_file(paths[-1], overwrite) as file:
            draw().savefig(file, dpi=120)
    return paths


def _axes(rows: int, columns: int = 1, height: float = 2.4):
    from matplotlib.figure import Figure
    figure = Figure(figsize=(7.0, height * rows), layout='constrained')
    return figure, figure.subplots(rows, columns, squeeze=False, sharex='col')


def responses(model: Model, record: Record):
    """Return a figure of recorded and predicted outputs against time, one row an output."""
    figure, axes = _axes(len(record.names))
    time = 1.0e3 * record.dt * np.arange(len(record.u))
    predicted = model.simulate(record.u)
    for row, (axis, name, unit) in enumerate(zip(axes[:, 0], record.names, model.units)):
        axis.plot(time, record.y[row], 'k', label='recorded')
        axis.plot(time, predicted[row], 'C1--', label=f'model, order {model.order}')
        axis.set_ylabel(f'{name} [{unit}]')
    axes[0, 0].legend()
    axes[-1, 0].set_xlabel('time [ms]')
    return figure


def singular_values(model: Model):
    """Return a figure of the Hankel singular values, the kept ones marked."""
    figure, axes = _axes(1, height=3.5)
    values = model.singular_values[:DRAWN_VALUES] / model.singular_values[0]
    number = np.arange(1, len(values) + 1)
    axes[0, 0].semilogy(number, values, 'k.', label='all')
    axes[0, 0].semilogy(number[:model.order], values[:model.order], 'C1o', label='kept')
    axes[0, 0].set(xlabel='number', ylabel='Hankel singular value / largest')
    axes[0, 0].legend()
    return figure


def bode(model: Model, sweep: Record | None = None):
    """Return gain and phase of every output, with the swept-sine estimate if there is one."""
    figure, axes = _axes(2, len(model.output_names), height=3.0)
    frequency = np.geomspace(1.0, 0.5 / model.dt, 800)
    _draw_response(axes, frequency, model.frequency_response(frequency), 'C1-', 'model')
    if sweep is not None:
        measured, estimate = swept_sine(sweep)
        _draw_response(axes, measured, estimate, 'k.', 'swept sine')
    for column, (name, unit) in enumerate(zip(model.output_names, model.units)):
        axes[0, column].set(title=name, ylabel=f'gain [{unit}/V²]')
        axes[1, column].set(xlabel='frequency [Hz]', ylabel='phase [deg]')
    axes[0, 0].legend()
    return figure


def _draw_response(axes, frequency, response, style, label):
    for column, values in enumerate(response):
        axes[0, column].loglog(frequency, np.abs(values), style, ms=3, label=label)
        lag = np.mod(45.0 - np.degrees(np.angle(values)), 360.0) - 45.0   # no flips about zero
        axes[1, column].semilogx(frequency, -lag, style, ms=3)


def swept_sine(sweep: Record) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies (Hz) and the estimate Y/U (outputs, frequencies) of a chirp record.

    Both are differenced before the transform, which leaves the ratio as it is and shrinks the
    leakage of what has not decayed; only frequencies with at least 2 % of the largest power,
    about those of the swept band, are returned.
    """
    u = np.fft.rfft(np.diff(sweep.u, prepend=0.0))
    y = np.fft.rfft(np.diff(sweep.y, axis=1, prepend=0.0))
    frequency = np.fft.rfftfreq(len(sweep.u), sweep.dt)
    power = np.abs(u)**2
    strong = (power > 0.02 * power.max()) & (frequency > 0.0)
    return frequency[strong], y[:, strong] / u[strong]


def pole_map(model: Model):
    """Return the poles in the z plane beside frequency against damping."""
    figure, axes = _axes(1, 2, height=3.5)
    plane, table = axes[0]
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    plane.plot(np.cos(angle), np.sin(angle), 'k', lw=0.5)
    plane.plot(model.poles.real, model.poles.imag, 'C1x')
    plane.set(aspect='equal', xlabel='Re z', ylabel='Im z')
    frequency, damping = model.modes()
    table.semilogy(damping, frequency, 'C1x')
    table.set(xlabel='damping ratio', ylabel='natural frequency [Hz]')
    return figure

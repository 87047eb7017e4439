# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a tuned loop: Bode, sensitivity, Nyquist, and its responses in time."""

from typing import Any

import numpy as np

from dewing_control.tuning.judge import Judged

NYQUIST_EXTENT = 3.0


def _figure(rows: int, columns: int, width: float, height: float) -> tuple[Any, Any]:
    from matplotlib.figure import Figure
    figure = Figure(figsize=(width, height), layout='constrained')
    return figure, figure.subplots(rows, columns, squeeze=False)


def bode(judged: Judged) -> Any:
    """Return gain and phase of L, and |S| at both tensions."""
    figure, axes = _figure(3, 1, 7.0, 8.0)
    gain, phase, sensitivity = axes[:, 0]
    for label, loop in (('at rest', judged.loop), ('lower tension', judged.strained)):
        gain.loglog(loop.frequency, np.abs(loop.gain), label=label)
        phase.semilogx(loop.frequency, np.degrees(np.unwrap(np.angle(loop.gain))))
        sensitivity.loglog(loop.frequency, np.abs(loop.sensitivity))
    gain.axhline(1.0, color='k', lw=0.5)
    sensitivity.axhline(judged.peak, color='k', lw=0.5, ls='--')
    gain.set(ylabel='|L|')
    phase.set(ylabel='phase of L [deg]')
    sensitivity.set(ylabel='|S|', xlabel='frequency [Hz]', title=f'Ms = {judged.peak:.3g}')
    gain.legend()
    return figure


def nyquist(judged: Judged) -> Any:
    """Return L in the complex plane with the circle that Ms keeps free about -1."""
    figure, axes = _figure(1, 1, 5.0, 5.0)
    axis, angle = axes[0, 0], np.linspace(0.0, 2.0 * np.pi, 200)
    for label, loop in (('at rest', judged.loop), ('lower tension', judged.strained)):
        axis.plot(loop.gain.real, loop.gain.imag, lw=0.9, label=label)
    axis.plot(-1.0 + np.cos(angle) / judged.peak, np.sin(angle) / judged.peak, 'k--', lw=0.7)
    axis.plot(-1.0, 0.0, 'k+')
    axis.set(xlim=(-NYQUIST_EXTENT, 1.0), ylim=(-2.0, 2.0), aspect='equal',
             xlabel='Re L', ylabel='Im L')
    axis.legend()
    return figure


def responses(model: np.ndarray, wing: np.ndarray, voltage: np.ndarray, dt: float) -> Any:
    """Return camber (of the passive one) on model and wing, and the voltage of the wing."""
    figure, axes = _figure(2, 1, 7.0, 5.0)
    camber, command = axes[:, 0]
    camber.plot(1.0e3 * dt * np.arange(1, wing.size + 1), wing, label='Navier-Stokes wing')
    camber.plot(1.0e3 * dt * np.arange(1, model.size + 1), model, '--', label='model')
    command.plot(1.0e3 * dt * np.arange(1, voltage.size + 1), voltage)
    camber.set(ylabel='camber / passive')
    command.set(ylabel='V', xlabel='time [ms]')
    camber.legend()
    return figure

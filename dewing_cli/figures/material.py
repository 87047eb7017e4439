# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the elastomer and its membrane, as in docs/material.md."""

from pathlib import Path

import numpy as np

from dewing_sim.files import new_file
from dewing_sim.structure.material.curves import Curves


def save(curves: Curves, folder: str | Path, overwrite: bool = False) -> list[Path]:
    """Write every figure as PNG into ``folder`` and return the paths.

    A figure without a curve, since it failed, is not made.
    """
    from matplotlib.figure import Figure
    has = {'stress': curves.stress is not None, 'tension': curves.tension is not None,
           'free_sheet': curves.free_voltage is not None, 'camber': bool(curves.camber)}
    paths = []
    for name, draw in DRAWINGS.items():
        if not has[name]:
            continue
        figure = Figure(figsize=(6.0, 3.6), layout='constrained')
        draw(figure.subplots(), curves)
        paths.append(Path(folder) / f'{name}.png')
        with new_file(paths[-1], overwrite) as file:
            figure.savefig(file, dpi=110)
    return paths


def stress(axes, curves: Curves):
    """Draw the passive stress against the stretch, three modes."""
    for mode, values in curves.stress.items():
        axes.semilogy(curves.stretch[1:], 1.0e-3 * values[1:], label=mode)
    axes.set(xlabel='stretch', ylabel='Cauchy stress [kPa]')
    axes.legend()


def tension(axes, curves: Curves):
    """Draw the tension of the flat membrane against the voltage."""
    axes.plot(curves.voltage, curves.tension, 'k')
    axes.set(xlabel='voltage [V]', ylabel='tension [N/m]')
    if curves.slack_voltage is not None:
        axes.plot(curves.slack_voltage, 0.0, 'ro', label=f'slack at {curves.slack_voltage:.0f} V')
        axes.legend()


def free_sheet(axes, curves: Curves):
    """Draw the voltage that holds a free sheet against its stretch, and the pull-in."""
    axes.plot(curves.free_stretch, curves.free_voltage, 'k')
    found = curves.pull_in
    if found:
        height = found.field * curves.thickness
        axes.plot(found.stretch, height, 'ro',
                  label=f'pull-in at {found.stretch:.4f}, {height:.0f} V')
        if np.isfinite(found.snapped_stretch):
            axes.plot([found.stretch, found.snapped_stretch], [height, height], 'r--',
                      label=f'snaps to {found.snapped_stretch:.2f}')
        axes.set_ylim(0.0, 2.0 * height)
        axes.legend()
    axes.set(xlabel='equal biaxial stretch', ylabel='voltage [V]')


def camber(axes, curves: Curves):
    """Draw the static camber of both elements against the voltage."""
    for name, style, label in (('membrane', 'k-', 'membrane'),
                               ('solid', 'C1--', 'solid, lower side pinned'),
                               ('solid_middle', 'C0:', 'solid, pinned in the middle')):
        if name in curves.camber:
            axes.plot(curves.camber_voltage, 100.0 * curves.camber[name], style, label=label)
    axes.set(xlabel='voltage [V]', ylabel='static camber [% chord]')
    axes.legend()


DRAWINGS = {'stress': stress, 'tension': tension, 'free_sheet': free_sheet, 'camber': camber}

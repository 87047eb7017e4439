# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A mode of the coupled wing at two phases: vorticity and membrane, a quarter period apart."""

from typing import Any

import numpy as np

from dewing_cli.figures.flow import VIEW
from dewing_sim.modes.modes import Mode, about
from dewing_sim.modes.propagator import Propagator
from dewing_sim.wing import Wing

REACH = 0.15                # chords, largest deflection drawn
SHADE = 99.0                # percentile of the vorticity with the deepest colour


def figure(wing: Wing, propagator: Propagator, mode: Mode) -> Any:
    """Return the figure; amplitudes are arbitrary, alike at both phases."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    drawn = Figure(figsize=(8.6, 3.6), layout='constrained', dpi=150.0)
    FigureCanvasAgg(drawn)
    phases = _phases(wing, propagator, mode.vector)
    reach = max(np.abs(y).max() for _x, y, _patches in phases) or 1.0
    shade = max(_shade(patches) for _x, _y, patches in phases) or 1.0
    for axes, (x, y, patches), title in zip(
            drawn.subplots(1, 2, sharey=True), phases, ('at its largest', 'a quarter period on')):
        for patch, value in patches:
            mesh = axes.pcolormesh(patch.x, patch.y, value / shade, cmap='RdBu_r', vmin=-1.0,
                                   vmax=1.0, shading='gouraud', rasterized=True)
        axes.plot(x, REACH * y / reach, color='k', lw=2.0)
        axes.plot(x[[0, -1]], [0.0, 0.0], 'o', color='k', ms=3.5)
        axes.set(xlim=VIEW[:2], ylim=VIEW[2:], aspect='equal', xlabel='x/c', title=title)
    drawn.axes[0].set_ylabel('y/c')
    if any(patches for _x, _y, patches in phases):
        drawn.colorbar(mesh, ax=drawn.axes, label='vorticity, relative', extend='both',
                       shrink=0.6)
    drawn.suptitle(f'{mode.frequency:.2f} Hz, growth {mode.growth:.2f} 1/s, damping ratio '
                   f'{mode.damping:.4f}, share of the membrane {mode.membrane_share:.3f}')
    return drawn


def _phases(wing: Wing, propagator: Propagator, vector: np.ndarray) -> list[tuple]:
    """Return two phases, the first with the membrane at its largest deflection."""
    parts = [_phase(wing, propagator, part) for part in (vector.real, vector.imag)]
    deflection = parts[0][1] + 1.0j * parts[1][1]
    turn = np.exp(-1.0j * np.angle(deflection[np.argmax(np.abs(deflection))]))
    turned = turn * vector
    return [_phase(wing, propagator, part) for part in (turned.real, -turned.imag)]


def _phase(wing: Wing, propagator: Propagator, part: np.ndarray) -> tuple:
    """Return x and deflection of the membrane, and patches with the change of their vorticity."""
    norm = float(np.linalg.norm(part)) or 1.0
    ahead, behind = about(propagator, part / norm)
    x = wing.membrane.surface(propagator.base.motion.position)[:, 0]
    rise = norm * (wing.membrane.surface(ahead.motion.position)
                   - wing.membrane.surface(behind.motion.position))[:, 1]
    fields = [wing.fluid.field(state.flow) for state in (ahead, behind)]
    if fields[0] is None:
        return x, rise, []
    return x, rise, [(one, norm * (one.value - other.value)) for one, other in zip(
        fields[0].vorticity, fields[1].vorticity, strict=True)]


def _shade(patches: list) -> float:
    """Return the vorticity of the deepest colour, the strongest one outside the wall's layers."""
    left, right, lower, upper = VIEW
    found = [np.percentile(np.abs(value[inside]), SHADE) for patch, value in patches
             if (inside := (patch.x > left) & (patch.x < right) & (patch.y > lower)
                 & (patch.y < upper)).any()]
    return max(found, default=0.0)

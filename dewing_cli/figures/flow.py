# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of the flow: vorticity, streamlines and the membrane, in the frame of the stream.

Deflections are exaggerated: the picture is sheared by (s - 1) Y(x) exp(-y^2), so that the flow
stays in touch with the membrane it is drawn with.
"""

import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable

import numpy as np

from dewing_sim.errors import BadInput
from dewing_sim.fluid.field import FlowField, Patch
from dewing_sim.state import State
from dewing_sim.wing import Wing

LIMIT = 25.0                            # U/c, the deepest colour
VIEW = (-0.45, 2.45, -0.75, 0.75)       # chords: left, right, lower, upper
STREAMLINES = 0.06                      # U c between two of them
RECIRCULATION = 0.015                   # the same close to the membrane's own
WITHIN = 0.3                            # chords beyond the view that are kept


@dataclass(frozen=True)
class Picture:
    """What is drawn of one instant; lengths in chords, in the frame of the stream."""

    field: FlowField
    membrane: np.ndarray            # (2, nodes), exaggerated
    title: str
    exaggeration: float


def picture(wing: Wing, state: State, exaggeration: float, view: tuple = VIEW) -> Picture:
    """Return the flow of ``state`` with deflections drawn ``exaggeration`` times as large.

    Raises `BadInput` for an engine without a picture.
    """
    x, y = wing.membrane.surface(state.motion.position).T
    field = wing.fluid.field(state.flow)
    if field is None:
        raise BadInput(f'the engine {wing.case.numerics.engine} has no picture of its flow')

    def drawn(px: np.ndarray, py: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        lift = (exaggeration - 1.0) * np.interp(px, x, y, 0.0, 0.0) * np.exp(-py**2)
        return _turned(px, py + lift, field.incidence)

    def shown(patches: list[Patch]) -> list[Patch]:
        return [_cut(Patch(*drawn(patch.x, patch.y), patch.value), view) for patch in patches]

    outputs = wing.observe(state)
    title = (f'{wing.case.flow.angle_of_attack_deg:g} deg, t = {1.0e3 * outputs.time:.1f} ms, '
             f'{outputs.voltage:.0f} V, Cl = {outputs.cl:.3f}')
    return Picture(FlowField(shown(field.vorticity), shown(field.stream), field.incidence),
                   np.array(_turned(x, exaggeration * y, field.incidence)), title, exaggeration)


def _turned(x: np.ndarray, y: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates in which the stream is horizontal, about mid-chord."""
    cos, sin = math.cos(alpha), math.sin(alpha)
    return 0.5 + cos * (x - 0.5) + sin * y, cos * y - sin * (x - 0.5)


def _cut(patch: Patch, view: tuple) -> Patch:
    """Return the rows and columns that reach into the view."""
    left, right, lower, upper = view
    inside = ((patch.x > left - WITHIN) & (patch.x < right + WITHIN)
              & (patch.y > lower - WITHIN) & (patch.y < upper + WITHIN))
    rows, columns = (np.flatnonzero(inside.any(axis=axis)) for axis in (1, 0))
    part = np.ix_(rows, columns)
    return Patch(patch.x[part], patch.y[part], patch.value[part])


def draw(axes: Any, shown: Picture, limit: float, view: tuple = VIEW) -> Any:
    """Draw into ``axes`` with colours from -limit to limit U/c; return the coloured mesh."""
    mesh = None
    for patch in shown.field.vorticity:
        mesh = axes.pcolormesh(patch.x, patch.y, patch.value, cmap='RdBu_r', shading='gouraud',
                               vmin=-limit, vmax=limit, rasterized=True)
    for patch in shown.field.stream:
        axes.contour(patch.x, patch.y, patch.value, _levels(patch.value), colors='#333333',
                     linewidths=0.45, linestyles='solid', alpha=0.7)
    axes.plot(*shown.membrane, color='k', lw=2.0, solid_capstyle='round')
    axes.plot(*shown.membrane[:, [0, -1]], 'o', color='k', ms=3.5)
    axes.set(xlim=view[:2], ylim=view[2:], aspect='equal', xlabel='x/c', ylabel='y/c',
             title=shown.title)
    axes.text(0.01, 0.02, f'deflection of the membrane × {shown.exaggeration:g}',
              transform=axes.transAxes, fontsize='small',
              bbox=dict(facecolor='w', alpha=0.8, edgecolor='none', pad=2.0))
    return mesh


def _levels(stream: np.ndarray) -> np.ndarray:
    """Return evenly spaced levels, closer about zero, the value on the membrane."""
    first, last = math.floor(stream.min() / STREAMLINES), math.ceil(stream.max() / STREAMLINES)
    close = np.arange(-STREAMLINES, STREAMLINES, RECIRCULATION)
    return np.unique(np.round(np.concatenate(
        [STREAMLINES * np.arange(first, last + 1), close]), 9))


def figure(shown: Picture, limit: float = LIMIT, view: tuple = VIEW, dpi: float = 150.0) -> Any:
    """Return a figure of one instant with its colour bar."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    height = 7.6 * (view[3] - view[2]) / (view[1] - view[0]) + 0.55
    drawn = Figure(figsize=(8.6, height), layout='constrained', dpi=dpi)
    FigureCanvasAgg(drawn)
    mesh = draw(drawn.subplots(), shown, limit, view)
    drawn.colorbar(mesh, label='vorticity [U/c]', extend='both', shrink=0.9, pad=0.01)
    return drawn


def png(drawn: Any) -> bytes:
    """Return a figure as PNG."""
    buffer = io.BytesIO()
    drawn.savefig(buffer, format='png')
    return buffer.getvalue()


def animate(pictures: Iterable[Picture], path: str | Path, limit: float = LIMIT,
            view: tuple = VIEW, dpi: float = 75.0, rate: float = 12.5) -> None:
    """Write the ``pictures`` to a GIF, or an MP4 by ffmpeg, at ``rate`` frames a second."""
    from matplotlib.animation import FFMpegWriter, PillowWriter
    pictures = iter(pictures)
    drawn = figure(next(pictures), limit, view, dpi)
    writer = (FFMpegWriter if Path(path).suffix == '.mp4' else PillowWriter)(fps=rate)
    with writer.saving(drawn, str(path), dpi):
        writer.grab_frame()
        for shown in pictures:
            axes = drawn.axes[0]
            axes.clear()
            draw(axes, shown, limit, view)
            writer.grab_frame()

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""How the figures of the report look."""

import io
from typing import Any

BLACK, BLUE, ORANGE, GREEN, PINK, AMBER, SKY = (
    '#222222', '#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9')
COLOURS = (BLUE, ORANGE, GREEN, PINK, AMBER, SKY, BLACK)        # told apart by every eye
STYLES = ('-', '--', '-.', ':', '-', '--', '-.')
WIDTH = 7.6                 # inches
DPI = 150.0
LOOK = {
    'font.size': 9.5, 'axes.titlesize': 10.0, 'axes.labelsize': 9.5, 'legend.fontsize': 8.5,
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.grid': True,
    'grid.color': '#e3e3e3', 'grid.linewidth': 0.6, 'lines.linewidth': 1.3,
    'legend.frameon': False, 'axes.axisbelow': True, 'axes.titlelocation': 'left'}


def axes(rows: int = 1, columns: int = 1, height: float = 2.6, **settings: Any,
         ) -> tuple[Any, Any]:
    """Return a figure and its axes (rows, columns); ``height`` in inches a row."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    figure = Figure(figsize=(WIDTH, height * rows), layout='constrained')
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False, **settings)


def legend(figure: Any, axis: Any, columns: int = 4) -> None:
    """Name the lines of ``axis`` above the figure, where they hide nothing."""
    figure.legend(*axis.get_legend_handles_labels(), loc='outside upper left', ncols=columns)


def png(figure: Any) -> bytes:
    """Return the figure as PNG."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format='png', dpi=DPI)
    return buffer.getvalue()

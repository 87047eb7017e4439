# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The figure of a comparison: error and voltage of every controller, one row a scenario."""

from typing import Any

import numpy as np

from dewing_control.trial.scenarios import SCENARIOS

ROWS = 4
WIDEST = 0.12           # of the passive camber: larger errors leave the axes


def draw(collected: dict[str, dict]) -> Any:
    """Return a figure of the first `ROWS` scenarios; ``collected`` as `comparison.run_all`."""
    from matplotlib.figure import Figure
    shown = list(collected)[:ROWS]
    figure = Figure(figsize=(11.0, 2.5 * len(shown)), layout='constrained')
    axes = figure.subplots(len(shown), 2, squeeze=False, sharex='col')
    for row, scenario in zip(axes, shown):
        for number, (name, (_, trial)) in enumerate(collected[scenario].items()):
            error = 100.0 * (trial.camber - SCENARIOS[scenario].target)
            row[0].plot(1.0e3 * trial.time, error, f'C{number}', lw=0.9, label=name)
            row[1].plot(1.0e3 * trial.time, np.sqrt(trial.v_squared), f'C{number}', lw=0.9)
        row[0].set(ylabel='error [% of camber]', title=scenario,
                   ylim=(-100.0 * WIDEST, 100.0 * WIDEST))
        row[1].set(ylabel='V')
    axes[0, 0].legend(fontsize='small', ncols=3)
    for axis in axes[-1]:
        axis.set_xlabel('time [ms]')
    return figure

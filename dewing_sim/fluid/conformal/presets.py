# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The named grids of the conformal engine."""

from dataclasses import dataclass

from dewing_sim.fluid.preset import GridPreset

NAME = 'conformal'


@dataclass(frozen=True)
class Preset(GridPreset):
    """Points around the wing (a multiple of 4), rows, first step of eta, outermost eta."""

    around: int
    rows: int
    first: float
    outermost: float = 5.0          # 37 chords


# With the largest steps a plate at 12 degrees sheds without slip that grows.
PRESETS = {
    'realtime': Preset(64, 72, 0.008, milliseconds=0.2, largest_step=0.0205),
    'fast': Preset(96, 72, 0.008, milliseconds=0.3, largest_step=0.0123),
    'standard': Preset(128, 96, 0.006, milliseconds=0.5, largest_step=0.0082),
    'reference': Preset(192, 128, 0.005, milliseconds=1.0, largest_step=0.0041),
}
PRESETS['fine'] = PRESETS['reference']      # a name of both engines

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The named grids of the finite-volume engine."""

from dataclasses import dataclass

from dewing_sim.fluid.preset import GridPreset

NAME = 'finite_volume'


@dataclass(frozen=True)
class Spacing:
    """Cell sizes (chords) that make a grid; growth is the increase of cell size per distance."""

    leading_edge: float             # dx at the leading edge
    trailing_edge: float            # dx at the trailing edge
    chordwise: float                # largest dx on the plate
    wall: float                     # dy at the plate
    growth_plate: float = 0.12      # along the plate, away from the edges
    growth_wake: float = 0.08
    growth_upstream: float = 0.20
    growth_near: float = 0.12       # across the boundary layer and the near wake
    growth_far: float = 0.30        # further than `near` from the plate
    near: float = 0.5
    extent: float = 50.0            # distance of the outer boundary


@dataclass(frozen=True)
class Preset(GridPreset):
    """A grid by its cell sizes."""

    spacing: Spacing


PRESETS = {
    'fast': Preset(Spacing(0.006, 0.015, 0.05, 0.0025, growth_plate=0.15, growth_wake=0.12,
                           growth_upstream=0.35, growth_near=0.14, growth_far=0.40, near=0.4),
                   milliseconds=0.4),
    'standard': Preset(Spacing(0.003, 0.006, 0.025, 0.001, growth_near=0.09, near=0.4),
                       milliseconds=1.0),
    'fine': Preset(Spacing(0.0015, 0.003, 0.015, 0.0007, growth_plate=0.07, growth_wake=0.04,
                           growth_upstream=0.12, growth_near=0.06, growth_far=0.15),
                   milliseconds=4.0),
}

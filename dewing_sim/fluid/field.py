# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Vorticity and stream function of a saved flow, for pictures."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Patch:
    """Values at the points of a structured mesh; three arrays of one shape."""

    x: np.ndarray
    y: np.ndarray
    value: np.ndarray


@dataclass(frozen=True)
class FlowField:
    """Patches of vorticity and of the stream function, between which either may jump.

    Coordinates are in chords in the axes of the chord, vorticity in U/c (counter-clockwise
    positive), the stream function in U c.  Both sides of the membrane have vorticity of their
    own.  ``incidence`` (rad) is that of the chord to the undisturbed stream.
    """

    vorticity: list[Patch]
    stream: list[Patch]
    incidence: float

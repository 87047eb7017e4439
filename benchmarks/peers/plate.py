# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The problem that every solver is given, in chords, free-stream speeds and air densities.

A plate at 4 degrees starts from rest in a stream of Re = 2500, rigid, or bending as a parabola
with the camber a (1 - cos 2 pi St t) at a frequency close to the first mode of the membrane.
"""

import numpy as np

REYNOLDS = 2500.0
ALPHA = np.radians(4.0)
STROUHAL = 1.44
AMPLITUDE = 0.005


def camber(time):
    """Return the camber of the bending plate in chords."""
    return AMPLITUDE * (1.0 - np.cos(2.0 * np.pi * STROUHAL * time))


def camber_rate(time):
    """Return its rate in U."""
    omega = 2.0 * np.pi * STROUHAL
    return AMPLITUDE * omega * np.sin(omega * time)


def parabola(x):
    """Return the height per camber at x/c."""
    return 4.0 * x * (1.0 - x)

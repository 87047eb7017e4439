# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Finite volumes on a membrane-following staggered grid."""

from dewing_sim.fluid.finite_volume.presets import NAME, PRESETS

__all__ = ['GRIDS', 'NAME', 'load']

GRIDS = tuple(PRESETS)


def load() -> type:
    """Return the class; its kernels are loaded, which takes a while."""
    from dewing_sim.fluid.finite_volume.engine import FiniteVolume
    return FiniteVolume

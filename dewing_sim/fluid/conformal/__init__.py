# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Vorticity on a conformal map that follows the membrane."""

from dewing_sim.fluid.conformal.presets import NAME, PRESETS

__all__ = ['GRIDS', 'NAME', 'load']

GRIDS = tuple(PRESETS)


def load() -> type:
    """Return the class; its kernels are loaded, which takes a while."""
    from dewing_sim.fluid.conformal.engine import Conformal
    return Conformal

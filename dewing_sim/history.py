# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The old place of `dewing_sim.records.history`, kept for one version."""

import warnings

from dewing_sim.records.history import History, Recorder, record

__all__ = ['History', 'Recorder', 'record']

warnings.warn('dewing_sim.history is now dewing_sim.records.history', DeprecationWarning,
              stacklevel=2)

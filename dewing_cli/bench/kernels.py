# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The time that compiled functions take within a step, whoever calls them.

Numba tells Python's profiler of each call of a compiled function from Python. What arguments and
results take to cross over is part of it; so is some tenth of a microsecond of the profiler.
"""

from collections.abc import Callable
from cProfile import Profile
from typing import Any

import numpy as np

from dewing_sim.machine.kernels import KERNELS


def kernel_time(work: Callable[[], Any], repetitions: int) -> float:
    """Return milliseconds in kernels a call of ``work``, in the median."""
    # By identity: a code object that has run is no longer equal to itself in a set.
    known = {id(function.__code__) for function in KERNELS}
    times = []
    for _ in range(repetitions):
        with Profile() as profile:
            work()
        times.append(sum(entry.inlinetime for entry in profile.getstats()
                         if id(entry.code) in known))
    return 1.0e3 * float(np.median(times))

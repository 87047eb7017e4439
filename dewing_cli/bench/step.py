# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The share of a step that is not spent in compiled kernels."""

from typing import Any

from dewing_cli.bench.timing import copy_time, median
from dewing_sim.parameters import Case


def time_step(case: Case, steps: int) -> dict[str, Any]:
    """Return the median times of a step of ``case``, of its kernels and of its outputs, in ms."""
    from dewing_cli.bench.kernels import kernel_time
    from dewing_sim.build import build_wing
    from dewing_sim.inputs.base import Inputs
    from dewing_sim.plant import measure
    built = build_wing(case)
    wing, state = built.plant, built.rest
    inputs = Inputs(case.actuation.voltage**2)

    def step():
        nonlocal state
        state = wing.step(state, inputs)
    step_ms, kernels_ms = median(step, steps), kernel_time(step, steps)
    found = {'kernels_ms': kernels_ms, 'step_ms': step_ms,
             'step_over_kernels': step_ms / kernels_ms,
             'measure_ms': median(lambda: measure(wing, state), steps),
             'observe_ms': median(lambda: wing.observe(state), steps),
             'copy_ms': copy_time(wing.fluid.cells, steps)}
    return {'cells': wing.fluid.cells, 'rtf': 1.0e3 * wing.dt / step_ms} | found

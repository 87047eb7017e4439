# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The time of a coupled step on a grid preset, and of its parts."""

from typing import Any

from dewing_cli.bench.timing import BLOCK, best, copy_time
from dewing_cli.progress import Laps
from dewing_sim import parameters


def time_preset(case: str, engine: str, preset: str, steps: int,
                changes: dict[str, Any]) -> dict[str, Any]:
    """Return cells, times and their parts of ``case`` on one grid preset of an engine."""
    from dewing_sim.inputs.base import Inputs
    from dewing_sim.wing import Wing
    wing = Wing(parameters.load(case, changes={'numerics.trim_time': 2.0} | changes | {
        'numerics.engine': engine, 'numerics.grid': preset}))
    state = wing.rest()
    v_squared = wing.case.actuation.voltage**2
    laps, passes = Laps(), 0
    for _ in range(steps):
        state = wing.step(state, Inputs(v_squared))
        laps.add()
        passes += state.iterations
    seconds = laps.best(BLOCK)
    cells = wing.fluid.cells
    return {'cells': cells, 'ms_per_step': 1.0e3 * seconds, 'ns_per_cell': 1.0e9 * seconds / cells,
            'rtf': wing.dt / seconds, 'coupling_iterations_mean': passes / steps,
            'bandwidth_ratio': 1.0e3 * seconds / copy_time(cells, steps),
            'parts': time_parts(wing, state, steps)}


def time_parts(wing: Any, state: Any, steps: int) -> dict[str, float]:
    """Return the times (ms) of the parts of a step that can run alone."""
    from dewing_sim.coupling.transfer import wall_of
    fluid, membrane, motion = wing.fluid, wing.membrane, state.motion
    wall = wall_of(fluid, membrane, motion.position, motion.velocity)
    prediction = fluid.predict(state.flow, wall)
    parts = {
        'predict_ms': lambda: fluid.predict(state.flow, wall),
        'correct_ms': lambda: fluid.correct(prediction, wall.velocity),
        'observe_ms': lambda: wing.observe(state),
    }
    parts |= {f'{name}_ms': work for name, work in fluid.parts(state.flow, wall).items()}
    return {name: best(work, steps) for name, work in parts.items()}

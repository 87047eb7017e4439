# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Transfer between membrane nodes and flow columns: force and virtual work pass exactly."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dewing_sim import parameters
from dewing_sim.coupling import transfer
from dewing_sim.errors import NotConverged
from dewing_sim.rest import trim
from dewing_sim.wing import Wing


def deformed(nodes: int, seed: int, camber: float) -> tuple[np.ndarray, np.ndarray]:
    """Return random node positions between fixed ends, and random velocities."""
    rng = np.random.default_rng(seed)
    x = np.concatenate(([0.0], np.sort(rng.uniform(0.02, 0.98, nodes - 2)), [1.0]))
    x = np.linspace(0.0, 1.0, nodes) * 0.7 + 0.3 * x
    y = camber * np.sin(np.pi * x) + 0.01 * camber * rng.normal(size=nodes)
    y[[0, -1]] = 0.0
    velocity = rng.normal(size=(nodes, 2))
    velocity[[0, -1]] = 0.0
    return np.stack((x, y), axis=1), velocity


@settings(max_examples=30, deadline=None)
@given(nodes=st.integers(3, 80), columns=st.integers(2, 90), seed=st.integers(0, 10**6),
       camber=st.floats(0.0, 0.3))
def test_transfer_conserves_force_and_virtual_work(nodes, columns, seed, camber):
    position, velocity = deformed(nodes, seed, camber)
    rng = np.random.default_rng(seed + 1)
    faces = np.concatenate(([0.0], np.sort(rng.uniform(0.01, 0.99, columns - 1)), [1.0]))
    dx, jump = np.diff(faces), rng.normal(size=columns)
    force = np.zeros(position.shape)
    transfer.add_nodal_force(position, jump, *transfer.overlaps(faces, position), force)
    _, w = transfer.wall(faces, position, velocity)
    size = np.abs(jump).max() * np.abs(velocity).max()
    assert force[:, 1].sum() == pytest.approx(np.sum(jump * dx), abs=1.0e-12 * size)
    assert np.sum(force * velocity) == pytest.approx(np.sum(dx * jump * w), abs=1.0e-10 * size)


def test_heaving_nodes_give_uniform_columns_and_sliding_nodes_move_the_slope():
    faces = np.linspace(0.0, 1.0, 8)**1.5
    position, _ = deformed(20, 3, 0.0)
    position[:, 1] = 0.25 * position[:, 0]
    heave = np.tile([0.0, 2.0], (20, 1))
    height, w = transfer.wall(faces, position, heave)
    assert height == pytest.approx(0.25 * faces)
    assert w == pytest.approx(np.full(7, 2.0))
    slide = np.tile([1.0, 0.0], (20, 1))
    assert transfer.wall(faces, position, slide)[1] == pytest.approx(np.full(7, -0.25))


def test_coupling_that_cannot_converge_says_so_and_keeps_the_last_state():
    case = parameters.load('paper', changes={'numerics.grid': 'fast',
                                             'numerics.coupling_iterations': 1,
                                             'numerics.coupling_tolerance': 1.0e-12})
    wing = Wing(case)
    state = trim.start(wing)
    with pytest.raises(NotConverged, match=r'step 1 \(t = 0\.0001 s\): coupling') as caught:
        wing.step(state, 0.0)
    assert caught.value.state is state


def test_coupling_is_stable_far_below_the_added_mass():
    case = parameters.load('paper', changes={'numerics.grid': 'fast', 'membrane.density': 30.0})
    wing = Wing(case)
    assert wing.membrane.mass.sum() < 0.03          # the first mode's added mass is 0.85 / 2
    state = trim.start(wing)
    passes = []
    for _ in range(60):
        state = wing.step(state, 0.0)
        passes.append(state.iterations)
    assert max(passes[1:]) <= 5
    assert 0.0 < wing.observe(state).camber_max < 1.0e-3


def test_extrapolated_loads_foresee_the_shape():
    """After a jump of voltage too: what the flow does next is smoother than the motion."""
    wing = Wing(parameters.load('paper', changes={
        'numerics.engine': 'conformal', 'numerics.grid': 'fast', 'numerics.time_step': 5.0e-4,
        'numerics.trim_time': 4.0}))
    knowing = ignorant = trim.march(wing)
    passes = []
    for step in range(12):
        v_squared = 900.0**2 if step > 3 else 0.0
        ignorant = wing.step(dataclasses.replace(knowing, still_jumps=np.empty((0, 0))),
                             v_squared)
        knowing = wing.step(knowing, v_squared)
        passes.append((knowing.iterations, ignorant.iterations))
    assert len(knowing.still_jumps) == 3
    ours, theirs = np.sum(passes, axis=0)
    assert ours <= theirs - 8, passes
    assert knowing.motion.position == pytest.approx(ignorant.motion.position, abs=1.0e-6)

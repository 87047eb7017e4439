# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Transfer between membrane nodes and flow columns: what passes exactly on meshes that differ."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dewing_sim.coupling import transfer
from dewing_sim.structure.follower import pressure_force

MESHES = {'nodes': st.integers(3, 80), 'columns': st.integers(2, 90),
          'seed': st.integers(0, 10**6)}
CAMBER = st.floats(-0.3, 0.3)


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


def cut(columns: int, seed: int) -> np.ndarray:
    """Return random column faces from 0 to 1."""
    inner = np.random.default_rng(seed + 1).uniform(0.01, 0.99, columns - 1)
    return np.concatenate(([0.0], np.sort(inner), [1.0]))


def force_of(faces, position, jump) -> np.ndarray:
    """Return the nodal forces of column pressure jumps."""
    force = np.zeros(position.shape)
    transfer.add_nodal_force(position, jump, *transfer.overlaps(faces, position), force)
    return force


def heights(faces, position) -> np.ndarray:
    """Return the heights of a polygon at the column faces."""
    return np.interp(faces, *position.T)


@pytest.mark.parametrize('nodes, columns', [(2, 1), (2, 5), (9, 1), (9, 8), (9, 24), (17, 8)])
def test_uniform_pressure_is_the_structure_s_own_follower_load(nodes, columns):
    """Matching meshes, those that divide each other and those that do not are alike."""
    x = np.linspace(0.0, 1.0, nodes)
    position = np.stack((x, 0.2 * x * (1.0 - x)), axis=1)
    force = force_of(np.linspace(0.0, 1.0, columns + 1), position, np.full(columns, 3.0))
    assert force == pytest.approx(pressure_force(position, 3.0), abs=1.0e-14)


def test_a_jump_on_one_column_loads_the_element_behind_it_by_the_lever():
    position = np.array([[0.0, 0.0], [0.4, 0.1], [1.0, 0.0]])
    force = force_of(np.array([0.0, 0.1, 0.3, 1.0]), position, np.array([0.0, 5.0, 0.0]))
    total = 5.0 * 0.2 * np.array([-0.25, 1.0])      # normal to the slope 1/4, over its width
    assert force == pytest.approx(np.array([0.5 * total, 0.5 * total, [0.0, 0.0]]))


@settings(max_examples=40, deadline=None)
@given(**MESHES, camber=CAMBER)
def test_force_and_moment_pass_exactly(nodes, columns, seed, camber):
    """Force: integral of jump (-Y_x, 1) dx; moment: of jump (x + Y Y_x) dx, for a polygon Y."""
    position, _ = deformed(nodes, seed, camber)
    faces = cut(columns, seed)
    jump = np.random.default_rng(seed + 2).normal(size=columns)
    force, height = force_of(faces, position, jump), heights(faces, position)
    size = np.abs(jump).max()
    assert force.sum(axis=0) == pytest.approx(
        [-jump @ np.diff(height), jump @ np.diff(faces)], abs=1.0e-12 * size)
    moment = position[:, 0] @ force[:, 1] - position[:, 1] @ force[:, 0]
    assert moment == pytest.approx(0.5 * jump @ np.diff(faces**2 + height**2), abs=1.0e-12 * size)


@settings(max_examples=40, deadline=None)
@given(**MESHES, camber=CAMBER)
def test_virtual_work_passes_exactly(nodes, columns, seed, camber):
    position, velocity = deformed(nodes, seed, camber)
    faces = cut(columns, seed)
    dx, jump = np.diff(faces), np.random.default_rng(seed + 2).normal(size=columns)
    _, w = transfer.wall(faces, position, velocity)
    size = np.abs(jump).max() * np.abs(velocity).max()
    assert np.sum(force_of(faces, position, jump) * velocity) == pytest.approx(
        np.sum(dx * jump * w), abs=1.0e-10 * size)


@settings(max_examples=40, deadline=None)
@given(**MESHES, slope=st.floats(-0.5, 0.5))
def test_linear_fields_pass_exactly(nodes, columns, seed, slope):
    """A straight wall with a velocity linear in x: columns take its value at their centres."""
    position, _ = deformed(nodes, seed, 0.0)
    position[:, 1] = slope * position[:, 0]
    rise, slide = 2.0 - 3.0 * position[:, 0], 0.5 + position[:, 0]
    faces = cut(columns, seed)
    height, w = transfer.wall(faces, position, np.stack((slide, rise), axis=1))
    centre = 0.5 * (faces[1:] + faces[:-1])
    assert height == pytest.approx(slope * faces, abs=1.0e-14)
    assert w == pytest.approx(2.0 - 3.0 * centre - slope * (0.5 + centre), abs=1.0e-11)


@settings(max_examples=40, deadline=None)
@given(**MESHES, camber=CAMBER)
def test_columns_sweep_the_area_that_the_nodes_sweep(nodes, columns, seed, camber):
    """d/dt of the area under a polygon between fixed ends, by differences of its shoelaces."""
    position, velocity = deformed(nodes, seed, camber)
    faces = cut(columns, seed)
    _, w = transfer.wall(faces, position, velocity)

    def area(time):
        x, y = (position + time * velocity).T
        return 0.5 * np.sum((y[1:] + y[:-1]) * np.diff(x))

    # The area is quadratic in time, so that central differences are exact.
    assert w @ np.diff(faces) == pytest.approx(0.5 * (area(1.0) - area(-1.0)),
                                               abs=1.0e-11 * nodes)


@settings(max_examples=40, deadline=None)
@given(**MESHES)
def test_overlaps_share_out_the_chord_once(nodes, columns, seed):
    position, _ = deformed(nodes, seed, 0.1)
    faces = cut(columns, seed)
    place, width = transfer.overlaps(faces, position)
    each = width.sum(axis=1)
    assert each.min() > 0.0 and width.min() >= 0.0
    assert np.bincount(place[:, 0], each, nodes - 1) == pytest.approx(np.diff(position[:, 0]),
                                                                      abs=1.0e-14)
    assert np.bincount(place[:, 1], each, columns) == pytest.approx(np.diff(faces), abs=1.0e-14)


def test_faces_that_meet_nodes_leave_no_empty_overlap():
    position = np.stack((np.linspace(0.0, 1.0, 5), np.zeros(5)), axis=1)
    place, width = transfer.overlaps(np.linspace(0.0, 1.0, 5), position)
    assert place.tolist() == [[k, k] for k in range(4)]
    assert width == pytest.approx(np.full((4, 2), 0.125))


def test_beyond_the_edges_the_wall_keeps_their_height_and_takes_no_load():
    position = np.array([[0.0, 0.02], [0.5, 0.1], [1.0, -0.03]])
    faces = np.array([-0.5, -0.1, 0.0, 0.6, 1.0, 1.2])
    velocity = np.ones((3, 2)) * [0.0, 4.0]
    height, w = transfer.wall(faces, position, velocity)
    assert height == pytest.approx([0.02, 0.02, 0.02, heights(0.6, position), -0.03, -0.03])
    assert w == pytest.approx([0.0, 0.0, 4.0, 4.0, 0.0])
    assert not force_of(faces, position, np.array([9.0, 9.0, 0.0, 0.0, 9.0])).any()


def test_coasting_is_the_velocity_without_acceleration_of_bdf2():
    """3 w - 4 w_n + w_n-1 = 0 on every column."""
    faces = cut(11, 3)
    before, rate_before = deformed(20, 1, 0.10)
    now, rate = deformed(20, 1, 0.12)
    now[:, 0] = before[:, 0]
    w = transfer.coasting_velocity(faces, now, 1.5 * rate, before, rate_before)
    past = transfer.wall(faces, before, rate_before)[1]
    present = transfer.wall(faces, now, 1.5 * rate)[1]
    assert 3.0 * w - 4.0 * present + past == pytest.approx(np.zeros(11), abs=1.0e-13)


@settings(max_examples=20, deadline=None)
@given(**MESHES, camber=CAMBER)
def test_a_wall_faster_than_foreseen_is_resisted_by_the_matrix(nodes, columns, seed, camber):
    position, velocity = deformed(nodes, seed, camber)
    faces, rng = cut(columns, seed), np.random.default_rng(seed + 2)
    jump, reference = rng.normal(size=(2, columns))
    impedance = np.asfortranarray(rng.normal(size=(columns, columns)))
    force = np.ones(position.shape)
    load = transfer.ColumnLoad(faces, jump, reference, impedance, 0.7)
    transfer.add_load(load, position, velocity, force)
    w = transfer.wall(faces, position, velocity)[1]
    total = jump - impedance @ (w - reference) + 0.7
    assert force - 1.0 == pytest.approx(force_of(faces, position, total),
                                        abs=1.0e-12 * np.abs(total).max() * columns)

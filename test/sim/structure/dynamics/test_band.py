# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Bands plus a matrix of low rank: closed forms, then numpy on random ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import solve_banded

from dewing_sim.structure.dynamics.band import Inverse, LowRank, factorise, full, substitute

WIDTHS, SIZES, SEEDS = st.integers(1, 9), st.integers(1, 40), st.integers(0, 10**6)


def string(m: int) -> np.ndarray:
    """Return the band of the second differences (-1, 2, -1) between fixed ends."""
    band = np.zeros((3, m))
    band[0, 1:], band[1], band[2, :-1] = -1.0, 2.0, -1.0
    return band


def influence(m: int) -> np.ndarray:
    """Return its inverse, the deflections of a string: i (m + 1 - j) / (m + 1) for i <= j."""
    i, j = np.ogrid[1:m + 1, 1:m + 1]
    return np.minimum(i, j) * (m + 1.0 - np.maximum(i, j)) / (m + 1.0)


def random_band(width: int, m: int, seed: int) -> np.ndarray:
    """Return a symmetric, diagonally dominant band (2 width + 1, m)."""
    rng = np.random.default_rng(seed)
    band = np.zeros((2 * width + 1, m))
    for offset in range(1, min(width, m - 1) + 1):
        band[width + offset, :m - offset] = rng.normal(size=m - offset)
        band[width - offset, offset:] = band[width + offset, :m - offset]
    band[width] = np.abs(band).sum(axis=0) + rng.uniform(0.5, 2.0, m)
    return band


def random_low_rank(m: int, rank: int, seed: int) -> LowRank:
    """Return a basis with zeros and a weight that need not be symmetric, as of an engine."""
    rng = np.random.default_rng(seed)
    basis = rng.normal(size=(m, rank)) * (rng.random((m, rank)) < 0.5)
    weight = rng.normal(size=(rank, rank))
    return LowRank(basis, weight @ weight.T + 0.1 * rng.normal(size=(rank, rank)))


@pytest.mark.parametrize('m', [1, 2, 3, 50])
def test_a_string_bends_by_its_influence_function(m):
    rows = np.eye(m)
    substitute(factorise(string(m)), rows)
    assert rows == pytest.approx(influence(m), rel=1.0e-12)


def test_pivots_of_a_string_are_ratios_of_whole_numbers():
    factors = factorise(string(30))
    k = np.arange(1.0, 31.0)
    assert 1.0 / factors[:, 0] == pytest.approx((k + 1.0) / k, rel=1.0e-13)
    assert factors[:-1, 1] == pytest.approx(-k[:-1] / (k[:-1] + 1.0), rel=1.0e-13)


@pytest.mark.parametrize('place', [0, 7, 19])
def test_a_spring_under_a_string_shares_the_load(place):
    """Sherman and Morrison: A^-1 - s A^-1 e e^T A^-1 / (1 + s e^T A^-1 e)."""
    m, spring = 20, 3.0
    basis = np.zeros((m, 1))
    basis[place] = 1.0
    inverse = Inverse.of(string(m), LowRank(basis, np.array([[1.5]])), 2.0)
    bent = influence(m)
    expected = bent - spring * np.outer(bent[:, place], bent[place]) / (
        1.0 + spring * bent[place, place])
    found = np.array([inverse(load)[0] for load in np.eye(m)])
    assert found == pytest.approx(expected, rel=1.0e-11, abs=1.0e-12)


@settings(max_examples=60, deadline=None)
@given(width=WIDTHS, m=SIZES, seed=SEEDS)
def test_factors_rebuild_the_band_and_solve_it(width, m, seed):
    band = random_band(width, m, seed)
    matrix, factors = full(band), factorise(band)
    lower = np.eye(m)
    for column in range(m):
        for i in range(1, min(width, m - 1 - column) + 1):
            lower[column + i, column] = factors[column, i]
    rebuilt = lower @ np.diag(1.0 / factors[:, 0]) @ lower.T
    assert rebuilt == pytest.approx(matrix, abs=1.0e-13 * np.abs(matrix).max())
    right = np.random.default_rng(seed + 1).normal(size=(3, m))
    rows = right.copy()
    substitute(factors, rows)
    assert rows == pytest.approx(np.linalg.solve(matrix, right.T).T, abs=1.0e-12)


@settings(max_examples=30, deadline=None)
@given(width=WIDTHS, m=st.integers(10, 40), seed=SEEDS)
def test_the_layout_is_that_of_scipy(width, m, seed):
    band = random_band(width, m, seed)
    right = np.random.default_rng(seed + 2).normal(size=m)
    assert full(band) @ solve_banded((width, width), band, right) == pytest.approx(
        right, abs=1.0e-12)


@settings(max_examples=60, deadline=None)
@given(width=WIDTHS, m=SIZES, rank=st.integers(0, 12), factor=st.floats(0.0, 20.0), seed=SEEDS)
def test_inverse_of_a_band_plus_low_rank_is_that_of_the_full_matrix(
        width, m, rank, factor, seed):
    """Within rounding of A^-1 b times the conditions, that of I + W B^T A^-1 B included."""
    band, low_rank = random_band(width, m, seed), random_low_rank(m, rank, seed + 1)
    basis, weight = low_rank.basis, factor * low_rank.weight
    matrix = full(band) + basis @ weight @ basis.T
    core = np.eye(rank) + weight @ basis.T @ np.linalg.solve(full(band), basis)
    worst = np.prod([np.linalg.cond(part) for part in (matrix, full(band), core) if part.size])
    vector = np.random.default_rng(seed + 2).normal(size=m)
    kept = vector.copy()
    found, size = Inverse.of(band, low_rank, factor)(vector)
    largest = np.abs(np.linalg.solve(full(band), vector)).max()
    assert found == pytest.approx(np.linalg.solve(matrix, vector), abs=1.0e-14 * worst * largest)
    assert size == np.abs(found).max()
    assert np.array_equal(vector, kept)


def test_without_low_rank_it_is_the_band_s_to_the_bit():
    band = random_band(3, 25, 4)
    vector = np.random.default_rng(5).normal(size=25)
    rows = vector[None].copy()
    substitute(factorise(band), rows)
    assert np.array_equal(Inverse.of(band, LowRank.zero(25), 7.0)(vector)[0], rows[0])


def test_iterations_with_the_flow_s_part_of_another_band_converge_on_the_exact_answer():
    band, low_rank = random_band(3, 30, 6), random_low_rank(30, 5, 7)
    other = 1.05 * band
    matrix = full(other) + 2.0 * low_rank.basis @ low_rank.weight @ low_rank.basis.T
    inexact = Inverse.of(band, low_rank, 2.0).about(other)
    right = np.random.default_rng(8).normal(size=30)
    answer, errors = np.zeros(30), []
    for _ in range(12):
        answer = answer + inexact(right - matrix @ answer)[0]
        errors.append(np.abs(answer - np.linalg.solve(matrix, right)).max())
    assert 1.0e-9 < errors[0] / np.abs(answer).max() < 0.1
    assert errors[-1] < 1.0e-13


@pytest.mark.parametrize('place', [0, 12, 24])
def test_a_correction_that_is_not_a_number_shows_in_its_size(place):
    vector = np.ones(25)
    vector[place] = np.nan
    _, size = Inverse.of(random_band(3, 25, 4), random_low_rank(25, 4, 5), 1.0)(vector)
    assert np.isnan(size)

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Krylov spaces of matrices whose eigenvalues and solutions are known."""

import numpy as np
import pytest

from dewing_sim.modes.krylov import arnoldi, gmres


def damped(rng: np.random.Generator, size: int = 60) -> np.ndarray:
    """Return a matrix with a few slow pairs and many fast ones."""
    decay = np.concatenate([[0.99, 0.97, 0.9], np.geomspace(0.5, 1e-6, size // 2 - 3)])
    blocks = np.zeros((size, size))
    for k, (radius, angle) in enumerate(zip(decay, rng.uniform(0.1, 3.0, decay.size))):
        turn = radius * np.array([[np.cos(angle), -np.sin(angle)],
                                  [np.sin(angle), np.cos(angle)]])
        blocks[2 * k:2 * k + 2, 2 * k:2 * k + 2] = turn
    mix = np.eye(size) + 0.3 / np.sqrt(size) * rng.standard_normal((size, size))
    return mix @ blocks @ np.linalg.inv(mix)


def test_the_slow_eigenvalues_are_those_of_the_matrix():
    rng = np.random.default_rng(1)
    matrix = damped(rng)
    ritz = arnoldi(lambda v: matrix @ v, rng.standard_normal(60), 40)
    exact = np.linalg.eigvals(matrix)
    exact = exact[np.argsort(-np.abs(exact))]
    assert np.sort_complex(ritz.values[:6]) == pytest.approx(np.sort_complex(exact[:6]), abs=1e-9)
    assert np.all(ritz.residuals[:6] < 1e-8)
    for k in range(6):
        vector = ritz.vector(k)
        assert np.linalg.norm(matrix @ vector - ritz.values[k] * vector) < 1e-8


def test_the_shares_make_up_the_first_vector():
    rng = np.random.default_rng(2)
    matrix, first = damped(rng), rng.standard_normal(60)
    ritz = arnoldi(lambda v: matrix @ v, first, 30)
    whole = sum(ritz.shares[k] * ritz.vector(k) for k in range(len(ritz.values)))
    assert whole == pytest.approx(first, abs=1e-8)


def test_a_space_that_holds_all_of_it_ends_early():
    matrix = np.diag([0.9, 0.5, 0.1, 0.1, 0.1])
    ritz = arnoldi(lambda v: matrix @ v, np.array([1.0, 1.0, 1.0, 0.0, 0.0]), 5)
    assert ritz.values == pytest.approx([0.9, 0.5, 0.1])
    assert len(ritz.basis) == 3


def test_a_linear_system_is_solved_to_the_tolerance():
    rng = np.random.default_rng(3)
    matrix, right = damped(rng), rng.standard_normal(60)
    found = gmres(lambda v: v - matrix @ v, right, 60, 1e-8)
    assert np.linalg.norm(found - matrix @ found - right) < 2e-8 * np.linalg.norm(right)

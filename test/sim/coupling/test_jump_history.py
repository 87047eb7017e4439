# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The jumps of a coasting wall: what they foretell and how they are kept."""

import numpy as np
import pytest

from dewing_sim.coupling.jump_history import REMEMBERED, extrapolated, remembered

TIMES = -np.arange(3.0)


@pytest.mark.parametrize('known', [1, 2, 3])
def test_a_polynomial_is_foretold_from_as_many_values(known):
    course = np.stack([np.polyval(row, TIMES) for row in np.eye(3)[3 - known:]], axis=1)
    assert extrapolated(course[:known]) == pytest.approx(np.ones(known), abs=1.0e-12)


def test_the_newest_is_kept_without_added_mass_and_the_oldest_forgotten():
    rng = np.random.default_rng(1)
    impedance, (jump, velocity, coasting) = rng.normal(size=(4, 4)), rng.normal(size=(3, 4))
    history, still = np.empty((0, 0)), jump + impedance @ (velocity - coasting)
    for kept in (1, 2, 3):
        before, history = history, remembered(history, jump, velocity, coasting, impedance)
        assert history.shape == (min(kept, REMEMBERED), 4)
        assert history[0] == pytest.approx(still)
        assert history[1:].tolist() == before[:kept - 1].tolist()
    assert remembered(history, jump, velocity, coasting, impedance).shape == history.shape

# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Mean and largest deflection of a line of nodes."""

import numpy as np
import pytest

from dewing_sim.structure.camber import camber, peak

X = np.linspace(0.0, 1.0, 21)**1.1


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_parabola_has_its_mean_and_its_peak_between_nodes(sign):
    mean, largest, place = camber(np.stack((X, sign * 0.4 * X * (1.0 - X)), axis=1))
    assert mean == pytest.approx(sign * 0.4 / 6.0, rel=1.0e-2)
    assert largest == pytest.approx(sign * 0.1, rel=1.0e-12) and place == pytest.approx(0.5)
    assert peak(X, sign * 0.4 * X * (1.0 - X)) == (largest, place)


def test_an_edge_may_be_the_highest_and_no_number_is_found_out():
    assert camber(np.stack((X, X), axis=1))[1:] == (1.0, 1.0)
    assert peak(X, np.zeros_like(X)) == (0.0, 0.0)
    broken = np.stack((X, np.where(X > 0.3, np.nan, X)), axis=1)
    assert np.isnan(camber(broken)).all()

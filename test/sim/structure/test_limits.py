# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Pull-in, snap-through, Gent locking and breakdown, each with its number."""

import numpy as np
import pytest

from dewing_sim.errors import BadInput
from dewing_sim.structure.material import limits
from dewing_sim.structure.material.elastomer import VACUUM_PERMITTIVITY, Elastomer
from dewing_sim.structure.material.gent import Gent

MU, EPS = 2.0e4, 2.7 * VACUUM_PERMITTIVITY
UNIT = np.sqrt(MU / EPS)


def elastomer(jm):
    return Elastomer(Gent(MU, jm), 3.8e8, EPS)


@pytest.mark.parametrize('jm, stretch, field', [
    (1.0e6, 2.0 ** (1.0 / 3.0), 0.68736), (100.0, 1.26380, 0.68936)])
def test_free_equibiaxial_pull_in(jm, stretch, field):
    found = limits.equibiaxial_pull_in(elastomer(jm))
    assert found.stretch == pytest.approx(stretch, abs=1e-5)
    assert found.field / UNIT == pytest.approx(field, abs=1e-5)


def test_the_sheet_snaps_to_the_branch_that_the_gent_limit_bends_up():
    found = limits.equibiaxial_pull_in(elastomer(100.0))
    locked = limits.locking_stretch(elastomer(100.0).law, limits.equibiaxial)
    assert locked == pytest.approx(np.sqrt(103.0 / 2.0), rel=1e-5)
    assert 5.0 < found.snapped_stretch < locked
    assert limits.equibiaxial_field(elastomer(100.0), found.snapped_stretch) == pytest.approx(
        found.field, rel=2e-2)
    between = limits.equibiaxial_field(elastomer(100.0), np.linspace(1.3, 4.0, 20))
    assert between.max() < found.field


def test_the_curve_is_gent_s_closed_form():
    stretch = np.array([1.1, 2.0, 5.0])
    stress = MU * 100.0 * (stretch ** 2 - stretch ** -4) / (
        103.0 - 2.0 * stretch ** 2 - stretch ** -4)
    expected = np.sqrt(stress / EPS) * stretch ** -2
    assert limits.equibiaxial_field(elastomer(100.0), stretch) == pytest.approx(expected)
    assert np.isnan(limits.equibiaxial_field(elastomer(100.0), 0.9))


def test_a_strong_gent_limit_avoids_pull_in_and_a_dead_load_lowers_it():
    with pytest.raises(BadInput, match='no pull-in: .* Gent limit 5'):
        limits.equibiaxial_pull_in(elastomer(5.0))
    loaded = limits.equibiaxial_pull_in(elastomer(100.0), load=0.5 * MU)
    free = limits.equibiaxial_pull_in(elastomer(100.0))
    assert loaded.stretch > free.stretch and loaded.field < free.field


def test_breakdown_is_named_with_its_field():
    assert limits.breakdown_warning(1.99e7, 2.0e7) is None
    assert limits.breakdown_warning(2.34e7, 2.0e7) == (
        'a field of 23.4 MV/m in the membrane; above 20 MV/m the elastomer may break down')

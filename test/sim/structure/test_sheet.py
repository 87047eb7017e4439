# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The thin sheet: closed forms without compression, differences with it, its failures in words."""

import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from dewing_sim.errors import BadInput, Diverged
from dewing_sim.structure.material.elastomer import VACUUM_PERMITTIVITY, Elastomer
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.sheet import Sheet

MU, JM, BULK, EPS = 2.0e4, 100.0, 3.8e8, 2.7 * VACUUM_PERMITTIVITY
H = 5.0e-5
VHB = Elastomer(Gent(MU, JM), BULK, EPS)
NEO_HOOKEAN = Elastomer(Gent(MU, 1.0e9), 1.0e4 * BULK, EPS)
STRETCH = np.array([1.02, 1.1, 1.5, 2.0, 4.0])
ONE_SENTENCE = re.compile(r'[^.]([^.]|\.\d)*[^.]')


def gent_tension(stretch, lateral, v_squared, jm=JM):
    """Return mu Jm / (Jm - I1 + 3) (l^2 - l3^2) h - eps V^2 / h with h = H l3 = H / (l l2)."""
    through = 1.0 / (stretch * lateral)
    first = stretch**2 + lateral**2 + through**2 - 3.0
    elastic = MU * jm / (jm - first) * (stretch**2 - through**2)
    return elastic * H * through - EPS * v_squared / (H * through)


def caught(sheet: Sheet, stretch: list[float], v_squared: float) -> str:
    """Return the message of the failure at these stretches, which must be one sentence."""
    with pytest.raises(Diverged) as failure:
        sheet.respond(stretch, v_squared)
    assert ONE_SENTENCE.fullmatch(str(failure.value))
    return str(failure.value)


@pytest.mark.parametrize('v_squared', [0.0, 1.0e5])
@pytest.mark.parametrize('lateral', [1.0, 1.3])
def test_incompressible_gent_sheet_with_lateral_stretch_and_voltage(lateral, v_squared):
    sheet = Sheet(Elastomer(Gent(MU, JM), 1.0e4 * BULK, EPS), H, lateral)
    response = sheet.respond(STRETCH, v_squared)
    assert response.thickness == pytest.approx(H / (lateral * STRETCH), rel=1.0e-7)
    assert response.tension == pytest.approx(
        gent_tension(STRETCH, lateral, v_squared), rel=1.0e-6, abs=1.0e-6 * MU * H)


@pytest.mark.parametrize('v_squared', [0.0, 1.0e5])
@pytest.mark.parametrize('lateral', [1.0, 1.3])
def test_slopes_of_the_incompressible_neo_hookean_sheet(lateral, v_squared):
    """T = mu H (l / l2 - 1 / (l l2)^3) - eps V^2 l l2 / H."""
    response = Sheet(NEO_HOOKEAN, H, lateral).respond(STRETCH, v_squared)
    assert response.stiffness == pytest.approx(
        MU * H * (1.0 / lateral + 3.0 / (lateral**3 * STRETCH**4))
        - EPS * v_squared * lateral / H, rel=1.0e-6)
    assert response.voltage_slope == pytest.approx(-EPS * STRETCH * lateral / H, rel=1.0e-6)


@settings(max_examples=40, deadline=None)
@given(jm=st.floats(20.0, 200.0), ratio=st.floats(20.0, 1.0e4), lateral=st.floats(0.8, 1.5),
       stretch=st.floats(1.0, 3.0), push=st.floats(0.0, 0.3))
def test_slopes_are_differences_whatever_the_constants(jm, ratio, lateral, stretch, push):
    """``push`` is eps V^2 / (mu H^2); fourth-order differences of step 1e-3."""
    sheet = Sheet(Elastomer(Gent(MU, jm), ratio * MU, EPS), H, lateral)
    unit = MU * H**2 / EPS
    response = sheet.respond([stretch], push * unit)

    def slope(tension):
        ahead, behind, far, back = (tension(k * 1.0e-3) for k in (1, -1, 2, -2))
        return (8.0 * (ahead - behind) - (far - back)) / 12.0e-3

    by_stretch = slope(lambda step: sheet.respond([stretch + step], push * unit).tension[0])
    assert response.stiffness[0] == pytest.approx(by_stretch, rel=1.0e-6, abs=1.0e-6 * MU * H)
    base = push + 2.0e-3            # no V^2 is negative
    by_push = slope(lambda step: sheet.respond([stretch], (base + step) * unit).tension[0])
    found = sheet.respond([stretch], base * unit).voltage_slope[0]
    assert found * unit == pytest.approx(by_push, rel=1.0e-6, abs=1.0e-6 * MU * H)


@settings(max_examples=40, deadline=None)
@given(ratio=st.floats(20.0, 1.0e4), lateral=st.floats(0.8, 1.5), stretch=st.floats(1.0, 3.0),
       push=st.floats(0.0, 0.3))
def test_tension_does_the_work_that_the_energies_store(ratio, lateral, stretch, push):
    """At constant voltage T l2 = H d(elastic - electric) / dl, per unstretched area."""
    sheet = Sheet(Elastomer(Gent(MU, JM), ratio * MU, EPS), H, lateral)
    v_squared, step = push * MU * H**2 / EPS, 1.0e-3

    def potential(k):
        elastic, electric = sheet.energies([stretch + k * step], v_squared)
        return H * (elastic[0] - electric[0])

    work = (8.0 * (potential(1) - potential(-1)) - (potential(2) - potential(-2))) / (12.0 * step)
    tension = sheet.respond([stretch], v_squared).tension[0]
    assert tension * lateral == pytest.approx(work, rel=1.0e-7, abs=1.0e-7 * MU * H)


@pytest.mark.parametrize('stretch, tension, tangent, thickness, volts', [
    (1.5, 1.2121, 2.450, 33.33e-6, 1300.0), (1.1, 0.3488, 3.358, 45.45e-6, 814.0)])
def test_printed_tension_tangent_thickness_and_loss_of_tension(
        stretch, tension, tangent, thickness, volts):
    sheet = Sheet(VHB, H)
    response = sheet.respond([stretch], 0.0)
    assert response.tension[0] == pytest.approx(tension, abs=5e-5)
    assert response.stiffness[0] * stretch == pytest.approx(tangent, abs=6e-4)
    assert response.thickness[0] == pytest.approx(thickness, rel=2e-4)
    assert np.sqrt(sheet.loss_of_tension_v_squared(stretch)) == pytest.approx(volts, abs=0.5)


def test_tension_at_a_thousand_volts():
    assert Sheet(VHB, H).respond([1.5], 1.0e6).tension[0] == pytest.approx(0.4949, abs=5e-5)


def test_tension_falls_by_permittivity_over_thickness():
    response = Sheet(VHB, H).respond([1.5], 4.0e5)
    assert response.voltage_slope == pytest.approx(-EPS / response.thickness, rel=1e-3)


@pytest.mark.parametrize('stretch', [1.1, 1.5, 3.0])
def test_loss_of_tension_of_clamped_neo_hookean_sheet(stretch):
    sheet = Sheet(NEO_HOOKEAN, H)
    limit = sheet.loss_of_tension_v_squared(stretch)
    assert EPS * limit / H ** 2 / MU == pytest.approx(1.0 - stretch ** -4, rel=1e-6)
    assert abs(sheet.respond([stretch], limit).tension[0]) < 1e-9 * MU * H


@settings(max_examples=40, deadline=None)
@given(jm=st.floats(20.0, 200.0), ratio=st.floats(50.0, 1.0e4), lateral=st.floats(0.9, 1.5),
       stretch=st.floats(1.1, 3.0))
def test_tension_changes_sign_at_its_loss(jm, ratio, lateral, stretch):
    sheet = Sheet(Elastomer(Gent(MU, jm), ratio * MU, EPS), H, lateral)
    limit = sheet.loss_of_tension_v_squared(stretch)
    below, at, above = (sheet.respond([stretch], share * limit).tension[0]
                        for share in (0.99, 1.0, 1.01))
    assert below > 0.0 > above
    assert abs(at) < 1.0e-9 * MU * H


@settings(max_examples=60, deadline=None)
@given(jm=st.floats(5.0, 100.0), ratio=st.floats(3.0, 1.0e4), lateral=st.floats(0.9, 1.5),
       share=st.floats(0.1, 0.999))
def test_loss_of_tension_up_to_locking_and_pull_in(jm, ratio, lateral, share):
    """A sheet that is taut loses its tension at a positive V^2, or never: never at zero."""
    sheet = Sheet(Elastomer(Gent(MU, jm), ratio * MU, EPS), H, lateral)
    stretch = 1.0 + share * (np.sqrt(jm + 3.0) - 1.0)
    try:
        whole = sheet.respond([stretch], 0.0).tension[0]
    except Diverged:
        assume(False)
    assume(whole > 0.0)
    try:
        limit = sheet.loss_of_tension_v_squared(stretch)
    except Diverged as error:
        assert 'no voltage takes the tension' in str(error)
        limit = (float(re.search('falls up to (.*?) V', str(error))[1]))**2
        assert all(tension_or_none(sheet, stretch, part * limit) > 0.0
                   for part in np.linspace(0.0, 0.999, 12))
        beyond = tension_or_none(sheet, stretch, 1.02 * limit)
        at = tension_or_none(sheet, stretch, 0.9999 * limit)
        assert beyond is None or beyond > at > 0.0
        return
    assert abs(sheet.respond([stretch], limit).tension[0]) < 1.0e-9 * whole
    assert all(sheet.respond([stretch], part * limit).tension[0] > 0.0
               for part in np.linspace(0.0, 0.999, 12))


def tension_or_none(sheet, stretch, v_squared):
    try:
        return sheet.respond([stretch], v_squared).tension[0]
    except Diverged:
        return None


def test_tension_next_to_locking_is_never_lost():
    """It was said to be lost at 0 V: Newton from 0 V passed the least tension, of 182 N/m."""
    sheet = Sheet(Elastomer(Gent(MU, 55.0), BULK, EPS), H)
    assert sheet.loss_of_tension_v_squared(7.4) > 5.0e7
    with pytest.raises(Diverged, match='no voltage takes the tension at stretch 7.5'):
        sheet.loss_of_tension_v_squared(7.5)


def test_unstretched_sheet_has_no_tension_to_lose():
    assert Sheet(VHB, H).loss_of_tension_v_squared(1.0) == 0.0
    assert Sheet(VHB, H).loss_of_tension_v_squared(0.9) == 0.0


@pytest.mark.parametrize('bulk', [1.0e5, BULK])
@pytest.mark.parametrize('v_squared', [0.0, 2.0e5])
def test_sheet_slopes_are_consistent(bulk, v_squared):
    sheet = Sheet(Elastomer(Gent(MU, JM), bulk, EPS), H, 1.2)
    stretch = np.array([1.02, 1.4, 2.5, 5.0])
    step = 1.0e-5
    response = sheet.respond(stretch, v_squared)
    slope = (sheet.respond(stretch + step, v_squared).tension
             - sheet.respond(stretch - step, v_squared).tension) / (2.0 * step)
    assert response.stiffness == pytest.approx(slope, rel=1e-7)
    slope = (sheet.respond(stretch, v_squared + 1e3).tension - response.tension) / 1e3
    assert response.voltage_slope == pytest.approx(slope, rel=1e-2 if bulk < BULK else 1e-5)


def test_response_does_not_depend_on_the_neighbours():
    sheet = Sheet(Elastomer(Gent(MU, JM), 1.0e5, EPS), H)
    together = sheet.respond([1.1, 4.0, 1.3], 1.0e5)
    alone = [sheet.respond([stretch], 1.0e5).tension[0] for stretch in (1.1, 4.0, 1.3)]
    assert together.tension == pytest.approx(alone, rel=1e-11)


def test_gent_locking_is_named():
    assert caught(Sheet(VHB, H), [1.5, 10.2], 1.0e4) == (
        'element 1 at stretch 10.2 and 100 V: I1bar - 3 reaches the Gent limit 100; '
        'reduce the load, the prestretch or the time step')


def test_thickness_pull_in_is_named():
    assert caught(Sheet(Elastomer(Gent(1.0e3, JM), 1.0e3, EPS), H), [1.5], 1.0e8) == (
        'element 0 at stretch 1.5 and 10000 V: no thickness balances the Maxwell stress; '
        'reduce the voltage')


def test_non_finite_stretch_is_named():
    assert caught(Sheet(VHB, H), [1.5, 1.5, np.nan], 0.0) == (
        'element 2 at stretch nan and 0 V: the deformation is not finite; '
        'reduce the time step or the load')


@pytest.mark.parametrize('v_squared', [-1.0, np.nan, np.inf])
def test_impossible_voltage_is_bad_input(v_squared):
    with pytest.raises(BadInput, match='v_squared = .* out of range'):
        Sheet(VHB, H).respond([1.5], v_squared)

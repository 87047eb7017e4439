# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Closed forms of the dielectric elastomer in full; its derivatives by complex steps."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from dewing_sim.structure.material.elastomer import (
    VACUUM_PERMITTIVITY,
    Elastomer,
    diagonal,
)
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.sheet import Sheet, kirchhoff

MU, JM, BULK, EPS = 2.0e4, 100.0, 3.8e8, 2.7 * VACUUM_PERMITTIVITY
H = 5.0e-5
VHB = Elastomer(Gent(MU, JM), BULK, EPS)
STIFF_IN_VOLUME = Elastomer(Gent(MU, JM), 1.0e4 * BULK, EPS)
NEO_HOOKEAN = Elastomer(Gent(MU, 1.0e9), 1.0e4 * BULK, EPS)


def gent_plane_strain(stretch):
    """Return the incompressible Cauchy stress mu Jm (l^2 - l^-2) / (Jm - l^2 - l^-2 + 2)."""
    square = stretch ** 2
    return MU * JM * (square - 1.0 / square) / (JM - square - 1.0 / square + 2.0)


def principal_stress(elastomer, stretches, field=0.0):
    """Return the principal Cauchy stresses with the nominal field along the third axis."""
    stress = elastomer.cauchy_stress(diagonal(stretches), (0.0, 0.0, field))
    assert np.abs(stress - np.diag(np.diag(stress))).max() == 0.0
    return np.diag(stress)


def stresses(sheet, stretch, v_squared=0.0):
    """Return the principal Cauchy stresses of a sheet, and its volume ratio."""
    h = sheet.respond([stretch], v_squared).thickness[0]
    stretches = (stretch, sheet.lateral_stretch, h / sheet.initial_thickness)
    field = np.sqrt(v_squared) / sheet.initial_thickness
    return principal_stress(sheet.elastomer, stretches, field), np.prod(stretches)


@pytest.mark.parametrize('stretch', [1.05, 1.1, 1.5, 2.0, 4.0])
def test_gent_plane_strain_in_the_incompressible_limit(stretch):
    response = Sheet(STIFF_IN_VOLUME, H).respond([stretch], 0.0)
    expected = gent_plane_strain(stretch)
    assert response.tension[0] / response.thickness[0] == pytest.approx(expected, rel=1e-7)
    assert response.thickness[0] == pytest.approx(H / stretch, rel=1e-7)


def test_printed_stresses_at_the_prestretch_of_the_paper():
    assert gent_plane_strain(1.5) == pytest.approx(36363.64, abs=0.005)
    gent, _ = stresses(Sheet(STIFF_IN_VOLUME, H), 1.5)
    neo_hookean, _ = stresses(Sheet(NEO_HOOKEAN, H), 1.5)
    assert gent[:2] == pytest.approx([36363.64, 11188.81], abs=0.01)
    assert neo_hookean[0] == pytest.approx(36111.11, abs=0.01)


def test_finite_bulk_modulus_swells_the_sheet_by_the_lateral_pressure():
    stress, volume = stresses(Sheet(VHB, H), 1.5)
    assert volume - 1.0 == pytest.approx(2.09e-5, abs=0.005e-5)
    assert volume - 1.0 == pytest.approx(stress.sum() / 3.0 / (2.0 * BULK), rel=1e-4)
    assert stress[0] == pytest.approx(36363.64, rel=6e-5)


@pytest.mark.parametrize('v_squared', [0.0, 1.0e6])
@pytest.mark.parametrize('bulk', [1.0e5, BULK])
def test_faces_are_free_of_traction(bulk, v_squared):
    stress, _ = stresses(Sheet(Elastomer(Gent(MU, JM), bulk, EPS), H, 1.2), 1.5, v_squared)
    assert abs(stress[2]) < 1e-9 * bulk * 1e-1


def test_maxwell_stress_acts_as_twice_its_half_in_plane():
    passive, _ = stresses(Sheet(STIFF_IN_VOLUME, H), 1.5)
    active, _ = stresses(Sheet(STIFF_IN_VOLUME, H), 1.5, 1.0e6)
    assert passive[0] - active[0] == pytest.approx(21515.7, abs=0.1)
    elastic = principal_stress(VHB, (1.5, 1.0, 1 / 1.5))
    electric = principal_stress(VHB, (1.5, 1.0, 1 / 1.5), 1.0e3 / H) - elastic
    assert electric == pytest.approx(0.5 * 21515.7 * np.array([-1.0, -1.0, 1.0]), rel=1e-5)


@pytest.mark.parametrize('elastomer, stretch, field', [
    (NEO_HOOKEAN, 2.0 ** (1.0 / 3.0), 0.68736), (STIFF_IN_VOLUME, 1.26380, 0.68936)])
def test_free_equibiaxial_pull_in(elastomer, stretch, field):
    def nominal_field(l1):
        stress = principal_stress(elastomer, (l1, l1, l1 ** -2))
        return np.sqrt((stress[0] - stress[2]) / MU) * l1 ** -2
    peak = minimize_scalar(lambda l1: -nominal_field(l1), bounds=(1.01, 2.0), method='bounded',
                           options={'xatol': 1e-10})
    assert peak.x == pytest.approx(stretch, abs=1e-5)
    assert -peak.fun == pytest.approx(field, abs=1e-5)


SOFT = Elastomer(Gent(MU, 30.0), 1.0e6, EPS)
FIELDS = np.array([[1.0e8, -5.0e7, 1.5e8], [0.0, 0.0, 1.7e8], [0.0, 0.0, 0.0]])
GRADIENTS = np.eye(3) + np.random.default_rng(4).uniform(-0.25, 0.25, (3, 3, 3))


def by_complex_step(function, row, column):
    """Return d function / d F_row,column at GRADIENTS, vectorised over the points."""
    perturbed = GRADIENTS.astype(complex)
    perturbed[:, row, column] += 1.0e-30j
    return function(perturbed, FIELDS).imag / 1.0e-30


@pytest.mark.parametrize('row', range(3))
@pytest.mark.parametrize('column', range(3))
def test_stress_and_tangent_are_derivatives_of_the_energy(row, column):
    stress = SOFT.first_piola(GRADIENTS, FIELDS)
    tangent = SOFT.tangent(GRADIENTS, FIELDS)
    expected = by_complex_step(SOFT.energy, row, column)
    assert stress[:, row, column] == pytest.approx(expected, abs=1e-13 * np.abs(stress).max())
    expected = by_complex_step(SOFT.first_piola, row, column)
    assert np.abs(tangent[..., row, column] - expected).max() < 1e-13 * np.abs(tangent).max()


def test_points_are_vectorised():
    stress, tangent = SOFT.first_piola(GRADIENTS, FIELDS), SOFT.tangent(GRADIENTS, FIELDS)
    for k, (gradient, field) in enumerate(zip(GRADIENTS, FIELDS)):
        assert SOFT.first_piola(gradient, field) == pytest.approx(stress[k], rel=1e-13)
        assert SOFT.tangent(gradient, field) == pytest.approx(tangent[k], rel=1e-12)


def test_maxwell_stress_of_an_oblique_field_is_the_paper_s():
    passive = SOFT.cauchy_stress(GRADIENTS)
    electric = SOFT.cauchy_stress(GRADIENTS, FIELDS) - passive
    field = np.einsum('kji,kj->ki', np.linalg.inv(GRADIENTS), FIELDS)
    square = np.einsum('ki,ki->k', field, field)[:, None, None]
    dyad = field[:, :, None] * field[:, None, :]
    assert electric == pytest.approx(EPS * (dyad - 0.5 * square * np.eye(3)), abs=1e-6)


def test_stresses_are_objective_and_symmetric():
    angles = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn = angles * np.linalg.det(angles)
    stress = SOFT.cauchy_stress(GRADIENTS, FIELDS)
    assert stress == pytest.approx(np.swapaxes(stress, 1, 2), rel=1e-10)
    turned = SOFT.cauchy_stress(turn @ GRADIENTS, FIELDS)
    assert turned == pytest.approx(turn @ stress @ turn.T, rel=1e-9)


@pytest.mark.parametrize('stretches', [(1.5, 1.0, 0.66), (1.1, 1.3, 0.8), (0.7, 1.0, 1.5)])
def test_the_sheet_s_principal_stresses_and_moduli_are_those_of_the_tensors(stretches):
    field = 1.7e5
    l1, _, l3 = stretches
    t1, t3, c11, c13, c33, _ = kirchhoff(*stretches, field ** 2, SOFT.constants)
    tau = np.diag(SOFT.kirchhoff_stress(diagonal(stretches), (0.0, 0.0, field)))
    assert (t1, t3) == pytest.approx(tuple(tau[[0, 2]]), rel=1e-12)
    full = SOFT.tangent(diagonal(stretches), (0.0, 0.0, field))
    expected = (l1 * full[0, 0, 0, 0] * l1 + t1, l1 * full[0, 0, 2, 2] * l3,
                l3 * full[2, 2, 2, 2] * l3 + t3)
    assert (c11, c13, c33) == pytest.approx(expected, rel=1e-11)

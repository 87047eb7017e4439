# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Laws of elasticity against closed forms, against each other, and on both elements."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged
from dewing_sim.structure import elements
from dewing_sim.structure.dynamics.band import full
from dewing_sim.structure.dynamics.energy_balance import Balance, balance
from dewing_sim.structure.dynamics.generalised_alpha import Scheme, Swing
from dewing_sim.structure.material import limits, powers
from dewing_sim.structure.material.elastomer import (
    VACUUM_PERMITTIVITY,
    Elastomer,
    diagonal,
)
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.material.law import energy, slopes
from dewing_sim.structure.material.mooney_rivlin import MooneyRivlin
from dewing_sim.structure.material.ogden import Ogden
from dewing_sim.structure.material.registry import LAWS as LAWS_BY_WORD
from dewing_sim.structure.sheet import Sheet

EPS, H = 2.7 * VACUUM_PERMITTIVITY, 5.0e-5
# Treloar's rubber (Ogden 1972), 6.3, 0.012, -0.1 kg/cm^2; Mooney-Rivlin of a like modulus.
OGDEN = Ogden(6.2e5, 1.3, 1.2e3, 5.0, -1.0e4, -2.0)
MOONEY = MooneyRivlin(1.7e5, 3.0e4)
GENT = Gent(4.0e5, 60.0)
LAWS = {'ogden': OGDEN, 'mooney_rivlin': MOONEY, 'gent': GENT}
NEO_HOOKE = Gent(2.0e4, 1.0e9)
OF_NEO_HOOKE = {'ogden': Ogden(2.0e4, 2.0, 0.0, 2.0, 0.0, 2.0),
                'two terms': Ogden(1.5e4, 2.0, 0.0, 2.0, 0.5e4, 2.0),
                'mooney_rivlin': MooneyRivlin(1.0e4, 0.0)}

each_law = pytest.mark.parametrize('law', LAWS.values(), ids=LAWS)


def difference(law, l1, l3):
    """Return sigma_1 - sigma_3 of incompressible stretches from the textbooks' formulas."""
    if isinstance(law, Ogden):
        return sum(mu * (l1 ** alpha - l3 ** alpha) for mu, alpha in (
            (law.mu_1, law.alpha_1), (law.mu_2, law.alpha_2), (law.mu_3, law.alpha_3)))
    square = l1 ** 2 - l3 ** 2
    if isinstance(law, MooneyRivlin):
        return 2.0 * law.c10 * square - 2.0 * law.c01 * (l1 ** -2 - l3 ** -2)
    l2 = 1.0 / (l1 * l3)
    room = law.gent_limit - (l1 ** 2 + l2 ** 2 + l3 ** 2 - 3.0)
    return law.shear_modulus * law.gent_limit * square / room


def principal(elastomer, stretches):
    return np.diag(elastomer.cauchy_stress(diagonal(stretches)))


# Closed forms.

@each_law
@pytest.mark.parametrize('stretch', [0.7, 1.0 + 1e-9, 1.2, 2.0, 4.0])
def test_uniaxial_planar_and_equibiaxial_stresses(law, stretch):
    elastomer = Elastomer(law, 1.0e9, EPS)
    for stretches in ((stretch, stretch ** -0.5, stretch ** -0.5),
                      (stretch, 1.0, 1.0 / stretch), (stretch, stretch, stretch ** -2)):
        stress = principal(elastomer, stretches)
        for a, b in ((0, 1), (1, 2), (0, 2)):
            assert stress[a] - stress[b] == pytest.approx(
                difference(law, stretches[a], stretches[b]), rel=1e-10, abs=1e-5)


@each_law
@pytest.mark.parametrize('lateral', [1.0, 1.3, 2.0])
def test_tension_of_the_membrane_in_the_incompressible_limit(law, lateral):
    sheet = Sheet(Elastomer(law, 1.0e12, EPS), H, lateral)
    stretch = np.array([1.1, 1.3, 2.0, 3.0])
    response = sheet.respond(stretch, 0.0)
    l3 = 1.0 / (stretch * lateral)
    assert response.thickness == pytest.approx(H * l3, rel=1e-5)
    expected = [difference(law, a, b) for a, b in zip(stretch, l3)]
    assert response.tension / response.thickness == pytest.approx(expected, rel=1e-5)
    active = sheet.respond(stretch, 1.0e6)
    assert active.tension == pytest.approx(
        response.tension - EPS * 1.0e6 / response.thickness, rel=1e-4)


@each_law
@pytest.mark.parametrize('lateral', [1.0, 1.3])
def test_tension_of_solid_elements_is_the_membrane_s(law, lateral):
    sheet = Sheet(Elastomer(law, 1.0e9, EPS), H, lateral)
    solid = elements.Solid.uniform(sheet, 1.5, 960.0, 0.002, 6, 'middle')
    for v_squared in (0.0, 1.0e6):
        thin = sheet.respond([1.5], v_squared)
        height = float(thin.thickness[0] / sheet.respond([1.5], 0.0).thickness[0])
        thick = solid.respond(solid.rest_position * [1.0, height], v_squared)
        assert thick.tension == pytest.approx(np.full(6, thin.tension[0]), rel=1e-6)


@each_law
def test_the_initial_shear_modulus_is_that_of_a_small_shear(law):
    shear = np.eye(3)
    shear[0, 1] = 1.0e-6
    stress = Elastomer(law, 1.0e9, EPS).cauchy_stress(shear)
    assert stress[0, 1] == pytest.approx(law.initial_shear_modulus * 1.0e-6, rel=1e-6)


def test_initial_shear_moduli_in_closed_form():
    assert OGDEN.initial_shear_modulus == pytest.approx(
        0.5 * (6.2e5 * 1.3 + 1.2e3 * 5.0 + 1.0e4 * 2.0))
    assert MOONEY.initial_shear_modulus == pytest.approx(2.0 * (1.7e5 + 3.0e4))
    assert GENT.initial_shear_modulus == pytest.approx(4.0e5)


@pytest.mark.parametrize('law', OF_NEO_HOOKE.values(), ids=OF_NEO_HOOKE)
def test_special_cases_are_neo_hooke_as_gent_without_limit(law):
    gradients = np.eye(3) + np.random.default_rng(4).uniform(-0.25, 0.25, (5, 3, 3))
    fields = np.random.default_rng(5).uniform(-1.0e8, 1.0e8, (5, 3))
    found, expected = (Elastomer(each, 1.0e6, EPS) for each in (law, NEO_HOOKE))
    # The logarithm of a Gent energy without limit loses nine digits.
    assert found.energy(gradients, fields) == pytest.approx(
        expected.energy(gradients, fields), rel=1e-5)
    for name in ('first_piola', 'tangent'):
        value = getattr(expected, name)(gradients, fields)
        assert getattr(found, name)(gradients, fields) == pytest.approx(
            value, abs=1e-8 * np.abs(value).max())
    thin, thick = (Sheet(each, H, 1.2).respond([1.1, 2.0], 1.0e5) for each in (found, expected))
    for a, b in zip(thin, thick):
        assert a == pytest.approx(b, rel=1e-7)


def test_mooney_rivlin_is_ogden_with_the_exponents_two_and_minus_two():
    ogden = Ogden(2.0 * MOONEY.c10, 2.0, -2.0 * MOONEY.c01, -2.0, 0.0, 2.0)
    gradients = np.eye(3) + np.random.default_rng(4).uniform(-0.25, 0.25, (5, 3, 3))
    found, expected = (Elastomer(each, 1.0e6, EPS) for each in (ogden, MOONEY))
    assert found.energy(gradients) == pytest.approx(expected.energy(gradients), rel=1e-10)
    for name in ('first_piola', 'tangent'):
        value = getattr(expected, name)(gradients)
        assert getattr(found, name)(gradients) == pytest.approx(
            value, abs=1e-11 * np.abs(value).max())


# Derivatives, also where stretches are equal.

@each_law
@pytest.mark.parametrize('stretches', [
    (1.5, 1.2, 0.6), (1.3, 1.1, 1.3), (1.3, 0.8, 1.3 + 1e-9), (1.0, 1.0, 1.0),
    (1.3, 1.3, 1.3), (1.3, 1.0, 1.3 + 1e-4), (1.5, 1.0, 1.1)])
def test_slopes_are_derivatives_of_the_energy(law, stretches):
    l1, l2, l3 = stretches
    k = law.constants(0.0, 0.0)
    i1, j = l1 ** 2 + l2 ** 2 + l3 ** 2, l1 * l2 * l3
    found, scale = slopes(i1, j, l2, k), law.initial_shear_modulus
    step = 1.0e-4       # of fourth-order differences; I1 below its least value is continued

    def by_i1(function):
        values = [function(i1 + n * step, j) for n in (-2, -1, 1, 2)]
        return (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * step)

    def by_j(function):
        values = [function(i1, j + n * step) for n in (-2, -1, 1, 2)]
        return (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * step)
    expected = (2.0 * by_i1(lambda a, b: energy(a, b, l2, k)),
                by_j(lambda a, b: energy(a, b, l2, k)),
                2.0 * by_i1(lambda a, b: slopes(a, b, l2, k).f),
                by_j(lambda a, b: slopes(a, b, l2, k).f),
                by_j(lambda a, b: slopes(a, b, l2, k).c))
    assert tuple(found) == pytest.approx(expected, rel=1e-7, abs=1e-7 * scale)


@pytest.mark.parametrize('nu', [-1.0, 0.5, 0.65, 1.0, 2.5, 12.5, 25.0])
def test_chebyshev_s_function_of_real_order_has_no_seam(nu):
    for u in (1.0, 1.0 + 1e-12, 1.05, 1.0 + powers.SERIES, 1.0 + powers.SERIES + 1e-9, 3.0):
        value, first, second = powers.chebyshev(nu, u)
        y = np.arccosh(u)
        assert value == pytest.approx(np.cosh(nu * y), rel=1e-12)
        assert first == pytest.approx(
            nu * np.sinh(nu * y) / np.sinh(y) if u > 1.0 else nu ** 2, rel=1e-5)
        residual = (1.0 - u * u) * second - u * first + nu * nu * value
        assert abs(residual) < 1e-12 * max(1.0, abs(nu * nu * value))
    ahead, behind = (powers.chebyshev(nu, 1.0 + powers.SERIES + side) for side in (1e-13, -1e-13))
    assert ahead == pytest.approx(behind, rel=1e-9, abs=1e-12)
    assert powers.chebyshev(nu, 1.0)[2] == pytest.approx(nu ** 2 * (nu ** 2 - 1.0) / 3.0)


GRADIENTS = np.concatenate([
    np.eye(3) + np.random.default_rng(4).uniform(-0.25, 0.25, (3, 3, 3)),
    diagonal([[1.0, 1.0, 1.0], [1.4, 1.4, 0.5], [1.2, 1.2, 1.2]])])
FIELDS = np.array([[1.0e7, -5.0e7, 1.5e8]])


@each_law
def test_full_stress_and_tangent_are_derivatives_also_at_equal_stretches(law):
    elastomer, step = Elastomer(law, 1.0e6, EPS), 1.0e-5
    stress = elastomer.first_piola(GRADIENTS, FIELDS)
    tangent = elastomer.tangent(GRADIENTS, FIELDS)
    for row in range(3):
        for column in range(3):
            moved = np.zeros((3, 3))
            moved[row, column] = step
            slope, bend = ((function(GRADIENTS + moved, FIELDS)
                            - function(GRADIENTS - moved, FIELDS)) / (2.0 * step)
                           for function in (elastomer.energy, elastomer.first_piola))
            assert stress[:, row, column] == pytest.approx(
                slope, abs=1e-7 * np.abs(stress).max() + 1e-3)
            assert np.abs(tangent[..., row, column] - bend).max() < 1e-7 * np.abs(tangent).max()


@each_law
def test_stresses_are_objective_isotropic_and_symmetric(law):
    elastomer = Elastomer(law, 1.0e6, EPS)
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn = turn * np.linalg.det(turn)
    stress = elastomer.cauchy_stress(GRADIENTS)
    assert stress == pytest.approx(np.swapaxes(stress, 1, 2), abs=1e-9 * np.abs(stress).max())
    for turned, expected in ((turn @ GRADIENTS, turn @ stress @ turn.T),
                             (GRADIENTS @ turn, stress)):
        assert elastomer.cauchy_stress(turned) == pytest.approx(
            expected, abs=1e-9 * np.abs(stress).max())


def bent(solid, size=0.08):
    """Return a bent and irregular position."""
    height = solid.sheet.initial_thickness
    position = solid.rest_position.copy()
    position[:, 1] += 0.1 * solid.chord * np.sin(np.pi * position[:, 0] / solid.chord)
    return position + height * np.random.default_rng(3).uniform(-size, size, position.shape)


@each_law
def test_force_and_tangent_of_solid_elements_are_derivatives(law):
    sheet = Sheet(Elastomer(law, 1.0e7, EPS), H, 1.2)
    solid = elements.Solid.uniform(sheet, 1.3, 960.0, 0.002, 6, 'middle')
    position, free = bent(solid), solid.free
    force, tangent = (np.empty((free.size,)), np.empty((free.size, free.size)))
    for column, i in enumerate(free):
        ahead, behind = position.copy(), position.copy()
        ahead.reshape(-1)[i] += 1.0e-9
        behind.reshape(-1)[i] -= 1.0e-9
        energies = [np.subtract(*solid.energies(p, 2.0e5)) for p in (ahead, behind)]
        forces = [solid.internal_force(p, 2.0e5).ravel()[free] for p in (ahead, behind)]
        force[column] = (energies[0] - energies[1]) / 2.0e-9
        tangent[:, column] = (forces[0] - forces[1]) / 2.0e-9
    computed = solid.internal_force(position, 2.0e5).ravel()[free]
    assert force == pytest.approx(computed, abs=1e-5 * np.abs(computed).max())
    assert full(solid.tangent(position, 2.0e5)) == pytest.approx(
        tangent, abs=1e-6 * np.abs(tangent).max())


@each_law
def test_a_rigid_motion_only_turns_the_forces_of_solid_elements(law):
    solid = elements.Solid.uniform(Sheet(Elastomer(law, 1.0e9, EPS), H), 1.3, 960.0, 0.002, 6,
                                   'middle')
    solid, position = replace(solid, support='lower'), bent(solid, 0.01)
    turn = np.array([[np.cos(2.0), -np.sin(2.0)], [np.sin(2.0), np.cos(2.0)]])
    force = solid.internal_force(position, 2.0e5)
    moved = solid.internal_force(position @ turn.T + [0.3, -0.1], 2.0e5)
    assert moved == pytest.approx(force @ turn.T, abs=1e-8 * np.abs(force).max())


@each_law
def test_slopes_of_the_sheet_are_consistent(law):
    sheet, step = Sheet(Elastomer(law, 1.0e6, EPS), H, 1.2), 1.0e-5
    stretch = np.array([1.02, 1.2, 1.4, 2.5])
    response = sheet.respond(stretch, 2.0e5)
    tensions = [sheet.respond(stretch + n * step, 2.0e5).tension for n in (1, -1)]
    assert response.stiffness == pytest.approx((tensions[0] - tensions[1]) / (2.0 * step),
                                               rel=1e-6)


# Structures.

def section(word, law, **changes):
    section = parameters.replace(parameters.load('soft').membrane, {
        'law': word, 'elements': 32, **changes})
    if word == 'gent':
        own = {'shear_modulus': law.shear_modulus, 'gent_limit': law.gent_limit}
        return parameters.replace(section, own)
    return parameters.replace(section, {'constants': vars(law)})


@pytest.mark.parametrize('word', LAWS)
def test_both_elements_camber_alike_as_an_arc(word):
    pressure, volts = 500.0, 700.0
    thin = elements.make(section(word, LAWS[word]))
    thick = elements.make(section(word, LAWS[word], element='solid', support='middle'))
    line = thin.equilibrium(pressure, volts ** 2)
    # Without gravity a membrane under pressure is an arc: T = p R.
    tension, height = thin.tension(line, volts ** 2), line[:, 1].max()
    assert np.ptp(tension) < 1e-3 * tension.mean()
    radius = (0.25 * thin.chord ** 2 + height ** 2) / (2.0 * height)
    assert tension.mean() == pytest.approx(pressure * radius, rel=2e-3)
    other = thick.surface(thick.equilibrium(pressure, volts ** 2))[:, 1].max()
    assert other == pytest.approx(height, rel=2e-3) and height > 0.03 * thin.chord


@pytest.mark.parametrize('word', LAWS)
@pytest.mark.parametrize('element', ['membrane', 'solid'])
def test_the_energy_of_a_moving_structure_adds_up(word, element):
    structure = elements.make(section(word, LAWS[word], element=element, support='middle',
                                      elements=16))
    scheme, load = Scheme(1.0, 2.0e-5), np.zeros_like(structure.rest_position)
    state = Swing.of(structure, structure.rest_position, load, 0.0, load)
    total, before = Balance(), 0.0
    for step in range(10):
        v_squared = 4.0e5 * (step % 3)

        def press(position):
            return structure.pressure_force(position, 40.0)
        after = scheme.advance(structure, state, v_squared, press)
        internal, force = (scheme.mean_force(*pair) for pair in (
            (structure.internal_force(state.position, v_squared),
             structure.internal_force(after.position, v_squared)), (state.load, after.load)))
        total = total.plus(balance(structure, state, after, before, v_squared,
                                   scheme.mean_acceleration(state, after), internal, force))
        state, before = after, v_squared
    assert total.error < 1e-9
    assert abs(total.dissipation) < 1e-3 * abs(total.kinetic)


@each_law
def test_a_free_sheet_pulls_in_where_the_closed_form_says(law):
    found = limits.equibiaxial_pull_in(Elastomer(law, 1.0e12, EPS))

    def square(stretch):
        return difference(law, stretch, stretch ** -2) * stretch ** -4 / EPS
    stretch = np.linspace(1.0, 2.0, 200001)
    curve = square(stretch)
    peak = int(np.flatnonzero(np.diff(curve) < 0.0)[0])
    assert found.stretch == pytest.approx(stretch[peak], abs=2e-5)
    assert found.field == pytest.approx(np.sqrt(curve[peak]), rel=1e-6)


def test_a_law_without_lock_up_may_have_no_pull_in():
    stiff = Ogden(1.0e4, 9.0, 0.0, 2.0, 0.0, 2.0)
    with pytest.raises(BadInput, match='no pull-in: the voltage rises up to stretch 8'):
        limits.equibiaxial_pull_in(Elastomer(stiff, 3.8e8, EPS))
    assert limits.locking_stretch(stiff, limits.equibiaxial) == np.inf


@pytest.mark.parametrize('word', LAWS)
@pytest.mark.parametrize('element', ['membrane', 'solid'])
def test_viscous_branches_see_the_deviatoric_stress(word, element):
    law, l1 = LAWS[word], 1.3
    structure = elements.make(section(word, law, element=element, support='middle',
                                      prestretch=l1, bulk_modulus=1.0e11))
    found = structure.deviatoric_stress(structure.rest_position, 0.0)[:2].T
    l3 = 1.0 / l1
    mean = (difference(law, l1, 1.0) + difference(law, l3, 1.0)) / 3.0
    expected = [(difference(law, stretch, 1.0) - mean) / stretch ** 2 for stretch in (l1, l3)]
    assert found == pytest.approx(np.tile(expected, (len(found), 1)), rel=1e-4)


# Refusals.

@pytest.mark.parametrize('make, sentence', [
    (lambda: MooneyRivlin(1.0e4, -2.0e4), 'MooneyRivlin .* an initial shear modulus of -20000 Pa'),
    (lambda: Ogden(-1.0e4, 2.0, 0.0, 2.0, 0.0, 2.0), 'Ogden make .* of -10000 Pa; .* more than'),
    (lambda: Ogden(1.0e4, 2.0, 1.0e3, 0.0, 0.0, 2.0), 'alpha_2 = 0 of Ogden is out of range')])
def test_unstable_constants_are_refused_in_one_sentence(make, sentence):
    with pytest.raises(BadInput, match=sentence) as caught:
        make()
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize('changes, sentence', [
    ({'law': 'ogden'}, '^membrane.constants.mu_1 is missing: mu_1 .Pa., from '),
    ({'law': 'ogden', 'constants': {'mu': 1.0}}, '^membrane.constants.mu is not a parameter;'),
    ({'law': 'mooney_rivlin', 'constants': {'c10': 1.0e9}}, '^membrane.constants.c10 = .* range'),
    ({'constants': {'c10': 1.0e4}}, '^membrane.constants.c10 is not a .* law gent: it takes'),
    ({'law': 'dewing_sim.scales:Scales'}, 'is not a law'),
    ({'law': 'dewing_sim.structure.material.law:Law'}, 'is not a law'),
    ({'law': 'no_such_module:Law'}, "membrane.law = 'no_such_module:Law': .*cannot be imported")])
def test_constants_are_checked_against_the_law(changes, sentence):
    with pytest.raises(BadInput, match=sentence):
        Sheet.from_parameters(parameters.replace(parameters.load('paper').membrane, changes))


def test_a_law_that_softens_is_named_where_it_fails():
    falling = MooneyRivlin(2.0e4, -0.9e4)
    sheet = Sheet(Elastomer(falling, 3.8e8, EPS), H, 2.0)
    with pytest.raises(Diverged, match='element 0 .* MooneyRivlin no longer resists shear'):
        sheet.respond([1.1], 0.0)


def test_the_page_on_the_material_lists_every_law_with_its_constants():
    page = (Path(__file__).parents[4] / 'docs' / 'material.md').read_text()
    for word, kind in LAWS_BY_WORD.items():
        row = next(line for line in page.splitlines() if line.startswith(f'| `{word}` |'))
        _, title, formula, listed, *_ = (cell.strip() for cell in row.strip('|').split('|'))
        assert title == kind.TITLE and kind.__doc__.startswith(formula)
        declared = [f'`{name}`' + (' (Pa)' if field.metadata['unit'] == 'Pa' else '')
                    for name, field in parameters.fields(kind)]
        assert re.findall(r'`\w+`(?: \(Pa\))?', listed) == declared
    options = dict(parameters.fields(parameters.Membrane))['law'].metadata['options']
    assert options == tuple(LAWS_BY_WORD)


def test_the_fields_of_gent_are_those_of_the_section():
    declared = dict(parameters.fields(parameters.Membrane))
    for name, field in parameters.fields(Gent):
        assert field.metadata == declared[name].metadata

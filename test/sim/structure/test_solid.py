# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The solid elements: patch, locking, tangents, arcs, strings, their 2-node limit and limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh, solve_banded

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged, Slack
from dewing_sim.scales import Scales
from dewing_sim.structure import elements
from dewing_sim.structure.dynamics.band import full
from dewing_sim.structure.material.elastomer import Elastomer
from dewing_sim.structure.material.gent import Gent
from dewing_sim.structure.membrane import Membrane
from dewing_sim.structure.sheet import Sheet
from dewing_sim.structure.solid import assembly as solid_assembly
from dewing_sim.structure.solid import element
from dewing_sim.structure.solid import shape as solid_shape
from dewing_sim.structure.solid.pins import LOWER, MIDDLE
from dewing_sim.structure.solid.solid import Solid

SECTION = parameters.replace(parameters.load('paper').membrane,
                             {'element': 'solid', 'elements': 64})
PAPER = Solid.from_parameters(SECTION)
SHEET = PAPER.sheet
SOFT = Elastomer(Gent(2.0e4, 30.0), 1.0e6, SHEET.elastomer.permittivity)


def strip(sheet=SHEET, n=6, prestretch=1.5, support=MIDDLE):
    return Solid.uniform(sheet, prestretch, 960.0, 0.002, n, support)


def distorted(solid, size=0.08, seed=3):
    """Return a bent and irregular position."""
    height = solid.sheet.initial_thickness
    s = solid.rest_position[:, 0] / solid.chord
    position = solid.rest_position.copy()
    position[:, 1] += 0.1 * solid.chord * np.sin(np.pi * s)
    noise = np.random.default_rng(seed).uniform(-size, size, position.shape)
    return position + height * noise


def gradients(solid, position, k):
    """Return F at the integration points of element k, and the shares of xi and eta."""
    length, height = solid.length[k], solid.sheet.initial_thickness
    z = solid_shape.shape(position, k, length, height)
    strains = solid_shape.measures(z, length, height)
    field = 0.0
    a, b, status = element.relax(strains, np.zeros((3, 4)), 0, solid.sheet.lateral_stretch, field,
                                 solid.sheet.elastomer.constants)
    assert status == element.BALANCED
    result = []
    for eta in (-element.GAUSS, element.GAUSS):
        for xi in (-element.GAUSS, element.GAUSS):
            s1 = 1.0 + xi * a + eta * strains[3]
            s2 = 1.0 + eta * b + xi * strains[4]
            gradient = np.diag([0.0, 0.0, solid.sheet.lateral_stretch])
            gradient[:2, 0], gradient[:2, 1] = s1 * z[:2], s2 * z[2:4]
            result.append(gradient)
    return np.array(result)


def free_gradient(function, solid, position, step):
    """Return central differences of ``function`` in the free coordinates, last axis."""
    columns = []
    for i in solid.free:
        ahead, behind = position.copy(), position.copy()
        ahead.reshape(-1)[i] += step
        behind.reshape(-1)[i] -= step
        columns.append((function(ahead) - function(behind)) / (2.0 * step))
    return np.stack(columns, axis=-1)


def hexahedron_gradient(nodes, reference, xi, eta, zeta):
    """Return F of a trilinear hexahedron from nodes (8, 3) ordered by xi, eta, zeta bits."""
    signs = np.array([[2 * (i >> axis & 1) - 1 for axis in range(3)] for i in range(8)])
    local = np.array([xi, eta, zeta])
    slopes = np.empty((8, 3))
    for axis in range(3):
        others = [other for other in range(3) if other != axis]
        slopes[:, axis] = signs[:, axis] * np.prod(1.0 + signs[:, others] * local[others],
                                                   axis=1) / 8.0
    return (nodes.T @ slopes) @ np.linalg.inv(reference.T @ slopes)


def test_the_plane_strain_hexahedron_is_the_quadrilateral_times_the_span():
    length, height, width, lateral = 3.0e-5, 5.0e-5, 2.0e-5, 1.3
    rng = np.random.default_rng(0)
    quad = np.array([[0.0, 0.0], [0.0, 3.0e-5], [5.0e-5, 0.0], [5.0e-5, 3.0e-5]])
    quad = quad + 4.0e-6 * rng.uniform(-1.0, 1.0, quad.shape)
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    reference = np.array([(x * length, y * height, z * width) for x, y, z in corners])
    nodes = np.array([(*quad[2 * x + y], z * width * lateral) for x, y, z in corners])
    vectors = solid_shape.shape(quad, 0, length, height)
    for xi, eta, zeta in rng.uniform(-1.0, 1.0, (5, 3)):
        gradient = hexahedron_gradient(nodes, reference, xi, eta, zeta)
        expected = np.diag([0.0, 0.0, lateral])
        expected[:2, 0] = vectors[:2] + eta * vectors[4:] / length
        expected[:2, 1] = vectors[2:4] + xi * vectors[4:] / height
        assert gradient == pytest.approx(expected, abs=1e-12)


def test_energy_is_that_of_the_full_tensors():
    solid = strip(Sheet(SOFT, 5.0e-5, 1.2), support=LOWER)
    position = distorted(solid)
    total = sum(solid.length[k] * 5.0e-5 / 1.2 * SOFT.energy(gradients(solid, position, k)).mean()
                for k in range(solid.elements))
    elastic, electric = solid.energies(position, 0.0)
    assert elastic == pytest.approx(total, rel=1e-12) and electric == 0.0


@pytest.mark.parametrize('v_squared', [0.0, 2.0e5])
def test_force_is_the_gradient_of_the_energy(v_squared):
    solid = strip(Sheet(SOFT, 5.0e-5, 1.2), support=LOWER)
    position = distorted(solid)

    def potential(p):
        elastic, electric = solid.energies(p, v_squared)
        return elastic - electric
    expected = free_gradient(potential, solid, position, 1.0e-9)
    force = solid.internal_force(position, v_squared).ravel()[solid.free]
    assert expected == pytest.approx(force, abs=1e-6 * np.abs(force).max())


@pytest.mark.parametrize('pressure', [0.0, 300.0])
@pytest.mark.parametrize('support', [LOWER, MIDDLE])
def test_tangent_is_the_derivative_of_the_force(pressure, support):
    solid = strip(Sheet(SOFT, 5.0e-5, 1.2), support=support)
    position = distorted(solid)

    def force(p):
        return (solid.internal_force(p, 2.0e5)
                - solid.pressure_force(p, pressure)).ravel()[solid.free]
    expected = free_gradient(force, solid, position, 1.0e-10)
    computed = full(solid.tangent(position, 2.0e5, pressure))
    assert computed == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())


def test_rigid_motion_only_turns_the_forces():
    solid = replace(strip(), support=LOWER)
    position = distorted(solid, 0.01)
    force = solid.internal_force(position, 2.0e5)
    turn = np.array([[np.cos(2.0), -np.sin(2.0)], [np.sin(2.0), np.cos(2.0)]])
    moved = solid.internal_force(position @ turn.T + [0.3, -0.1], 2.0e5)
    assert moved == pytest.approx(force @ turn.T, abs=1e-9 * np.abs(force).max())
    assert np.abs(force.sum(axis=0)).max() < 1e-12 * np.abs(force).max()
    moment = np.sum(position[:, 0] * force[:, 1] - position[:, 1] * force[:, 0])
    assert abs(moment) < 1e-12 * np.abs(force).max() * solid.chord


def patch(lengths, gradient):
    """Return forces of elements under a uniform in-plane deformation gradient."""
    x = np.repeat(np.concatenate([[0.0], np.cumsum(lengths)]), 2)
    reference = np.stack([x, np.tile([0.0, 5.0e-5], lengths.size + 1)], axis=1)
    held = np.zeros((3, 4 * lengths.size))
    result = solid_assembly.respond(reference @ gradient.T, held, lengths, 5.0e-5, 1.0, 0.0,
                                    SHEET.elastomer.constants)
    assert result[3] == element.BALANCED
    return result[0]


def test_a_uniform_deformation_passes_the_patch_test():
    gradient = np.array([[1.4, 0.3], [0.1, (1.0 + 0.03) / 1.4]])
    force = patch(1.0e-5 * np.array([2.0, 9.0, 4.0, 30.0]), gradient)
    full_gradient = np.eye(3)
    full_gradient[:2, :2] = gradient
    stress = SHEET.elastomer.first_piola(full_gradient)
    across = 5.0e-5 * stress[:2, 0]
    assert force[-2:].sum(axis=0) == pytest.approx(across + 0.0, rel=1e-9)
    inner = force.reshape(-1, 2, 2).sum(axis=1)[1:-1]
    assert np.abs(inner).max() < 1e-10 * np.abs(across).max()


def linear_cantilever(slenderness, n):
    """Return tip deflection over that of Timoshenko's beam, of a nearly incompressible strip."""
    height = 5.0e-5
    length = slenderness * height
    lengths = np.full(n, length / n)
    x = np.repeat(np.arange(n + 1) * length / n, 2)
    position = np.stack([x, np.tile([-0.5 * height, 0.5 * height], n + 1)], axis=1)
    equation = np.arange(4 * (n + 1)) - 4
    band = np.zeros((15, 4 * n))
    assert solid_assembly.stiffness(position, np.zeros((3, 4 * n)), lengths, height, 1.0, 0.0,
                                    SHEET.elastomer.constants, equation, position,
                                    band)[0] == element.BALANCED
    load = np.zeros(4 * n)
    load[[-3, -1]] = 0.5
    tip = solve_banded((7, 7), band, load)[[-3, -1]].mean()
    mu = SHEET.elastomer.law.shear_modulus  # plane strain, incompressible: E / (1 - nu^2) = 4 mu
    bending = length ** 3 / (3.0 * 4.0 * mu * height ** 3 / 12.0)
    shear = length / (mu * height)
    return tip / (bending + shear)


@pytest.mark.parametrize('aspect', [2.0, 5.0, 10.0])
def test_neither_volume_nor_shear_locks_at_any_aspect_ratio(aspect):
    slenderness = 100.0
    ratio = linear_cantilever(slenderness, round(slenderness / aspect))
    assert ratio == pytest.approx(1.0, abs=2.0 * (aspect / slenderness) ** 2 + 1e-3)


def test_every_deformation_of_an_element_costs_energy():
    for aspect in (1.0, 10.0):
        length = 5.0e-5 * aspect
        position = np.array([[0.0, 0.0], [0.0, 5.0e-5], [length, 0.0], [length, 5.0e-5]])
        band = np.zeros((15, 8))
        solid_assembly.stiffness(position, np.zeros((3, 4)), np.array([length]), 5.0e-5, 1.0, 0.0,
                                 SHEET.elastomer.constants, np.arange(8), position,
                                 band)
        values = np.linalg.eigvalsh(full(band)) / SHEET.elastomer.law.shear_modulus
        assert np.abs(values[:3]).max() < 1e-9 < 0.05 < values[3] < values[6] < 20.0
        assert values[7] > 1e4      # the change of volume


def test_the_interior_rests_at_the_prestretch_and_aligns_with_the_pins():
    tension = PAPER.tension(PAPER.rest_position, 0.0)
    assert tension == pytest.approx(np.full(64, 1.2121), abs=1e-4)
    line = PAPER.surface(PAPER.rest_position)
    assert line[[0, -1]] == pytest.approx(np.array([[0.0, 0.0], [0.030, 0.0]]), abs=1e-12)
    assert np.abs(line[8:-8, 1]).max() < 1e-3 * SHEET.initial_thickness
    assert PAPER.mass.sum() == pytest.approx(960.0 * 5.0e-5 / 1.5 * 0.030, rel=5e-3)
    assert 1.0 < PAPER.chord / (1.5 * PAPER.length.sum()) < 1.005


def test_a_strip_held_in_the_middle_rests_flat_as_the_sheet():
    solid = strip()
    passive = solid.respond(solid.rest_position, 0.0)
    assert passive.tension == pytest.approx(
        np.full(6, SHEET.respond([1.5], 0.0).tension[0]), rel=1e-9)
    assert passive.thickness == pytest.approx(
        np.full(6, SHEET.respond([1.5], 0.0).thickness[0]), rel=1e-9)


def mean(line):
    return np.sum(0.5 * (line[1:, 1] + line[:-1, 1]) * np.diff(line[:, 0]))


@pytest.mark.parametrize('volts', [0.0, 400.0, 800.0])
def test_static_camber_is_the_membrane_s_within_half_a_percent(volts):
    membrane = Membrane.from_parameters(SECTION)
    pressure = 0.39 * 0.9075
    line = PAPER.surface(PAPER.equilibrium(pressure, volts ** 2))
    thin = membrane.equilibrium(pressure, volts ** 2)
    assert line[:, 1].max() == pytest.approx(thin[:, 1].max(), rel=5e-3)
    assert mean(line) == pytest.approx(mean(thin), rel=5e-3)


@pytest.mark.parametrize('volts, printed', [(0.0, 0.8422e-2), (800.0, 1.3549e-2)])
def test_follower_pressure_bends_the_printed_arc(volts, printed):
    solid = Solid.from_parameters(parameters.replace(SECTION, {'chord': 0.010}))
    line = solid.surface(solid.equilibrium(8.168, volts ** 2))
    assert line[:, 1].max() / 0.010 == pytest.approx(printed, rel=1e-2)


def test_large_arcs_agree_with_the_membrane():
    thin = Membrane.from_parameters(SECTION).equilibrium(50.0, 3.6e5)
    line = PAPER.surface(PAPER.equilibrium(50.0, 3.6e5))
    assert thin[:, 1].max() > 0.18 * PAPER.chord
    assert line[:, 1].max() == pytest.approx(thin[:, 1].max(), rel=5e-3)


def test_camber_converges_from_25_to_400_elements():
    pressure, cambers = 0.39 * 0.9075, []
    for n in (26, 50, 100, 400):
        solid = Solid.from_parameters(parameters.replace(SECTION, {'elements': n}))
        cambers.append(solid.surface(solid.equilibrium(pressure, 1.6e5))[:, 1].max())
    assert np.abs(np.array(cambers[:-1]) / cambers[-1] - 1.0).max() < 5e-3
    assert cambers[-2] == pytest.approx(cambers[-1], rel=1e-3)


def test_string_frequencies_in_vacuo():
    matrix = full(PAPER.tangent(PAPER.rest_position, 0.0))
    mass = np.repeat(PAPER.mass, 2)[PAPER.free]
    squares = eigh(matrix, np.diag(mass), eigvals_only=True, subset_by_index=[0, 3])
    along = np.sqrt(1.5 * SHEET.respond([1.5], 0.0).stiffness[0] / (960.0 * 5.0e-5 / 1.5)) / 0.06
    assert np.sqrt(squares) / (2.0 * np.pi) == pytest.approx(
        [102.6, along, 205.2, 2.0 * along], rel=5e-3)


def test_parameter_units_do_not_matter():
    scales = Scales(length=0.03, speed=1.2, density=1.225, viscosity=1.5e-5)
    scaled = elements.make(SECTION, scales)
    assert isinstance(scaled, Solid)
    force = scaled.internal_force(PAPER.rest_position / scales.length, 4.0e5) * scales.tension
    assert force == pytest.approx(PAPER.internal_force(PAPER.rest_position, 4.0e5), abs=1e-5)


def test_surface_and_spread_are_transposed():
    rng = np.random.default_rng(2)
    nodal, force = rng.normal(size=PAPER.rest_position.shape), rng.normal(size=(65, 2))
    assert np.sum(PAPER.surface(nodal) * force) == pytest.approx(
        np.sum(nodal * PAPER.spread(force)), rel=1e-12)


def test_unloaded_strip_above_the_limit_is_slack():
    with pytest.raises(Slack, match=r'element \d+ has tension -.* loses it at 1\d\d\d'):
        PAPER.equilibrium(0.0, 1320.0 ** 2)


def test_bursting_pressure_is_named():
    with pytest.raises(Diverged, match=r'element \d+ at stretch .*(Gent limit 100|inside out)'):
        PAPER.equilibrium(1.0e6, 0.0)


def test_gent_locking_is_named_with_its_element():
    solid = strip()
    stretched = solid.rest_position * [7.0, 1.0 / 7.0]
    with pytest.raises(Diverged, match='element 0 at stretch 10.5 .* reaches the Gent limit 100'):
        solid.internal_force(stretched, 0.0)


def test_an_element_inside_out_is_named():
    solid = strip()
    with pytest.raises(Diverged, match='element 0 .* inside out'):
        solid.internal_force(solid.rest_position * [1.0, -1.0], 0.0)


@pytest.mark.parametrize('value', [-1.0, np.nan, np.inf])
def test_impossible_voltage_and_position_are_refused(value):
    with pytest.raises(BadInput, match='v_squared = .* out of range'):
        PAPER.respond(PAPER.rest_position, value)
    with pytest.raises(Diverged, match='not finite'):
        PAPER.respond(np.full_like(PAPER.rest_position, np.nan), 0.0)


def test_too_few_elements_are_bad_input():
    with pytest.raises(BadInput, match='elements = 3 is out of range'):
        strip(n=3)

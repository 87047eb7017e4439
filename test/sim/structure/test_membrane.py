# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""The membrane elements against arcs, strings, rigid motions and numerical derivatives."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from dewing_sim import parameters
from dewing_sim.errors import BadInput, Diverged, Slack
from dewing_sim.scales import Scales
from dewing_sim.structure.dynamics.band import full
from dewing_sim.structure.material.elastomer import diagonal
from dewing_sim.structure.membrane import Membrane

SECTION = parameters.load('paper').membrane
PAPER = Membrane.from_parameters(SECTION)
# The paper's material on a chord of 10 mm at Re = 2500, to which the printed arcs belong.
SHORT = parameters.replace(SECTION, {'chord': 0.010})
SHORT_PRESSURE = 8.168


def elements(section, n):
    return Membrane.from_parameters(parameters.replace(section, {'elements': n}))


def bent(membrane, seed=1):
    """Return a strongly deformed position, edges in place."""
    position = membrane.rest_position.copy()
    s = position[:, 0] / membrane.chord
    position[:, 1] += 0.1 * membrane.chord * np.sin(np.pi * s)
    noise = np.random.default_rng(seed).uniform(-0.2, 0.2, position.shape)
    position[1:-1] += (membrane.chord / membrane.elements) * noise[1:-1]
    return position


def arc_height(membrane, pressure, v_squared):
    """Return the height of the circular arc with T = p R and lambda = lambda_p theta/sin."""
    def excess(theta):
        stretch = membrane.prestretch * theta / np.sin(theta)
        tension = membrane.sheet.respond([stretch], v_squared).tension[0]
        return tension - pressure * membrane.chord / (2.0 * np.sin(theta))
    theta = brentq(excess, 1e-4, 1.5, xtol=1e-15)
    return membrane.chord / (2.0 * np.sin(theta)) * (1.0 - np.cos(theta))


def energy(membrane, position, v_squared):
    """Return the potential energy per unit deformed span."""
    sheet = membrane.sheet
    stretch = membrane.stretch(position)
    thickness = sheet.respond(stretch, v_squared).thickness
    stretches = np.stack([stretch, np.full_like(stretch, sheet.lateral_stretch),
                          thickness / sheet.initial_thickness], axis=-1)
    field = (0.0, 0.0, np.sqrt(v_squared) / sheet.initial_thickness)
    density = sheet.elastomer.energy(diagonal(stretches), field)
    area = 1.0 / (membrane.stretch_per_length * sheet.lateral_stretch)
    return sheet.initial_thickness * np.dot(density, area)


def free_gradient(function, membrane, position, step):
    """Return central differences of ``function`` in the free coordinates, last axis."""
    columns = []
    for i in range(2, 2 * membrane.elements):
        ahead, behind = position.copy(), position.copy()
        ahead.reshape(-1)[i] += step
        behind.reshape(-1)[i] -= step
        columns.append((function(ahead) - function(behind)) / (2.0 * step))
    return np.stack(columns, axis=-1)


def test_mass_and_shape_at_rest():
    assert PAPER.rest_position.shape == (129, 2)
    assert PAPER.mass.sum() == pytest.approx(960.0 * 5.0e-5 / 1.5 * 0.030, rel=1e-13)
    assert PAPER.mass.sum() / 0.030 / (1.225 * 0.030) == pytest.approx(0.871, abs=5e-4)
    assert PAPER.chord == 0.030


def test_no_force_on_free_nodes_at_rest_and_tension_on_the_pins():
    force = PAPER.internal_force(PAPER.rest_position, 0.0)
    assert np.abs(force[1:-1]).max() < 1e-13
    assert force[[0, -1], 0] == pytest.approx([-1.2121, 1.2121], abs=5e-5)


@pytest.mark.parametrize('v_squared', [0.0, 3.0e5])
def test_rigid_motion_only_turns_the_forces(v_squared):
    membrane = elements(SECTION, 12)
    position = bent(membrane)
    force = membrane.internal_force(position, v_squared)
    turn = np.array([[np.cos(2.0), -np.sin(2.0)], [np.sin(2.0), np.cos(2.0)]])
    moved = position @ turn.T + np.array([0.3, -0.1])
    assert membrane.internal_force(moved, v_squared) == pytest.approx(force @ turn.T, abs=1e-11)


def test_internal_forces_balance():
    membrane = elements(SECTION, 12)
    position = bent(membrane)
    force = membrane.internal_force(position, 1.0e5)
    assert force.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-13)
    moment = position[:, 0] * force[:, 1] - position[:, 1] * force[:, 0]
    assert moment.sum() == pytest.approx(0.0, abs=1e-14)


def test_internal_force_is_the_gradient_of_the_energy():
    section = parameters.replace(SECTION, {'prestretch_lateral': 1.3, 'bulk_modulus': 1.0e6,
                                           'elements': 6})
    membrane = Membrane.from_parameters(section)
    position = bent(membrane)
    gradient = free_gradient(lambda p: energy(membrane, p, 3.0e5), membrane, position, 1e-7)
    force = membrane.internal_force(position, 3.0e5).ravel()[membrane.free]
    assert gradient == pytest.approx(force, abs=1e-7 * np.abs(force).max())


@pytest.mark.parametrize('pressure', [0.0, 400.0])
def test_tangent_is_the_derivative_of_the_force(pressure):
    membrane = elements(SECTION, 8)
    position = bent(membrane)

    def force(p):
        net = membrane.internal_force(p, 3.0e5) - membrane.pressure_force(p, pressure)
        return net.ravel()[membrane.free]
    expected = free_gradient(force, membrane, position, 1e-8)
    computed = full(membrane.tangent(position, 3.0e5, pressure))
    assert computed == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())


def test_tangent_is_a_symmetric_band():
    membrane = elements(SECTION, 8)
    position = bent(membrane)
    band = membrane.tangent(position, 0.0)
    matrix = full(band)
    assert band.shape == (7, 14)
    for offset in range(-3, 4):
        expected = np.diagonal(matrix, offset)
        row = band[3 - offset]
        assert np.array_equal(row[offset:] if offset >= 0 else row[:offset], expected)
    assert np.abs(matrix - matrix.T).max() <= 1e-12 * np.abs(matrix).max()


def test_pressure_force_totals_pressure_times_chord():
    position = bent(PAPER)
    assert PAPER.pressure_force(position, 3.0).sum(axis=0) == pytest.approx([0.0, 0.09], abs=1e-14)


def test_parameter_units_do_not_matter():
    scales = Scales(length=0.03, speed=1.2, density=1.225, viscosity=1.5e-5)
    scaled = Membrane.from_parameters(SECTION, scales)
    position = bent(PAPER)
    force = scaled.internal_force(position / scales.length, 4.0e5) * scales.tension
    expected = PAPER.internal_force(position, 4.0e5)
    assert force == pytest.approx(expected, abs=1e-12)
    assert scaled.mass.sum() * scales.density * scales.length ** 2 == pytest.approx(
        PAPER.mass.sum())


@pytest.mark.parametrize('case, n', [('paper', 4), ('soft', 128)])
def test_small_dead_load_bends_the_parabola(case, n):
    section = parameters.replace(parameters.load(case).membrane, {'elements': n})
    membrane = Membrane.from_parameters(section)
    q = 1.0e-4
    tension = membrane.sheet.respond([membrane.prestretch], 0.0).tension[0]
    position = membrane.equilibrium(q, 0.0, follower=False)
    assert position[:, 1].max() == pytest.approx(q * membrane.chord ** 2 / (8.0 * tension),
                                                 rel=1e-6)


def test_dead_load_leaves_horizontal_tension_uniform():
    position = PAPER.equilibrium(20.0, 4.0e5, follower=False)
    step = np.diff(position, axis=0)
    horizontal = PAPER.tension(position, 4.0e5) * step[:, 0] / np.hypot(*step.T)
    assert np.ptp(horizontal) < 1e-11 * horizontal.mean()


@pytest.mark.parametrize('volts, printed', [(0.0, 0.8422e-2), (800.0, 1.3549e-2)])
def test_follower_pressure_bends_the_printed_arc(volts, printed):
    membrane = Membrane.from_parameters(SHORT)
    position = membrane.equilibrium(SHORT_PRESSURE, volts ** 2)
    exact = arc_height(membrane, SHORT_PRESSURE, volts ** 2)
    assert exact / membrane.chord == pytest.approx(printed, rel=2e-4)
    assert position[:, 1].max() == pytest.approx(exact, rel=1e-4)
    assert np.ptp(position[:, 1] - position[::-1, 1]) < 1e-12 * membrane.chord


def test_large_arcs_converge_with_second_order():
    exact = arc_height(PAPER, 50.0, 8.0e5)
    assert exact / PAPER.chord > 0.25
    sizes = [8, 16, 32, 64]
    errors = [abs(elements(SECTION, n).equilibrium(50.0, 8.0e5)[n // 2, 1] - exact)
              for n in sizes]
    order = -np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.1)


def test_pressure_keeps_the_membrane_taut_beyond_the_flat_limit():
    volts_squared = 1400.0 ** 2
    membrane = Membrane.from_parameters(SHORT)
    position = membrane.equilibrium(SHORT_PRESSURE, volts_squared)
    assert membrane.tension(position, volts_squared).min() > 0.0
    exact = arc_height(membrane, SHORT_PRESSURE, volts_squared)
    assert position[:, 1].max() == pytest.approx(exact, rel=1e-3)


def test_string_frequencies_in_vacuo():
    tension = PAPER.sheet.respond([1.5], 0.0).tension[0]
    mass = PAPER.mass[1:-1]
    transverse = full(PAPER.tangent(PAPER.rest_position, 0.0))[1::2, 1::2]
    squares = eigh(transverse, np.diag(mass), eigvals_only=True)
    n = np.arange(1, mass.size + 1)
    sine = np.sin(0.5 * np.pi * n / PAPER.elements)
    expected = 2.0 * np.sqrt(tension * PAPER.elements / PAPER.chord / mass[0]) * sine
    assert np.sqrt(squares) == pytest.approx(expected, rel=1e-8)
    assert np.sqrt(squares[:3]) / (2.0 * np.pi) == pytest.approx(
        [102.6, 205.2, 307.8], rel=5e-4)


def test_unloaded_membrane_above_the_limit_is_slack():
    with pytest.raises(Slack, match=r'element \d+ has tension -.* loses it at 1300\.0'):
        PAPER.equilibrium(0.0, 1310.0 ** 2)


def test_bursting_pressure_is_named():
    with pytest.raises(Diverged, match='Gent limit'):
        PAPER.equilibrium(1.0e6, 0.0)


def test_one_element_is_bad_input():
    with pytest.raises(BadInput, match='elements = 1 is out of range'):
        Membrane.uniform(PAPER.sheet, 1.5, 960.0, 0.03, 1)

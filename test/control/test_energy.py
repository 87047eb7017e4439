# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
"""Capacitance against closed forms and the exact balance of electrical energy."""

import numpy as np
import pytest

from dewing_control.trial.energy import Energy
from dewing_sim import parameters
from dewing_sim.structure import elements
from dewing_sim.wing import electrode_ratio

MEMBRANE = parameters.load('paper').membrane
PERMITTIVITY = 2.7 * 8.8541878128e-12


def test_flat_membrane_is_a_plate_capacitor():
    """C = eps c/h with h = H/lambda_p = 33.33 um."""
    x, thickness = np.linspace(0.0, 0.03, 129), np.full(128, 5.0e-5 / 1.5)
    ratio = electrode_ratio(x, np.zeros_like(x), thickness)
    assert ratio == pytest.approx(0.03 / (5.0e-5 / 1.5), rel=1.0e-12)


def test_circular_arc_has_the_square_of_its_stretch():
    """A uniform stretch s beyond the prestretch lengthens and thins: C grows by s^2."""
    membrane = elements.make(MEMBRANE)
    angle = np.linspace(-0.3, 0.3, 129)
    arc = np.stack([np.sin(angle), np.cos(angle) - np.cos(0.3)], axis=1) * 0.015 / np.sin(0.3)
    flat = PERMITTIVITY * 0.03 / (5.0e-5 / 1.5)
    stretch = 0.3 / np.sin(0.3)
    assert _capacitance(membrane, arc + [0.015, 0.0], 0.0) == pytest.approx(
        flat * stretch**2, rel=3.0e-5)      # not quite incompressible


@pytest.mark.parametrize('element, support, within', [
    ('membrane', 'lower', 1.0e-12), ('solid', 'middle', 1.0e-9), ('solid', 'lower', 2.0e-3)])
def test_capacitance_stores_the_electrostatic_energy_of_the_elements(element, support, within):
    """C V^2 / 2 = int eps E^2 / 2 dA; pins at the lower side bend the elements at the edges."""
    membrane = elements.make(parameters.replace(
        MEMBRANE, {'element': element, 'support': support, 'elements': 32}))
    position, v_squared = membrane.equilibrium(0.5, 1.0e6), 1.0e6
    _, stored = membrane.energies(position, v_squared)
    assert 0.5 * _capacitance(membrane, position, v_squared) * v_squared == pytest.approx(
        stored, rel=within)


def _capacitance(membrane, position, v_squared):
    thickness = membrane.respond(position, v_squared).thickness
    return PERMITTIVITY * electrode_ratio(*membrane.surface(position).T, thickness)


def test_source_pays_what_is_stored_and_the_work():
    generator = np.random.default_rng(4)
    energy = Energy.of(1.0e5 * generator.random(500), 1.0e-8 * (1.0 + generator.random(500)))
    assert energy.net == pytest.approx(energy.stored + energy.work, rel=1.0e-9)
    assert energy.gross > max(energy.net, 0.0)


def test_rigid_capacitor_returns_everything_with_recovery_and_nothing_without():
    cycle = 1.0e5 * (1.0 - np.cos(np.linspace(0.0, 6.0 * np.pi, 301)))
    energy = Energy.of(cycle, np.full(301, 2.0e-8))
    assert energy.net == pytest.approx(0.0, abs=1.0e-15)
    assert energy.work == 0.0
    assert energy.gross == pytest.approx(3.0 * 0.5 * 2.0e-8 * 2.0e5, rel=1.0e-9)


def test_slow_cycle_does_the_work_that_its_loop_encloses():
    """C and V^2 on an ellipse: the work is half the enclosed area, and nothing stays stored."""
    angle = np.linspace(0.0, 2.0 * np.pi, 20001)
    energy = Energy.of(1.0e5 * (1.0 + np.sin(angle)), 1.0e-8 * (1.0 + 0.1 * np.cos(angle)))
    assert energy.stored == pytest.approx(0.0, abs=1.0e-12)
    assert energy.net == pytest.approx(-0.5 * np.pi * 1.0e5 * 1.0e-9, rel=1.0e-3)
